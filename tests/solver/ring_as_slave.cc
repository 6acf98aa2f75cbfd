// The ring of prm/ironing.prm as the slave, one cell wide: master nodes come into the jumps of its nodes, and go, while
// it is pressed in. Shares that do so at once, and not from zero, leave merged iterations without an iterate to settle
// at: they were given up in two of these five increments.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Parameters p             = Parameters::read(SOURCE_DIR "/../../prm/ironing.prm",
                                  {"Contact pair 1/Slave body=2",
                                               "Contact pair 1/Slave boundary ids=0",
                                               "Contact pair 1/Slave where=y < 0.7 && x^2 + (y-1)^2 > 0.8 && abs(z - 0.1) < 0.0999",
                                               "Contact pair 1/Master body=1",
                                               "Contact pair 1/Master boundary ids=3",
                                               "Contact pair 1/Master where=",
                                               "Load stepping/Interval ends=1",
                                               "Load stepping/Increments=5"});
  p.output.results_folder  = "ring_as_slave_results";
  p.output.write_vtu       = false;
  unsigned int   fallbacks = 0, newton = 0;
  ContactProblem problem(p, world(), log());
  problem.on_increment(
      [&](const unsigned int, const double)
      {
        fallbacks += problem.iterations().fallbacks;
        newton += problem.iterations().newton;
      });
  problem.run();
  check_count("merged iterations that are given up", fallbacks, 0);
  // 22 or 23, as round-off has it
  check("at most six Newton iterations for each increment on the average", newton <= 30);
}
