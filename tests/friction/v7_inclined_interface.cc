// prm/inclined_interface.prm: a cut at 30 degrees that sticks under axial stress -12000. Exact on the cut: lambda =
// -9000, friction traction 5196.15, so |Lambda| = tan 30 = 0.577350269 at mu = 1; all nodes stick.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Parameters                               p = Parameters::read(SOURCE_DIR "/../../prm/inclined_interface.prm");
  p.output.results_folder                    = "v7_results";
  ContactProblem problem(p, world(), log());
  problem.run();

  const auto         &f = problem.contact_fields()[0];
  std::vector<double> ratio;
  unsigned int        stick = 0;
  for (unsigned int k = 0; k < f.X.size(); ++k)
  {
    ratio.push_back(f.friction[k].norm() / f.pressure[k]);
    stick += f.status[k] == ContactStatus::stick;
  }
  check("lambda", -farthest(f.pressure, 9000.), -9000., 1e-6);
  check("|Lambda|", farthest(ratio, std::tan(M_PI / 6)), std::tan(M_PI / 6), 1e-6);
  check_equal("nodes that stick, all", stick, f.X.size());
}
