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

  const auto &f              = problem.contact_fields()[0];
  double      pressure_error = 0., ratio_error = 0.;
  bool        stick = true;
  for (unsigned int k = 0; k < f.X.size(); ++k)
  {
    pressure_error = std::max(pressure_error, std::abs(f.pressure[k] / 9000. - 1.));
    ratio_error    = std::max(ratio_error, std::abs(f.friction[k].norm() / f.pressure[k] / std::tan(M_PI / 6) - 1.));
    stick          = stick && f.status[k] == ContactStatus::stick;
  }
  check("lambda = -9000 to 1e-6", pressure_error < 1e-6);
  check("|Lambda| = 0.577350269 to 1e-6", ratio_error < 1e-6);
  check("all nodes stick", stick);
}
