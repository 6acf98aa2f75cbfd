// Runs that cannot succeed say so: loop, reason, worst node, last converged state.

#include "../cases.h"
#include "../messages.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  std::string outcome(const Parameters &p, std::ostream &lines = log())
  {
    try
    {
      ContactProblem problem(p, world(), lines);
      problem.run();
      return "no failure";
    }
    catch (const SolverFailure &failure)
    {
      return failure.what();
    }
  }

  bool says(const std::string &text, const std::string &words)
  {
    return text.find(words) != std::string::npos;
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
  p.load_stepping         = {{1.}, {4}};
  std::ostringstream sliding_lines;
  const std::string  sliding = outcome(p, sliding_lines);
  check_words("a body that can slide away is named",
              sliding,
              {"singular",
               "free to move",
               "increment 1 (t = 0.25)",
               "no increment converged",
               "diagnosis.md",
               "contact is closed, but has no friction",
               "Smaller increments do not change that"});
  check("  and no smaller increments are tried nor advised",
        !says(sliding_lines.str(), "halved") && !says(sliding, "Minimum increment") &&
            !says(sliding, "Initial status"));

  auto rubbing                                  = p;
  rubbing.contact_pairs[0].friction_coefficient = 0.5;
  check_words("a closed contact that has no pressure to rub with",
              outcome(rubbing),
              {"friction holds nothing before there is pressure", "Viscous stabilisation"});

  auto above                   = p; // held but for the motion that contact is to stop
  above.bodies[1]              = box("upper", "2,2,1", {0.1, 0.1, 1.05}, {0.9, 0.9, 2.05}, 100, 0.3);
  above.boundary_conditions[1] = hold("sides", region(2, {z_plus}), {0, 1});
  above.boundary_conditions.push_back(press("top", region(2, {z_plus}), "t"));
  std::ostringstream above_lines;
  const std::string  falling = outcome(above, above_lines);
  check_words("a block above the other one may start closed",
              falling,
              {"close the contact first ('Initial status = closed')", "Smaller increments do not change that"});
  check("  and has one attempt", !says(above_lines.str(), "again with") && !says(falling, "would still leave"));
  above.contact_pairs[0].start.status = ContactPairParameters::InitialStatus::closed;
  check("  and then does not fail", outcome(above) == "no failure");
  above.contact_pairs[0].start.status = ContactPairParameters::InitialStatus::by_gap;
  above.boundary_conditions.erase(above.boundary_conditions.begin() + 1);
  check_words("a block that closed contact would not hold either",
              outcome(above),
              {"'Initial status = closed' alone would still leave 3 of 6 motions free"});

  auto pulled                = p; // contact opens in the course of the third increment
  pulled.boundary_conditions = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                                hold("sides", region(2, {z_plus}), {0, 1}),
                                press("top", region(2, {z_plus}), "min(t,1)-1.7*max(t-1,0)")};
  pulled.load_stepping       = {{1., 2.}, {2, 1}};
  std::ostringstream pulled_lines;
  const std::string  lifted = outcome(pulled, pulled_lines);
  check("a contact that opens on the way: smaller increments are tried, up to where it opens",
        says(pulled_lines.str(), "halved") && says(lifted, "free to move") && says(lifted, "cut back to") &&
            says(lifted, "The last converged state is t = 1.5"));

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
  crushed.strategy.without       = {"second pass"}; // which would hold it until cells are turned inside out
  check_words("a block that the other one goes through in small increments",
              outcome(crushed),
              {"does not hold where it is measured anew", "penetration depth", "of Contact pair 1 ('pair')"});

  auto held                                  = p;
  held.boundary_conditions                   = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                                                hold("contact below", region(1, {z_plus}), {0, 1}),
                                                condition("contact above",
                                        BoundaryConditionParameters::Type::displacement,
                                        region(2, {z_minus}),
                                        {0, 1},
                                        {"0.1*t", "0"}),
                                                condition("top",
                                        BoundaryConditionParameters::Type::displacement,
                                        region(2, {z_plus}),
                                        {0, 1, 2},
                                        {"0.1*t", "0", "-0.02"})};
  held.contact_pairs[0].friction_coefficient = 0.3;
  check_words("friction where displacements of both sides are prescribed",
              outcome(held),
              {"prescribed slip", "slave node (", "leave the displacements of one side free", "not cut back"});
  // averages at the planes x = 0 and y = 0 reach nodes beside them, which move outwards
  auto quarter                                  = p;
  quarter.bodies                                = {box("lower", "9,9,2", {0, 0, 0}, {1, 1, 1}, 100, 0.3),
                                                   box("upper", "4,4,2", {0, 0, 1}, {0.7, 0.7, 1.5}, 500, 0.3)};
  quarter.boundary_conditions                   = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                                                   hold("x = 0", region(0, {x_minus}), {0}),
                                                   hold("y = 0", region(0, {y_minus}), {1}),
                                                   drive("top", region(2, {z_plus}), 2, "-0.1*t")};
  quarter.contact_pairs[0].scheme               = ContactPairParameters::Scheme::averaged;
  quarter.contact_pairs[0].friction_coefficient = 0.3;
  quarter.load_stepping                         = {{1.}, {1}};
  check("friction on planes of symmetry is not held by them", outcome(quarter) == "no failure");

  held.boundary_conditions[1].components = {0, 1, 2};
  held.boundary_conditions[1].value      = {"0", "0", "0"};
  held.boundary_conditions[2].components = {0, 1, 2};
  held.boundary_conditions[2].value      = {"0.1*t", "0", "-0.02*t"};
  check_words("pressure where displacements of both sides are prescribed",
              outcome(held),
              {"prescribed penetration", "slave node ("});

  // A punch of 0.2 into the top of a block of one cell: no node and no integration point of that is above the punch. A
  // second pass would hold it (contact/second_pass.cc).
  auto punch             = p;
  punch.strategy.without = {"second pass"};
  punch.bodies           = {box("block", "1,1,1", {0, 0, 0}, {1, 1, 1}, 1000, 0.3),
                            box("punch", "2,2,2", {0.4, 0.4, 1}, {0.6, 0.6, 1.2}, 1000, 0.3)};
  punch.contact_pairs    = {pair(region(1, {z_plus}), region(2, {z_minus}))};
  auto &scheme           = punch.contact_pairs[0].scheme;
  for (const auto kind : {ContactPairParameters::Scheme::nodal, ContactPairParameters::Scheme::integration_point})
  {
    scheme = kind;
    check_words("a punch between the sites of a coarse slave is not left without contact",
                outcome(punch),
                {"penetration unseen", "master node (", "of Contact pair 1 ('pair')"});
  }
  scheme = ContactPairParameters::Scheme::averaged;
  check("  the averaged scheme sees it", outcome(punch) == "no failure");

  // A ball of a mesh, smaller than the one face of the slave, is no facet of a curved surface.
  auto small                          = punch;
  small.bodies[1].generator_arguments = "0.5,0.5,1.2 : 0.2 : false";
  small.bodies[1].generator           = "hyper_ball";
  small.bodies[1].global_refinement   = 2;
  small.boundary_conditions[1].region = region(2, {0}, "z > 1.2");
  small.contact_pairs[0]              = pair(region(1, {z_plus}), region(2, {0}, "z < 1.19"));
  small.contact_pairs[0].scheme       = ContactPairParameters::Scheme::nodal;
  check_words("nor is a ball in the middle of its face", outcome(small), {"penetration unseen", "master node ("});

  // A slave face that feels the master at one pair of its points alone tilts, and comes up beyond the master's rim: by
  // 0.07 and 0.14 faces of the master.
  auto rim                            = punch;
  rim.bodies[1]                       = box("punch", "7,10,1", {0, 0, 1}, {0.7, 1, 1.2}, 1e6, 0.3);
  rim.contact_pairs[0].scheme         = ContactPairParameters::Scheme::integration_point;
  rim.boundary_conditions[1].value[2] = "-0.01*t";
  check("a coarse slave comes up a little beyond the rim of its master", outcome(rim) == "no failure");
  rim.boundary_conditions[1].value[2] = "-0.02*t";
  check_words("  but not by more than a tenth of a face",
              outcome(rim),
              {"penetration depth", "tolerance 0.1,", "master node (0.7", "of Contact pair 1 ('pair')"});

  // A rigid ball is driven through a sheet, from above it to below it, in one increment.
  auto thrown                   = p;
  thrown.bodies                 = {box("sheet", "4,4,1", {0, 0, 0}, {1, 1, 0.1}, 100, 0.3)};
  thrown.boundary_conditions    = {hold("frame", region(1, {x_minus, x_plus}), {0, 1, 2})};
  thrown.contact_pairs          = {ContactPairParameters()};
  thrown.contact_pairs[0].slave = region(1, {z_plus});
  thrown.load_stepping          = {{1.}, {1}};
  thrown.load_stepping.cut_back = false;
  auto &ball                    = thrown.contact_pairs[0].master_surface;
  ball.shape                    = MasterSurfaceParameters::Shape::sphere;
  ball.point                    = Point(0.5, 0.5, 0.3);
  ball.radius                   = 0.15;
  ball.motion.translation       = {"0", "0", "-0.8*t"};
  check_words("a ball thrown through a sheet is noticed",
              outcome(thrown),
              {"nodes passed through", "slave node (0.5 0.5 0.1)"});

  auto apart                             = p;
  apart.bodies[1]                        = box("upper", "2,2,1", {0.1, 0.1, 1.5}, {0.9, 0.9, 2.5}, 100, 0.3);
  apart.contact_pairs[0].search_distance = 0.1;
  std::ostringstream apart_lines;
  ContactProblem     problem(apart, world(), apart_lines);
  problem.run();
  const auto &r = problem.contact_resultants()[0];
  check("bodies out of reach: every slave node is open and counted as unpaired",
        r.open == 9 && r.unpaired == 9 && r.slave_force.norm() == 0.);
  check("  which the log says, and no warning of energies that are round-off",
        !root() || (says(apart_lines.str(), "contact pair 1 (pair) was open at the end of every increment") &&
                    !says(apart_lines.str(), "Energies: ")));
}
