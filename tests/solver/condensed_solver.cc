// The condensed solver; what cannot be condensed goes to the block solver.

#include "iterative_solver.h"

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Nodus::LinearSolverParameters            condensed;
  condensed.type = Nodus::LinearSolverParameters::Type::condensed;
  ModelProblem::check_iterative_solver(condensed, 1e-7, ": block solver");
}
