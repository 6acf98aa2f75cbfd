// Faces that move as rigid bodies do. A block that one face turns by 90 degrees follows it without stress; a square bar
// that is twisted by a small angle theta, its ends free to warp, stores G J theta^2/(2 L) with J = 0.140577 a^4
// (Timoshenko & Goodier, Theory of Elasticity, section 109), and its middle turns by theta/2.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  BoundaryConditionParameters turn(const std::string                &name,
                                   const RegionParameters           &where,
                                   const std::vector<unsigned int>  &components,
                                   const PrescribedMotionParameters &motion)
  {
    auto c   = condition(name, BoundaryConditionParameters::Type::rigid_motion, where, components, {});
    c.motion = motion;
    return c;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  {
    Parameters p;
    p.bodies                 = {box("block", "2,2,2", {0, 0, 0}, {1, 1, 1}, 200., 0.3)};
    p.bodies[0].material.law = MaterialParameters::Law::neo_hookean;
    PrescribedMotionParameters motion;
    motion.translation      = {"0.5*t", "0", "0"};
    motion.rotation         = "90*t";
    motion.rotation_axis    = Vector3({0, 0, 2});
    motion.rotation_centre  = {1, 1, 0};
    p.boundary_conditions   = {turn("turned", region(1, {x_minus}), {0, 1, 2}, motion)};
    p.load_stepping         = {{1.}, {9}};
    p.output.results_folder = "turned_face_block";
    p.output.write_vtu      = false;
    ContactProblem problem(p, world(), log());
    problem.run();
    MPI_Barrier(world());
    for (const Point &X : {Point(0, 0, 0), Point(1, 0, 0), Point(1, 1, 1), Point(0.5, 0.5, 0.5), Point(1, 0.5, 1)})
    {
      // x = c + R (X - c) + T: (X, Y) goes to (1 - (Y - 1) + 0.5, 1 + (X - 1))
      const Vector3 u({2.5 - X[1] - X[0], X[0] - X[1], 0});
      check("block, " + text(X), problem.displacement(1, X), u, 1e-8);
    }
    check("  stored energy over E", last_energy(p.output.results_folder, "stored") / 200., 0., 1e-12, 1.);
  }
  {
    const double E = 200., nu = 0.25, L = 4., degrees = 0.1, theta = degrees * dealii::numbers::PI / 180.;
    Parameters   p;
    p.degree = 2;
    p.bodies = {box("bar", "4,4,4", {-0.5, -0.5, 0}, {0.5, 0.5, L}, E, nu)};
    PrescribedMotionParameters motion;
    motion.rotation         = "0.1*t";
    motion.rotation_axis    = Vector3({0, 0, 1});
    p.boundary_conditions   = {hold("end", region(1, {z_minus}), {0, 1}),
                               hold("corner", region(1, {z_minus}, "abs(x)+abs(y) < 1e-6"), {2}),
                               turn("twisted", region(1, {z_plus}), {0, 1}, motion)};
    p.load_stepping         = {{1.}, {1}};
    p.output.results_folder = "turned_face_bar";
    p.output.write_vtu      = false;
    ContactProblem problem(p, world(), log());
    problem.run();
    MPI_Barrier(world());
    check("bar: stored energy",
          last_energy(p.output.results_folder, "stored"),
          0.5 * E / (2. * (1. + nu)) * 0.140577 * theta * theta / L,
          5e-3);
    check("  middle", problem.displacement(1, {0.5, 0.25, L / 2.})[1], 0.5 * theta * 0.5, 1e-3);
    check("  end", problem.displacement(1, {0.5, 0.25, L})[0], -std::sin(theta) * 0.25, 1e-2);
  }
}
