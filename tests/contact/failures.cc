// Runs that cannot succeed say so: loop, reason, worst node, last converged state.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  std::string outcome(const Parameters &p)
  {
    try
    {
      ContactProblem problem(p, world(), log());
      problem.run();
      return "no failure";
    }
    catch (const SolverFailure &failure)
    {
      return failure.what();
    }
  }

  void check_words(const std::string &what, const std::string &message, const std::vector<std::string> &words)
  {
    bool all = true;
    for (const auto &w : words)
      all = all && message.find(w) != std::string::npos;
    check(what, all);
    if (!all && root())
      std::cout << "  " << message << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Parameters p;
  p.bodies                = {box("lower", "3,3,1", {0, 0, 0}, {1, 1, 1}, 100, 0.3),
                             box("upper", "2,2,1", {0.1, 0.1, 1}, {0.9, 0.9, 2}, 100, 0.3)};
  p.boundary_conditions   = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                             drive("top", region(2, {z_plus}), 2, "-0.1*t")};
  p.contact_pairs         = {pair(region(2, {z_minus}), region(1, {z_plus}))};
  p.output.results_folder = "failures_results";
  check_words("a body that can slide away is named",
              outcome(p),
              {"singular", "free to move", "increment 1", "no increment converged", "diagnosis.md"});

  p.boundary_conditions = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                           condition("top",
                                     BoundaryConditionParameters::Type::displacement,
                                     region(2, {z_plus}),
                                     {0, 1, 2},
                                     {"0", "0", "-0.1*t"})};
  auto newton           = p;
  for (auto &body : newton.bodies)
    body.material.law = MaterialParameters::Law::neo_hookean;
  newton.newton.maximum_iterations = 1;
  newton.load_stepping             = {{1.}, {10}};
  check_words(
      "Newton without iterations left",
      outcome(newton),
      {"Newton did not converge in 1 iterations", "status pass 1", "cut back to 0.0015625", "Minimum increment"});

  auto loop = p;
  use_loops(loop);
  loop.geometry_loop.maximum_passes = 2;
  loop.geometry_loop.tolerance      = 1e-12;
  check_words(
      "a loop without passes left", outcome(loop), {"geometry loop did not converge in 2 passes", "worst at ("});

  auto crushed                         = newton;
  crushed.newton.maximum_iterations    = 25;
  crushed.load_stepping                = {{1.}, {2}};
  crushed.load_stepping.cut_back       = false;
  crushed.boundary_conditions[1].value = {"0", "0", "-4*max(t-0.5,0)-0.01*t"};
  check_words("a crushed block: the last converged state is told",
              outcome(crushed),
              {"increment 2", "The last converged state is t = 0.5"});

  crushed.load_stepping.cut_back = true;
  std::ostringstream lines;
  ContactProblem     through(crushed, world(), lines);
  through.run();
  check_words("a block that the other one goes through in small increments: a warning",
              lines.str(),
              {"warning", "closed sites have no master point any more", "went through"});

  auto apart                             = p;
  apart.bodies[1]                        = box("upper", "2,2,1", {0.1, 0.1, 1.5}, {0.9, 0.9, 2.5}, 100, 0.3);
  apart.contact_pairs[0].search_distance = 0.1;
  ContactProblem problem(apart, world(), log());
  problem.run();
  const auto &r = problem.contact_resultants()[0];
  check("bodies out of reach: every slave node is open and counted as unpaired",
        r.open == 9 && r.unpaired == 9 && r.slave_force.norm() == 0.);
}
