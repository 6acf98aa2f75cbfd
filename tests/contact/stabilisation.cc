// A block hovers 0.01 above a held one and is pushed down by a pressure of 1: nothing holds it until contact closes.
// - Without stabilisation the run stops and says so.
// - Viscous stabilisation lets it come down and is gone at the end of the interval: the contact force is the load, and
//   the block, E = 1000, nu = 0, small strain, is 0.001 shorter.
// - In a second interval without dashpots contact carries all of the load in every state; with them it does not. The
// end
//   of the log says so.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Solver = LinearSolverParameters::Type;

  Parameters hovering(const double viscosity, const Solver solver, const bool loops)
  {
    Parameters p;
    p.bodies                              = {box("table", "1,1,1", {-0.5, -0.5, -1}, {1.5, 1.5, 0}, 1000, 0.),
                                             box("block", "2,2,2", {0, 0, 0.01}, {1, 1, 1.01}, 1000, 0.)};
    p.boundary_conditions                 = {hold("table", region(1, {0, 1, 2, 3, 4, 5}), {0, 1, 2}),
                                             hold("guide x", region(2, {x_minus}), {0}),
                                             hold("guide y", region(2, {y_minus}), {1}),
                                             press("push", region(2, {z_plus}), "1")};
    p.contact_pairs                       = {pair(region(2, {z_minus}), region(1, {z_plus}))};
    p.contact_pairs[0].surface_measure    = ContactPairParameters::SurfaceMeasure::reference;
    p.load_stepping.increments            = {4};
    p.load_stepping.viscous_stabilisation = {viscosity};
    p.linear_solver.type                  = solver;
    p.output.results_folder               = "stabilisation_results";
    p.output.write_vtu                    = false;
    if (loops)
      use_loops(p);
    return p;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  try
  {
    ContactProblem problem(hovering(0., Solver::direct, false), world(), log());
    problem.run();
    check("without stabilisation the run stops", false);
  }
  catch (const SolverFailure &failure)
  {
    check("without stabilisation the run stops",
          std::string(failure.what()).find("'Load stepping/Viscous stabilisation = 1e-2'") != std::string::npos);
  }
  for (const Solver solver : {Solver::direct, Solver::condensed})
    for (const bool loops : {false, true})
      for (const double viscosity : {1e-3, 1e-2})
      {
        std::ostringstream text;
        ContactProblem     problem(hovering(viscosity, solver, loops), world(), text);
        problem.run();
        if (root())
          check("the free motion is named", text.str().find("body 2 (block) moves along (0 0 1)") != std::string::npos);
        check("contact force", problem.contact_resultants()[0].slave_force[2], 1., 1e-8);
        check("u_z of the top", problem.displacement(2, Point(1, 1, 1.01))[2], -0.011, 1e-6);
      }

  for (const std::vector<double> &viscosity : {std::vector<double>{1e-2}, {1e-2, 0.}})
  {
    Parameters p                          = hovering(0., Solver::direct, false);
    p.load_stepping                       = {{1., 2.}, {4, 4}};
    p.load_stepping.viscous_stabilisation = viscosity;
    p.boundary_conditions.back().value    = {"max(1,t)"};
    std::ostringstream text;
    ContactProblem     problem(p, world(), text);
    double             off = 0.;
    problem.on_increment(
        [&](unsigned int, const double t)
        {
          if (t > 1.)
            off = std::max(off, std::abs(problem.contact_resultants()[0].slave_force[2] - t));
        });
    problem.run();
    if (viscosity.size() == 1)
      check("dashpots carry some of what grows afterwards", off > 1e-4);
    else
      check("without them in the second interval, contact is off the load by at most", off, 0., 1e-8, 1.);
    if (root())
      for (const std::string part : {"viscous stabilisation held ", "of 8 states in part"})
        check("  the end says: " + part, text.str().find(part) != std::string::npos);
  }
}
