// prm/snap_fit.prm until the hook snaps: an edge of the tooth slides over the nodes of the catch, which its force
// passes on to one another. The beam is soft: where the force was lost as the last node that had it came out from under
// the tooth, the beam fell through the catch, and merged iterations did not recover. Beam theory gives the force (case
// file).

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Parameters p             = Parameters::read(SOURCE_DIR "/../../prm/snap_fit.prm",
                                  {"Load stepping/Interval ends=0.8", "Load stepping/Increments=80"});
  p.output.results_folder  = "passing_edge_results";
  p.output.write_vtu       = false;
  unsigned int   fallbacks = 0, newton = 0, increments = 0;
  ContactProblem problem(p, world(), log());
  problem.on_increment(
      [&](const unsigned int, const double)
      {
        ++increments;
        fallbacks += problem.iterations().fallbacks;
        newton += problem.iterations().newton;
      });
  problem.run();
  check_count("increments", increments, 80);
  check_count("merged iterations that are given up", fallbacks, 0);
  check("at most three Newton iterations for each increment on the average", newton <= 3 * increments);
  const Vector3 force = problem.contact_resultants()[0].slave_force;
  check("pressing force", -force[1], 0.1218, 0.02);
  check("friction over it", -force[0] / force[1], 0.2544, 0.02);
}
