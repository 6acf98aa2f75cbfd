// Rigid bodies that force and moment drive.
// - One that presses a cube with a given force, all solvers, loops and merged iteration: uniaxial stress.
// - The same with a gap, which viscous stabilisation brings it through.
// - One that presses it eccentrically on a frictionless surface: the beam bends, E I/H turns it; equilibrium.
// - Six free components, cube tied to it: force and moment that hold it in a given place after a turn of 50 degrees
//   about an oblique axis put it there.
// - A roller that is pressed and pulled over a block with friction: it rolls.
// - One without resistance in a direction: named.
// On any number of ranks.

#include "driven_body.h"

#include <deal.II/base/mpi.h>

#include <fstream>

using namespace Cases;

namespace
{
  using Solver = LinearSolverParameters::Type;

  const std::string folder = "driven_rigid_body_results";

  /// A cube and a rigid plate above it, whose mesh does not match.
  Parameters cube_and_plate(const unsigned int degree, const double nu)
  {
    Parameters p;
    p.degree                  = degree;
    p.bodies                  = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, nu),
                                 box("plate", "3,3,2", {-0.5, -0.5, 1}, {1.5, 1.5, 1.5}, 0, 0)};
    p.bodies[1].material      = MaterialParameters();
    p.bodies[1].rigid         = true;
    p.contact_pairs           = {ContactPairParameters()};
    p.contact_pairs[0].slave  = region(1, {z_plus});
    p.contact_pairs[0].master = region(2, {z_minus});
    p.boundary_conditions     = {hold("x", region(1, {x_minus}), {0}),
                                 hold("y", region(1, {y_minus}), {1}),
                                 hold("z", region(1, {z_minus}), {2})};
    p.output.results_folder   = folder;
    p.output.write_vtu        = false;
    p.load_stepping           = {{1.}, {2}};
    return p;
  }

  std::vector<double> last_row(const std::string &file, const unsigned int first)
  {
    MPI_Barrier(world());
    std::ifstream stream(folder + "/" + file);
    std::string   line, last;
    while (std::getline(stream, line))
      last = line;
    std::vector<double> row;
    std::istringstream  cells(last);
    for (std::string cell; std::getline(cells, cell, ',');)
      row.push_back(row.size() < first ? 0. : std::stod(cell));
    return row;
  }

  void check_pressed(const unsigned int degree, const Solver solver, const bool loops)
  {
    Parameters p            = cube_and_plate(degree, 0.3);
    p.bodies[1].rigid_free  = {2};
    p.bodies[1].rigid_force = {"0", "0", "-10*t"};
    p.linear_solver.type    = solver;
    if (loops)
      use_loops(p);
    ContactProblem problem(p, world(), log());
    problem.run();
    check("pressed, degree " + std::to_string(degree) + ", " + text_of(solver) + (loops ? ", loops" : "") +
              ": displacement of the plate",
          problem.displacement(2, Point(1.5, -0.5, 1.5))[2],
          -0.01,
          1e-8);
    check("  side of the cube", problem.displacement(1, Point(1, 1, 1))[0], 0.003, 1e-7);
    check("  force on it", problem.rigid_bodies()[0].force[2], -10., 1e-9);
    check("  of contact", problem.contact_resultants()[0].master_force[2], 10., 1e-9);
    const std::vector<double> energy = last_row("energy.csv", 0), motion = last_row("rigid_bodies.csv", 3);
    check("  its work", energy[2], 0.05, 1e-7);
    check("  is stored", energy[5], 0.05, 1e-7);
    check("  rigid_bodies.csv, columns", motion.size(), 15, 1e-9);
    check("  displacement", motion[5], -0.01, 1e-7);
    // one or two, as the last digits of iterative solution have it
    check("  at most two Newton iterations in the last increment", problem.iterations().newton <= 2);
  }

  /// Viscous stabilisation brings the plate down to the cube.
  void check_gap(const bool loops)
  {
    Parameters p                          = cube_and_plate(1, 0.);
    p.bodies[1]                           = box("plate", "3,3,2", {-0.5, -0.5, 1.01}, {1.5, 1.5, 1.5}, 0, 0);
    p.bodies[1].material                  = MaterialParameters();
    p.bodies[1].rigid                     = true;
    p.bodies[1].rigid_free                = {2, 3};
    p.bodies[1].rigid_force               = {"0", "0", "-10"};
    p.bodies[1].motion.rotation_centre    = {0.5, 0.5, 1.};
    p.load_stepping.increments            = {4};
    p.load_stepping.viscous_stabilisation = {1e-2};
    if (loops)
      use_loops(p);
    std::ostringstream text;
    ContactProblem     problem(p, world(), text);
    problem.run();
    if (root())
      check("gap: the free motions are named",
            text.str().find("body 2 (plate) moves along (0 0 1)") != std::string::npos &&
                text.str().find("body 2 (plate) turns about (1 0 0)") != std::string::npos);
    check("  displacement of the plate", problem.rigid_bodies()[0].translation[2], -0.02, 1e-6);
    check("  its rotation", problem.rigid_bodies()[0].rotation.norm() < 1e-7);
    check("  force of contact", problem.contact_resultants()[0].master_force[2], 10., 1e-8);
  }

  void check_unresisted()
  {
    Parameters p            = cube_and_plate(1, 0.3);
    p.bodies[1].rigid_free  = {0, 2};
    p.bodies[1].rigid_force = {"0", "0", "-10*t"};
    std::ostringstream text;
    try
    {
      ContactProblem problem(p, world(), text);
      problem.run();
      check("no friction, free along x: the run stops", false);
    }
    catch (const SolverFailure &failure)
    {
      check("no friction, free along x: the run stops",
            std::string(failure.what()).find("rigid body 2 (plate) moves along (1 0 0)") != std::string::npos);
    }
    if (root())
      check("  after a warning", text.str().find("body 2 (plate) moves along (1 0 0)") != std::string::npos);

    p.bodies[1]                             = box("plate", "3,3,2", {-0.5, -0.5, 1.01}, {1.5, 1.5, 1.5}, 0, 0);
    p.bodies[1].material                    = MaterialParameters();
    p.bodies[1].rigid                       = true;
    p.bodies[1].rigid_free                  = {2};
    p.bodies[1].rigid_force                 = {"0", "0", "-10*t"};
    p.contact_pairs[0].friction_coefficient = 0.3;
    try
    {
      ContactProblem problem(p, world(), log());
      problem.run();
      check("a gap, friction that may come: the run stops at once", false);
    }
    catch (const SolverFailure &failure)
    {
      check("a gap, friction that may come: the run stops at once",
            std::string(failure.what()).find("so the increment was not cut back") != std::string::npos);
    }
  }

  /// The beam turns by M H/(E I); that the force is eccentric on the bent beam changes this by F H^2/(E I) = 0.0012.
  void check_eccentric(const bool loops)
  {
    const double force = -0.1, moment = 0.01, turn = moment / (1000. / 12.);
    Parameters   p                     = cube_and_plate(2, 0.);
    p.boundary_conditions[0]           = hold("x", region(1, {z_minus}, "abs(x-0.5)<1e-6"), {0});
    p.bodies[1].motion.rotation_centre = {0.5, 0.5, 1.};
    Parameters q                       = p;
    p.bodies[1].rigid_free             = {2, 3, 4};
    p.bodies[1].rigid_force            = {"0", "0", std::to_string(force) + "*t"};
    p.bodies[1].rigid_moment           = {"0", std::to_string(moment) + "*t", "0"};
    for (Parameters *const parameters : {&p, &q})
    {
      if (loops)
        use_loops(*parameters);
      parameters->newton.force_tolerance   = 1e-10;
      parameters->newton.contact_tolerance = 1e-10;
      parameters->geometry_loop.tolerance  = 1e-8;
    }
    ContactProblem problem(p, world(), log());
    problem.run();
    const RigidBodyMotion motion = problem.rigid_bodies()[0];
    check(std::string("eccentric") + (loops ? ", loops" : "") + ": turn", motion.rotation[1], turn, 2e-3);
    check("  displacement", motion.translation[2], force / 1000., 2e-3);
    const auto  contact = problem.contact_resultants()[0];
    const Point centre  = Point(0.5, 0.5, 1.) + motion.translation;
    check("  equilibrium of forces", contact.master_force[2], -force, 1e-9);
    check("  of moments", moment_about(centre, contact.master_moment, contact.master_force)[1], -moment, 1e-9);

    std::ostringstream translation, rotation;
    translation << std::setprecision(17) << motion.translation[2] << "*t";
    rotation << std::setprecision(17) << motion.rotation[1] * 180. / dealii::numbers::PI << "*t";
    q.bodies[1].motion.translation[2] = translation.str();
    q.bodies[1].motion.rotation       = rotation.str();
    q.bodies[1].motion.rotation_axis  = Vector3({0., 1., 0.});
    ContactProblem prescribed(q, world(), log());
    prescribed.run();
    const auto same = prescribed.contact_resultants()[0];
    check("  prescribed like this: force", same.master_force[2], -force, 1e-8);
    check("  moment", moment_about(centre, same.master_moment, same.master_force)[1], -moment, 1e-8);
  }

  void check_finite_rotation(const unsigned int degree, const Solver solver, const bool loops)
  {
    Parameters p                   = cube_and_plate(degree, 0.3);
    p.bodies[0].material.law       = MaterialParameters::Law::neo_hookean;
    p.contact_pairs[0].contact_law = ContactPairParameters::ContactLaw::tied;
    p.boundary_conditions          = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    p.load_stepping                = {{1.}, {5}};
    p.newton.force_tolerance       = 1e-11;
    p.newton.contact_tolerance     = 1e-11;
    if (loops)
    {
      use_loops(p);
      p.load_stepping.predictor = false; // Newton's method starts far enough away for its order to show
    }
    Parameters q           = p;
    auto      &motion      = p.bodies[1].motion;
    motion.rotation        = "50*t";
    motion.rotation_axis   = Vector3({1., 2., 3.});
    motion.rotation_centre = {0.5, 0.4, 1.};
    motion.translation     = {"0.1*t", "-0.05*t", "0.2*t"};
    ContactProblem prescribed(p, world(), log());
    prescribed.run();
    const Vector3 translation({0.1, -0.05, 0.2});
    const Vector3 force = -prescribed.contact_resultants()[0].master_force;
    const Vector3 moment =
        moment_about(Point(0.5, 0.4, 1.) + translation, -prescribed.contact_resultants()[0].master_moment, force);

    q.bodies[1].motion.rotation_centre = {0.5, 0.4, 1.};
    q.bodies[1].rigid_free             = {0, 1, 2, 3, 4, 5};
    q.linear_solver.type               = solver;
    q.bodies[1].rigid_force            = ramp(force);
    q.bodies[1].rigid_moment           = ramp(moment);
    ContactProblem problem(q, world(), log());
    problem.run();
    const RigidBodyMotion found = problem.rigid_bodies()[0];
    check("finite rotation, degree " + std::to_string(degree) + ", " + text_of(solver) + (loops ? ", loops" : "") +
              ": translation",
          found.translation,
          translation,
          1e-6);
    check("  rotation", found.rotation, 50. / 180. * dealii::numbers::PI / std::sqrt(14.) * motion.rotation_axis, 1e-6);
    check("  corner of the plate",
          problem.displacement(2, Point(1.5, -0.5, 1.5)),
          prescribed.displacement(2, Point(1.5, -0.5, 1.5)),
          1e-6);
    check("  force", -problem.contact_resultants()[0].master_force, force, 1e-9);
    check("  moment",
          moment_about(Point(0.5, 0.4, 1.) + found.translation,
                       -problem.contact_resultants()[0].master_moment,
                       -problem.contact_resultants()[0].master_force),
          moment,
          1e-9);
    if (loops)
      check("  converges quadratically", is_quadratic(folder));
    const std::vector<double> energy = last_row("energy.csv", 0);
    check_error("  energy that is not accounted for", std::abs(energy[9] / energy[2]), 0.02);
  }

  /// A roller of radius 1, pressed into a block by 20 and pulled along x by 0.3.
  void check_roller()
  {
    Parameters p;
    p.bodies              = {box("block", "22,1,4", {-0.9, 0, -1}, {1.3, 0.4, 0}, 1000, 0.3), BodyParameters()};
    p.bodies[1].name      = "roller";
    p.bodies[1].generator = "cylinder";
    p.bodies[1].generator_arguments         = "1 : 0.5";
    p.bodies[1].rotation_axis               = Vector3({0., 0., 1.});
    p.bodies[1].rotation_angle              = 90.;
    p.bodies[1].translation                 = Vector3({0., 0.2, 1.});
    p.bodies[1].global_refinement           = 2;
    p.bodies[1].rigid                       = true;
    p.bodies[1].rigid_free                  = {2, 4};
    p.bodies[1].rigid_force                 = {"0", "0", "-20*min(t,1)"};
    p.bodies[1].motion.translation          = {"0.3*max(0,t-1)", "0", "0"};
    p.bodies[1].motion.rotation_centre      = {0., 0.2, 1.};
    p.boundary_conditions                   = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                               hold("y", region(1, {y_minus, y_plus}), {1})};
    p.contact_pairs                         = {ContactPairParameters()};
    p.contact_pairs[0].slave                = region(1, {z_plus});
    p.contact_pairs[0].master               = region(2, {0});
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
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const Solver solver : {Solver::direct, Solver::condensed, Solver::block})
    for (const bool loops : {false, true})
      check_pressed(1, solver, loops);
  check_pressed(2, Solver::direct, false);
  check_gap(false);
  check_gap(true);
  check_unresisted();
  check_eccentric(false);
  check_eccentric(true);
  check_finite_rotation(1, Solver::direct, false);
  for (const Solver solver : {Solver::direct, Solver::condensed, Solver::block})
    check_finite_rotation(1, solver, true);
  check_finite_rotation(2, Solver::direct, true);
  check_roller();
}
