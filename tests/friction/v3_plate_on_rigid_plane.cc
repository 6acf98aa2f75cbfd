// A thin plate is pressed on a rigid plane and pushed along it, mu = 1, small strain: open, slipping and sticking nodes
// together (Code_Aster SSNV128, GRECO). The plane is a held block. References: Code_Aster 14.6 on this mesh (nodal
// integration); the published values are within 5 % of them. Agreement beyond 6e-5 means nothing at mu = 1.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Parameters p;
  p.bodies                           = {box("plate", "32,10,1", {0, 0, 0}, {0.04, 0.04, 0.001}, 1.3e11, 0.2),
                                        box("plane", "1,1,1", {-0.01, -0.01, -0.001}, {0.05, 0, 0.002}, 1.3e11, 0.2)};
  p.boundary_conditions              = {hold("x", region(1, {x_plus}), {0}),
                                        hold("z", region(1, {z_minus, z_plus}, "y>1e-6"), {2}),
                                        hold("plane", region(2, {0, 1, 2, 3, 4, 5}), {0, 1, 2}),
                                        press("down", region(1, {y_plus}), "5e7"),
                                        press("push", region(1, {x_minus}), "15e7")};
  p.contact_pairs                    = {pair(region(1, {y_minus}), region(2, {y_plus}), 1.)};
  p.contact_pairs[0].surface_measure = ContactPairParameters::SurfaceMeasure::reference;
  p.output.results_folder            = "v3_results";
  p.newton.largest_forcing_term      = 1e-6; // four nodes are at the verge of slip

  ContactProblem problem(p, world(), log());
  problem.run();

  const double x_mm[]   = {0, 1.25, 5, 7.5, 11.25};
  const double u_x[]    = {2.922193, 2.775057, 2.319240, 2.011820, 1.569561};
  const double lambda[] = {0, 0, -1.563816e7, -2.466203e7, -3.436648e7};
  const auto  &f        = problem.contact_fields()[0];
  for (unsigned int i = 0; i < 5; ++i)
  {
    const Point X(1e-3 * x_mm[i], 0, 0);
    check("1e5 u_x at x = " + std::to_string(x_mm[i]) + " mm", 1e5 * problem.displacement(1, X)[0], u_x[i], 1e-3);
    const auto k = node_at(f, X);
    if (i < 2)
      check("  open", f.status[k] == ContactStatus::open);
    else
      check("  1e-7 lambda", -1e-7 * f.pressure[k], 1e-7 * lambda[i], 1e-3);
  }
  const auto &r = problem.contact_resultants()[0];
  if (root())
    std::cout << "nodes: " << r.open << " open, " << r.slip << " slip, " << r.stick << " stick" << std::endl;
}
