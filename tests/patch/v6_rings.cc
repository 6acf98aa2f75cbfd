// prm/ring.prm: two rings under external pressure, quadratic elements. Lame: contact pressure 9259259.26 at every node
// within 2 %, u_r = -0.0053333 at the interface.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Parameters                               p = Parameters::read(SOURCE_DIR "/../../prm/ring.prm");
  p.output.results_folder                    = "v6_results";
  ContactProblem problem(p, world(), log());
  problem.run();

  const auto &f = problem.contact_fields()[0];
  check("smallest pressure", *std::min_element(f.pressure.begin(), f.pressure.end()), 9259259.26, 0.02);
  check("largest pressure", *std::max_element(f.pressure.begin(), f.pressure.end()), 9259259.26, 0.02);
  check("u_r", f.displacement[node_at(f, {0.6, 0, 0.05})][0], -0.0053333333, 0.005);
  check_count("open nodes", problem.contact_resultants()[0].open, 0);
}
