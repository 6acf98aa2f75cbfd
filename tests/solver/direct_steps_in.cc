// An iterative solver that fails leaves its correction to the direct one: with a single Krylov iteration allowed, block
// and condensed solver give the force of the direct solver, and the log says who computed it.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <sstream>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Type = LinearSolverParameters::Type;

  Parameters p;
  p.bodies              = {box("lower", "3,3,2", {-0.2, -0.2, 0}, {1.2, 1.2, 1}, 10, 0.3),
                           box("upper", "2,2,2", {0, 0, 1}, {1, 1, 2}, 20, 0.3)};
  p.boundary_conditions = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                           hold("top", region(2, {z_plus}), {0, 1}),
                           drive("down", region(2, {z_plus}), 2, "-0.01*t")};
  p.contact_pairs       = {pair(region(2, {z_minus}), region(1, {z_plus}), 0.2)};
  p.output.vtu_interval = 0;

  double direct = 0.;
  for (const auto &[type, name] :
       {std::make_pair(Type::direct, "direct"), {Type::block, "block"}, {Type::condensed, "condensed"}})
  {
    p.linear_solver.type               = type;
    p.linear_solver.maximum_iterations = 1;
    p.output.results_folder            = "direct_steps_in_results";
    std::ostringstream text;
    ContactProblem     problem(p, world(), text);
    problem.run();
    const double force = problem.contact_resultants()[0].slave_force[2];
    const bool   said  = text.str().find("this correction comes from the direct solver") != std::string::npos;
    if (type == Type::direct)
    {
      direct = force;
      check("direct: nobody steps in", !said);
      continue;
    }
    check(std::string(name) + ": the direct solver steps in", said);
    check(std::string(name) + ": its force", force, direct, 1e-6);
  }
}
