// Surfaces in closed form that rigid bodies without a mesh carry.
// - A plane that presses a cube with a given force, all solvers, loops and merged iteration: uniaxial stress.
// - Eccentrically on a frictionless beam: E I/H turns it.
// - A tied plane that turns by 50 degrees about an oblique axis, moved as the pair says and as a body says: the same.
//   Driven by the force and the moment that this takes: there again, converging quadratically.
// - A plane that a moment tilts on a frictionless cube: merged iterations follow its normals.
// - Every surface and scheme pressed in and dragged with friction: forces, then driven by these.
// - A cylinder that is pressed and pulled over a block with friction: it rolls.
// - Two planes of one body on two cubes: it takes the force of both.
// On any number of ranks.

#include "driven_body.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Solver = LinearSolverParameters::Type;
  using Shape  = MasterSurfaceParameters::Shape;
  using Scheme = ContactPairParameters::Scheme;

  const std::string folder = "carried_master_results";

  BodyParameters tool()
  {
    BodyParameters body;
    body.name  = "tool";
    body.rigid = true;
    return body;
  }

  /// A cube under a plane that body 2 carries.
  Parameters cube_under_plane(const unsigned int degree, const double nu)
  {
    Parameters p;
    p.degree                                = degree;
    p.bodies                                = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, nu), tool()};
    p.contact_pairs                         = {ContactPairParameters()};
    p.contact_pairs[0].slave                = region(1, {z_plus});
    p.contact_pairs[0].master.bodies        = {2};
    p.contact_pairs[0].master_surface.shape = Shape::plane;
    p.contact_pairs[0].master_surface.point = Point(0.3, -0.2, 1.);
    p.contact_pairs[0].master_surface.axis  = Vector3({0., 0., -1.});
    p.boundary_conditions                   = {hold("x", region(1, {x_minus}), {0}),
                                               hold("y", region(1, {y_minus}), {1}),
                                               hold("z", region(1, {z_minus}), {2})};
    p.output.results_folder                 = folder;
    p.output.write_vtu                      = false;
    p.load_stepping                         = {{1.}, {2}};
    return p;
  }

  void check_pressed(const unsigned int degree, const Solver solver, const bool loops)
  {
    Parameters p            = cube_under_plane(degree, 0.3);
    p.bodies[1].rigid_free  = {2};
    p.bodies[1].rigid_force = {"0", "0", "-10*t"};
    p.linear_solver.type    = solver;
    if (loops)
      use_loops(p);
    ContactProblem problem(p, world(), log());
    problem.run();
    check("pressed, degree " + std::to_string(degree) + ", " + text_of(solver) + (loops ? ", loops" : "") +
              ": displacement of the plane",
          problem.rigid_bodies()[0].translation[2],
          -0.01,
          1e-8);
    check("  side of the cube", problem.displacement(1, Point(1, 1, 1))[0], 0.003, 1e-7);
    check("  force on the plane", problem.rigid_bodies()[0].force[2], -10., 1e-9);
    check("  of contact", problem.contact_resultants()[0].master_force[2], 10., 1e-9);
    // one or two, as the last digits of iterative solution have it
    check("  at most two Newton iterations in the last increment", problem.iterations().newton <= 2);
  }

  /// The beam turns by M H/(E I); that the force is eccentric on the bent beam changes this by F H^2/(E I) = 0.0012.
  void check_eccentric(const bool loops)
  {
    const double force = -0.1, moment = 0.01, turn = moment / (1000. / 12.);
    Parameters   p                     = cube_under_plane(2, 0.);
    p.boundary_conditions[0]           = hold("x", region(1, {z_minus}, "abs(x-0.5)<1e-6"), {0});
    p.bodies[1].motion.rotation_centre = {0.5, 0.5, 1.};
    p.bodies[1].rigid_free             = {2, 3, 4};
    p.bodies[1].rigid_force            = {"0", "0", std::to_string(force) + "*t"};
    p.bodies[1].rigid_moment           = {"0", std::to_string(moment) + "*t", "0"};
    if (loops)
      use_loops(p);
    p.newton.force_tolerance   = 1e-10;
    p.newton.contact_tolerance = 1e-10;
    p.geometry_loop.tolerance  = 1e-8;
    ContactProblem problem(p, world(), log());
    problem.run();
    const RigidBodyMotion motion = problem.rigid_bodies()[0];
    check(std::string("eccentric") + (loops ? ", loops" : "") + ": turn", motion.rotation[1], turn, 2e-3);
    check("  displacement", motion.translation[2], force / 1000., 2e-3);
    const auto  contact = problem.contact_resultants()[0];
    const Point centre  = Point(0.5, 0.5, 1.) + motion.translation;
    check("  equilibrium of forces", contact.master_force[2], -force, 1e-9);
    check("  of moments", moment_about(centre, contact.master_moment, contact.master_force)[1], -moment, 1e-9);
  }

  void check_finite_rotation(const unsigned int degree, const Scheme scheme, const bool loops)
  {
    const Point centre(0.5, 0.4, 1.);
    Parameters  p                  = cube_under_plane(degree, 0.3);
    p.bodies[0].material.law       = MaterialParameters::Law::neo_hookean;
    p.contact_pairs[0].contact_law = ContactPairParameters::ContactLaw::tied;
    p.contact_pairs[0].scheme      = scheme;
    p.boundary_conditions          = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    p.load_stepping                = {{1.}, {5}};
    p.newton.force_tolerance       = 1e-11;
    p.newton.contact_tolerance     = 1e-11;
    p.geometry_loop.tolerance      = 1e-9;
    if (loops)
    {
      use_loops(p);
      p.load_stepping.predictor = false; // Newton's method starts far enough away for its order to show
    }
    Parameters moved = p, carried = p;
    for (PrescribedMotionParameters *const motion :
         {&moved.contact_pairs[0].master_surface.motion, &carried.bodies[1].motion})
    {
      motion->rotation        = "50*t";
      motion->rotation_axis   = Vector3({1., 2., 3.});
      motion->rotation_centre = {centre[0], centre[1], centre[2]};
      motion->translation     = {"0.1*t", "-0.05*t", "0.2*t"};
    }
    moved.bodies.pop_back();
    moved.contact_pairs[0].master = RegionParameters();
    ContactProblem by_pair(moved, world(), log()), by_body(carried, world(), log());
    by_pair.run();
    by_body.run();
    const ContactResultants on_pair = by_pair.contact_resultants()[0], on_body = by_body.contact_resultants()[0];
    check("finite rotation, degree " + std::to_string(degree) + ", " + text_of(scheme) + (loops ? ", loops" : "") +
              ", moved by the body as by the pair: force",
          on_body.master_force,
          on_pair.master_force,
          1e-8);
    check("  moment", on_body.master_moment, on_pair.master_moment, 1e-8);

    const Vector3 translation({0.1, -0.05, 0.2}), force = -on_pair.master_force;
    const Vector3 moment               = moment_about(centre + translation, -on_pair.master_moment, force);
    Parameters    q                    = p;
    q.bodies[1].motion.rotation_centre = {centre[0], centre[1], centre[2]};
    q.bodies[1].rigid_free             = {0, 1, 2, 3, 4, 5};
    q.bodies[1].rigid_force            = ramp(force);
    q.bodies[1].rigid_moment           = ramp(moment);
    ContactProblem problem(q, world(), log());
    problem.run();
    const RigidBodyMotion found = problem.rigid_bodies()[0];
    check("  driven: translation", found.translation, translation, 1e-6);
    check(
        "  rotation", found.rotation, 50. / 180. * dealii::numbers::PI / std::sqrt(14.) * Vector3({1., 2., 3.}), 1e-6);
    if (loops)
      check("  converges quadratically", is_quadratic(folder));
  }

  /// Merged iterations follow the normals of a plane that turns: frictionless, by 0.06. Without the
  /// normals' variation the last increment takes nine iterations.
  void check_tilt(const Scheme scheme)
  {
    Parameters p                       = cube_under_plane(1, 0.3);
    p.bodies[0].material.law           = MaterialParameters::Law::neo_hookean;
    p.contact_pairs[0].scheme          = scheme;
    p.bodies[1].motion.rotation_centre = {0.5, 0.5, 1.};
    p.bodies[1].rigid_free             = {2, 4};
    p.bodies[1].rigid_force            = {"0", "0", "-150*t"};
    p.bodies[1].rigid_moment           = {"0", "15*t", "0"};
    p.newton.force_tolerance           = 1e-11;
    p.newton.contact_tolerance         = 1e-11;
    ContactProblem problem(p, world(), log());
    problem.run();
    // not a reference, but how far it is to turn
    check("tilted, " + text_of(scheme) + ": turns by", problem.rigid_bodies()[0].rotation[1], 0.06, 0.1);
    check_count("  fallbacks", problem.iterations().fallbacks, 0);
    check_count("  quadratically, in iterations", problem.iterations().newton, 5);
  }

  /// Pressed in by 0.04 and dragged with friction, then pressed by the force that this takes.
  void check_surface(const Shape shape, const Scheme scheme)
  {
    Parameters p;
    p.bodies              = {box("block", "6,4,3", {-1, -0.6, -1}, {1, 0.6, 0}, 1000, 0.3), tool()};
    p.boundary_conditions = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    p.contact_pairs       = {ContactPairParameters()};
    auto &pair            = p.contact_pairs[0];
    pair.slave            = region(1, {z_plus});
    pair.master.bodies    = {2};
    pair.master_surface   = {shape, {}, {}, 2., false, {}, {}};
    // deep enough for the integration points to touch it at first
    pair.master_surface.point = Point(0, 0, (shape == Shape::paraboloid || shape == Shape::plane ? 0 : 2) - 0.01);
    pair.master_surface.axis  = shape == Shape::cylinder ? Vector3({0., 1., 0.}) : Vector3({0., 0., -1.});
    if (shape == Shape::plane)
      pair.master_surface.radius = 0.;
    pair.scheme                    = scheme;
    pair.friction_coefficient      = 0.3;
    p.load_stepping                = {{1., 2.}, {1, 1}};
    p.newton.force_tolerance       = 1e-11;
    p.newton.contact_tolerance     = 1e-11;
    p.geometry_loop.tolerance      = 1e-9;
    p.threshold_loop.tolerance     = 1e-9;
    p.output.results_folder        = folder;
    p.output.write_vtu             = false;
    Parameters q                   = p;
    p.bodies[1].motion.translation = {"0.01*max(0,t-1)", "0", "-0.04*min(t,1)"};
    q.bodies[1].motion.translation = {"0.01*max(0,t-1)", "0", "0"};
    ContactProblem prescribed(p, world(), log());
    prescribed.run();
    const ContactResultants held = prescribed.contact_resultants()[0];

    // for the same path of forces
    Parameters pressing    = p;
    pressing.load_stepping = {{1.}, {1}};
    ContactProblem only_pressed(pressing, world(), log());
    only_pressed.run();
    const double       pressed = -only_pressed.contact_resultants()[0].master_force[2];
    std::ostringstream expression;
    expression << std::setprecision(17) << pressed << "*min(t,1)+(" << -held.master_force[2] - pressed
               << ")*max(0,t-1)";
    q.bodies[1].rigid_free     = {2};
    q.bodies[1].rigid_force[2] = expression.str();
    ContactProblem driven(q, world(), log());
    driven.run();
    check(text_of(shape) + ", " + text_of(scheme) + ": driven as far as prescribed",
          driven.rigid_bodies()[0].translation[2],
          -0.04,
          1e-6);
    check("  resistance", driven.contact_resultants()[0].master_force[0], held.master_force[0], 1e-6);
  }

  /// A cylinder of radius 1, pressed into a block by 20 and pulled along x by 0.3: the facets of a mesh would cost.
  void check_roller()
  {
    Parameters p;
    p.bodies                           = {box("block", "22,1,4", {-0.9, 0, -1}, {1.3, 0.4, 0}, 1000, 0.3), tool()};
    p.bodies[1].rigid_free             = {2, 4};
    p.bodies[1].rigid_force            = {"0", "0", "-20*min(t,1)"};
    p.bodies[1].motion.translation     = {"0.3*max(0,t-1)", "0", "0"};
    p.bodies[1].motion.rotation_centre = {0., 0.2, 1.};
    p.boundary_conditions              = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                          hold("y", region(1, {y_minus, y_plus}), {1})};
    p.contact_pairs                    = {ContactPairParameters()};
    p.contact_pairs[0].slave           = region(1, {z_plus});
    p.contact_pairs[0].master.bodies   = {2};
    p.contact_pairs[0].master_surface  = {Shape::cylinder, Point(0., 0.2, 1.), Vector3({0., 1., 0.}), 1., false, {}, {}};
    p.contact_pairs[0].friction_coefficient = 0.5;
    p.load_stepping                         = {{1., 2.}, {2, 8}};
    p.output.results_folder                 = folder;
    p.output.write_vtu                      = false;
    ContactProblem problem(p, world(), log());
    problem.run();
    const RigidBodyMotion roller = problem.rigid_bodies()[0];
    check("roller: turns by its way over its radius", roller.rotation[1], 0.3, 0.01);
    check_error("  its resistance over that of sliding", std::abs(roller.force[0]) / (0.5 * 20.), 0.02);
    check("  pressed by", problem.contact_resultants()[0].master_force[2], 20., 1e-8);
  }

  /// Cubes of 1000 and 3000 MPa, the second lower by 0.002: F = 1000 u + 3000 (u - 0.002).
  void check_two_surfaces()
  {
    Parameters p                = cube_under_plane(1, 0.);
    p.bodies                    = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, 0),
                                   tool(),
                                   box("stiff cube", "2,2,2", {2, 0, 0}, {3, 1, 1}, 3000, 0)};
    p.boundary_conditions       = {hold("z", region(0, {z_minus}), {0, 1, 2})};
    auto second                 = p.contact_pairs[0];
    second.slave                = region(3, {z_plus});
    second.master_surface.point = Point(2.5, 0., 1.002);
    p.contact_pairs.push_back(second);
    p.bodies[1].rigid_free  = {2};
    p.bodies[1].rigid_force = {"0", "0", "-10*t"};
    ContactProblem problem(p, world(), log());
    problem.run();
    const double u = 16. / 4000.;
    check("two surfaces: displacement", problem.rigid_bodies()[0].translation[2], -u, 1e-8);
    check("  first force", problem.contact_resultants()[0].master_force[2], 1000. * u, 1e-8);
    check("  second", problem.contact_resultants()[1].master_force[2], 3000. * (u - 0.002), 1e-8);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const Solver solver : {Solver::direct, Solver::condensed, Solver::block})
    for (const bool loops : {false, true})
      check_pressed(1, solver, loops);
  check_pressed(2, Solver::direct, false);
  check_eccentric(false);
  check_eccentric(true);
  for (const bool loops : {false, true})
    for (const Scheme scheme : {Scheme::nodal, Scheme::averaged, Scheme::integration_point})
      check_finite_rotation(1, scheme, loops);
  check_finite_rotation(2, Scheme::averaged, true);
  for (const Scheme scheme : {Scheme::nodal, Scheme::averaged, Scheme::integration_point})
    check_tilt(scheme);
  for (const Shape shape : {Shape::plane, Shape::sphere, Shape::cylinder, Shape::paraboloid})
    for (const Scheme scheme : {Scheme::nodal, Scheme::averaged, Scheme::integration_point})
      check_surface(shape, scheme);
  check_roller();
  check_two_surfaces();
}
