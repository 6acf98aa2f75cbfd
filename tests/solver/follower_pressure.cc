// Pressure that follows a free face, whose edge is not held: a block under it bends and turns away by a third of its
// height. The tangent is complete, so that Newton's method takes few iterations with every solver, and the end does not
// depend on the increments.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;
using Type = BoundaryConditionParameters::Type;

namespace
{
  Vector3 tip(const std::string                 &name,
              const LinearSolverParameters::Type solver,
              const unsigned int                 degree,
              const unsigned int                 increments)
  {
    Parameters p;
    p.bodies                      = {box("block", "8,1,4", {0, 0, 0}, {4, 0.4, 2}, 6, 0.4)};
    p.bodies[0].material.law      = MaterialParameters::Law::neo_hookean;
    p.boundary_conditions         = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                                     hold("sides", region(1, {2, 3}), {1}),
                                     condition("pressure", Type::pressure, region(1, {0}), {}, {"2*t"})};
    p.degree                      = degree;
    p.load_stepping.interval_ends = {1.};
    p.load_stepping.increments    = {increments};
    p.load_stepping.cut_back      = false;
    p.linear_solver.type          = solver;
    p.output.results_folder       = "follower_pressure_results";
    ContactProblem problem(p, world(), log());
    unsigned int   most = 0;
    problem.on_increment([&](unsigned int, double) { most = std::max(most, problem.iterations().newton); });
    problem.run();
    check_count(name + ": most Newton iterations of an increment", most, 5);
    const Vector3 u = problem.displacement(1, Point(0, 0, 2));
    report("  displacement of the upper edge", Numbers::number(u[0]) + " " + Numbers::number(u[2]));
    return u;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Solver = LinearSolverParameters::Type;
  for (const unsigned int degree : {1u, 2u})
  {
    const std::string title = "degree " + std::to_string(degree);
    const Vector3     u     = tip(title + ", direct, 2 increments", Solver::direct, degree, 2);
    check("  10 increments of the iterative solver end there",
          (tip(title + ", iterative, 10 increments", Solver::condensed, degree, 10) - u).norm() < 1e-6 * u.norm());
  }
}
