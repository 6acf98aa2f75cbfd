// Two unit cubes of 3x3x2 and 2x2x2 cells pressed together by 25, small strain: the nodal scheme does not pass
// this patch test. Its multipliers and top displacements are compared with those of Code_Aster 14.6 (three fixed-point
// loops, nodal integration, reference surface measure) for both choices of the slave.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const bool upper_is_slave : {true, false})
  {
    Parameters p;
    p.bodies              = {box("lower", "3,3,2", {0, 0, 0}, {1, 1, 1}, 2000, 0.3),
                             box("upper", "2,2,2", {0, 0, 1}, {1, 1, 2}, 2000, 0.3)};
    p.boundary_conditions = {hold("x", region(0, {x_minus}), {0}),
                             hold("y", region(0, {y_minus}), {1}),
                             hold("z", region(1, {z_minus}), {2}),
                             press("top", region(2, {z_plus}), "25")};
    const auto lower = region(1, {z_plus}), upper = region(2, {z_minus});
    p.contact_pairs                    = {upper_is_slave ? pair(upper, lower) : pair(lower, upper)};
    p.contact_pairs[0].surface_measure = ContactPairParameters::SurfaceMeasure::reference;
    p.output.results_folder            = "v1_results";
    use_loops(p); // the references renew the geometry once
    p.geometry_loop.tolerance = 0.01;

    ContactProblem problem(p, world(), log());
    problem.run();
    const auto &f = problem.contact_fields()[0];

    std::vector<double> top;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        top.push_back(problem.displacement(2, {0.5 * i, 0.5 * j, 2})[2]);
    const auto [largest, smallest] = std::minmax_element(f.pressure.begin(), f.pressure.end());

    if (root())
      std::cout << "slave: " << (upper_is_slave ? "upper" : "lower") << std::endl;
    if (upper_is_slave)
    {
      const double values[6][3] = {{0, 0, -17.721249},
                                   {0, .5, -25.128055},
                                   {0, 1, -17.736243},
                                   {.5, .5, -31.978501},
                                   {.5, 1, -25.145157},
                                   {1, 1, -17.806151}};
      for (const auto &v : values)
      {
        std::ostringstream name;
        name << "lambda at (" << v[0] << ", " << v[1] << ")";
        check(name.str(), -f.pressure[node_at(f, {v[0], v[1], 1})], v[2], 1e-5);
      }
    }
    check("lambda min", -*smallest, upper_is_slave ? -31.978501 : -27.485047, 1e-5);
    check("lambda max", -*largest, upper_is_slave ? -17.721249 : -20.194667, 1e-5);
    check(
        "u_z(top) min", *std::min_element(top.begin(), top.end()), upper_is_slave ? -0.026012677 : -0.025203093, 1e-5);
    check(
        "u_z(top) max", *std::max_element(top.begin(), top.end()), upper_is_slave ? -0.025462114 : -0.024969560, 1e-5);
    check("resultant", problem.contact_resultants()[0].slave_force[2], upper_is_slave ? 25. : -25., 1e-9);
  }
}
