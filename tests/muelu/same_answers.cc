// Preconditioned by MueLu of Trilinos, the block and the condensed solver find what they find with nodus's own
// multigrid: hanging nodes, friction, and a rigid body that a force drives. On one and two ranks.

#include "../solver/same_answers.h"

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  SameAnswers::compare(SameAnswers::Preconditioner::muelu);
}
