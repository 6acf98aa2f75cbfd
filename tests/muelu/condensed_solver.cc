// The condensed solver with MueLu on several ranks, where its coarsest level has another solver than on one: the cycle
// is symmetric, which conjugate gradients need.

#include "../solver/iterative_solver.h"

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Nodus::LinearSolverParameters            condensed;
  condensed.type           = Nodus::LinearSolverParameters::Type::condensed;
  condensed.preconditioner = Nodus::LinearSolverParameters::Preconditioner::muelu;
  ModelProblem::check_iterative_solver(condensed, 1e-6, ": block solver");
}
