// Conditions that act for a time. A bar of unit cross-section and length is pulled to the strain 0.1, let go, and
// loaded by a traction: what held its end goes to zero linearly, the traction acts in its own time only.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const double E = 200.;
  Parameters   p;
  p.bodies              = {box("bar", "2,1,1", {0, 0, 0}, {1, 1, 1}, E, 0.3)};
  p.boundary_conditions = {
      hold("x", region(1, {x_minus}), {0}),
      hold("y", region(1, {y_minus}), {1}),
      hold("z", region(1, {z_minus}), {2}),
      drive("pull", region(1, {x_plus}), 0, "0.1*t"),
      condition("traction", BoundaryConditionParameters::Type::traction, region(1, {x_plus}), {0}, {"5+0*t"}),
      drive("push", region(1, {x_plus}), 0, "-0.01*(t-4)")};
  p.boundary_conditions[3].active_until = 1.;
  p.boundary_conditions[4].active_from  = 2.;
  p.boundary_conditions[4].active_until = 3.;
  p.boundary_conditions[5].active_from  = 4.;
  p.load_stepping.interval_ends         = {1., 2., 3., 4., 5.};
  p.load_stepping.increments            = {2, 4, 1, 1, 1};
  p.output.results_folder               = "release_results";
  p.output.write_vtu                    = false;

  // displacement of the end; reactions of "x" and of "pull"
  struct Expected
  {
    double u, held, pull;
  };
  const std::map<double, Expected> expected = {{0.5, {0.05, -0.05 * E, 0.05 * E}},
                                               {1., {0.1, -0.1 * E, 0.1 * E}},
                                               {1.25, {0.075, -0.075 * E, 0.}},
                                               {1.5, {0.05, -0.05 * E, 0.}},
                                               {1.75, {0.025, -0.025 * E, 0.}},
                                               {2., {0., 0., 0.}},
                                               {3., {5. / E, -5., 0.}},
                                               {4., {0., 0., 0.}},
                                               {5., {-0.01, 0.01 * E, 0.}}};
  ContactProblem                   problem(p, world(), log());
  unsigned int                     met = 0;
  problem.on_increment(
      [&](unsigned int, const double t)
      {
        const auto at = expected.find(t);
        if (at == expected.end())
          return;
        ++met;
        const double       u      = problem.displacement(1, {1, 0, 0})[0];
        const auto        &forces = problem.reactions();
        const double       held = forces[0].second[0], pull = forces[3].second[0];
        std::ostringstream name;
        name << "t = " << t;
        check(name.str() + ": displacement", u, at->second.u, 1e-8, 0.1);
        check("  reaction of the other end", held, at->second.held, 1e-7, E);
        check("  of the end that is pulled", pull, at->second.pull, 1e-7, E);
      });
  problem.run();
  check_equal("times that were met", met, expected.size());
}
