// A wide plate is pressed on the middle of a narrower block with friction, integration points, once whole and once as
// the half beside a plane of symmetry: the same forces. Points beside the rim of the block are open while others of
// their faces stick, and what open points ask of the friction multipliers of nodes on the plane is nothing across it.
// With rows that asked for it Newton's method and the geometry loop came back to the same residual for ever.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  struct Outcome
  {
    Vector3         force;
    IterationCounts counts;
    unsigned int    stick, open;
  };

  /// @p y: where the bodies begin, 0 on the plane.
  Outcome run(const double y)
  {
    const bool half = y == 0.;
    Parameters p;
    p.bodies              = {box("block", half ? "5,3,2" : "5,6,2", {-0.8, y, -1}, {0.8, 0.8, 0}, 1000, 0.),
                             box("plate", half ? "6,3,2" : "6,6,2", {-1, 1.25 * y, 0}, {1, 1, 0.6}, 400, 0.3)};
    p.boundary_conditions = {hold("support", region(1, {z_minus}), {0, 1, 2}),
                             hold("straight", region(2, {z_plus}), {0, 1}),
                             drive("down", region(2, {z_plus}), 2, "-0.02*t")};
    if (half)
      p.boundary_conditions.push_back(hold("symmetry", region(0, {y_minus}), {1}));
    ContactPairParameters contact = pair(region(2, {z_minus}), region(1, {z_plus}), 0.15);
    contact.normal                = ContactPairParameters::Normal::averaged;
    contact.scheme                = ContactPairParameters::Scheme::integration_point;
    p.contact_pairs               = {contact};
    p.linear_solver.type          = LinearSolverParameters::Type::direct;
    p.newton.force_tolerance      = 1e-9;
    p.newton.contact_tolerance    = 1e-9;
    p.load_stepping.interval_ends = {1.};
    p.load_stepping.increments    = {1};
    p.output.results_folder       = "plane_of_symmetry_results";
    p.output.vtu_interval         = 0;
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto result = problem.contact_resultants()[0];
    return {result.slave_force, problem.iterations(), result.stick, result.open};
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Outcome                            whole = run(-0.8), half = run(0.);
  check_equal("points that stick, of the half", 2 * half.stick, whole.stick);
  check_equal("points that are open", 2 * half.open, whole.open);
  check("force on the half, twice", 2. * half.force[2], whole.force[2], 1e-8);
  check_count("iterations", half.counts.newton, 8);
  check_equal("fallbacks", half.counts.fallbacks, 0);
}
