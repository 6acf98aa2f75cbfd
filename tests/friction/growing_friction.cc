// A soft block is pressed on a harder one and dragged by more than one of its cells in one increment, friction 0.8:
// from the stick of the pressed block the merged iteration and that with a geometry loop do not find the solution. From
// a first iterate with free sliding, friction grows to its value in a few iterations: all closed nodes slip, with their
// friction along the drag to within the little that they slide sideways, and nothing is cut back. Three loops, which
// the run would end with otherwise, come to the same force (to their tolerances, 1 % in the geometry) in more
// iterations.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <sstream>

using namespace Cases;

namespace
{
  struct Outcome
  {
    Vector3         force;
    IterationCounts counts;
    bool            grew, halved;
    unsigned int    n_stick, n_slip;
  };

  Outcome run(const Parameters &p)
  {
    std::ostringstream text;
    ContactProblem     problem(p, world(), text);
    problem.run();
    const auto said   = [&](const std::string &words) { return text.str().find(words) != std::string::npos; };
    const auto result = problem.contact_resultants()[0];
    return {result.slave_force,
            problem.iterations(),
            said("growing friction"),
            said("the increment is halved"),
            result.stick,
            result.slip};
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const double                             mu = 0.8;

  Parameters p;
  p.bodies = {box("lower", "5,4,2", {0, 0, 0}, {1.7, 1.3, 0.5}, 1000, 0.3),
              box("upper", "4,4,3", {0.15, 0.15, 0.5}, {1.15, 1.15, 1}, 100, 0.4)};
  for (auto &body : p.bodies)
    body.material.law = MaterialParameters::Law::neo_hookean;
  p.boundary_conditions = {hold("support", region(1, {z_minus}), {0, 1, 2}),
                           hold("straight", region(2, {z_plus}), {1}),
                           drive("down", region(2, {z_plus}), 2, "-0.01*min(t,1)"),
                           drive("drag", region(2, {z_plus}), 0, "0.35*max(t-1,0)")};
  ContactPairParameters contact;
  contact.slave                 = region(2, {z_minus});
  contact.master                = region(1, {z_plus});
  contact.friction_coefficient  = mu;
  p.contact_pairs               = {contact};
  p.linear_solver.type          = LinearSolverParameters::Type::direct;
  p.load_stepping.interval_ends = {1., 2.};
  p.load_stepping.increments    = {1, 1};
  p.output.results_folder       = "growing_friction_results";
  p.output.vtu_interval         = 0;

  const Outcome grown = run(p);
  check("friction has to grow", grown.grew);
  check_equal("fallbacks", grown.counts.fallbacks, 2);
  check("no increment is halved", !grown.halved);
  check("all closed nodes slip", grown.n_slip > 0 && grown.n_stick == 0);
  check("friction over pressure", -grown.force[0] / grown.force[2], mu, 0.01);
  check("friction at most mu times the pressure", -grown.force[0] <= mu * grown.force[2]);

  check_count("iterations, failed attempts included", grown.counts.newton, 60);

  use_loops(p);
  const Outcome loops = run(p);
  // two digits: the loops stop at tolerances of their own
  check_error("three loops: deviation of the force from that", std::abs(loops.force[0] / grown.force[0] - 1.), 0.01, 2);
}
