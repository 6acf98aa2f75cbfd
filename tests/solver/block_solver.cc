// The block solver.

#include "iterative_solver.h"

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Nodus::LinearSolverParameters            block;
  block.type                = Nodus::LinearSolverParameters::Type::block;
  block.augmentation_factor = 2.;
  ModelProblem::check_iterative_solver(block, 1e-6, "");
}
