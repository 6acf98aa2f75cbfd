// Blocks and shells on rigid masters in closed form, against analytic values:
// - pressed by a moving plane: uniaxial stress and the resultants on both sides;
// - dragged by a plane that slides: mu times the normal force, and work = stored + dissipated;
// - on a plane that turns under them: the moment of friction; tied to it: the rigid motion of the plane, without force;
// - shells pressed on by cylinders and spheres inside and outside: the pressures of Lame.

#include <nodus/base/signals.h>

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <csignal>
#include <fstream>

using namespace Cases;

namespace
{
  using Type   = BoundaryConditionParameters::Type;
  using Scheme = ContactPairParameters::Scheme;
  using Shape  = MasterSurfaceParameters::Shape;

  const std::vector<std::pair<std::string, Scheme>> schemes = {
      {"nodal", Scheme::nodal}, {"averaged", Scheme::averaged}, {"integration point", Scheme::integration_point}};

  ContactPairParameters
  on_rigid(const Shape shape, const RegionParameters &slave, const Scheme scheme, const double friction = 0.)
  {
    ContactPairParameters p;
    p.name                 = "pair";
    p.slave                = slave;
    p.scheme               = scheme;
    p.friction_coefficient = friction;
    p.master_surface.shape = shape;
    return p;
  }

  Parameters case_of(const std::string &name)
  {
    Parameters p;
    p.output.results_folder = "rigid_master_results/" + name;
    p.output.write_vtu      = false;
    return p;
  }

  /// A cube, E = 1000, nu = 0.3, that slides on its lower sides, compressed by 1 % by a plane from above.
  void check_pressed(const std::string &name, const Scheme scheme, const bool loops, const bool iterative)
  {
    Parameters p             = case_of("pressed");
    p.bodies                 = {box("cube", "3,3,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.3)};
    p.boundary_conditions    = {hold("x", region(1, {x_minus}), {0}),
                                hold("y", region(1, {y_minus}), {1}),
                                hold("z", region(1, {z_minus}), {2})};
    p.contact_pairs          = {on_rigid(Shape::plane, region(1, {z_plus}), scheme)};
    auto &plane              = p.contact_pairs[0].master_surface;
    plane.point              = Point(7., 8., 1.);
    plane.axis               = Vector3({0., 0., -2.});
    plane.motion.translation = {"t", "0", "-0.01*t"};
    p.load_stepping          = {{1.}, {2}};
    if (loops)
      use_loops(p);
    if (iterative)
      p.linear_solver.type = scheme == Scheme::integration_point ? LinearSolverParameters::Type::block
                                                                 : LinearSolverParameters::Type::condensed;
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto  &r     = problem.contact_resultants()[0];
    const double force = 10., arm = 0.5 * 1.003;
    check("pressed, " + name + (loops ? ", loops" : "") + (iterative ? ", iterative" : "") + ": force",
          r.slave_force[2],
          -force,
          1e-8);
    check("  force on the plane", r.master_force[2], force, 1e-8);
    check("  its moments", r.master_moment, Vector3({arm * force, -arm * force, 0.}), 1e-8);
    check("  side", problem.displacement(1, Point(1, 1, 1))[0], 0.003, 1e-8);
    const auto &pressure         = problem.contact_fields()[0].pressure;
    const auto [lowest, highest] = std::minmax_element(pressure.begin(), pressure.end());
    check("  uniform pressure, lowest", *lowest, force / (1.003 * 1.003), 1e-7);
    check("  highest", *highest, force / (1.003 * 1.003), 1e-7);
    check("  all nodes are closed", r.open == 0 && r.unpaired == 0);
  }

  /// Columns of the last rows of energy.csv: external work, stored, dissipated, imbalance.
  std::vector<std::array<double, 4>> energies(const Parameters &p)
  {
    MPI_Barrier(world());
    const char *const wanted[] = {"external work", "stored energy", "frictional dissipation", "imbalance"};
    std::ifstream     file(p.output.results_folder + "/energy.csv");
    std::vector<std::array<double, 4>> rows;
    std::vector<std::string>           titles;
    for (std::string line; std::getline(file, line);)
    {
      std::array<double, 4> row{};
      std::istringstream    stream(line);
      unsigned int          column = 0;
      for (std::string cell; std::getline(stream, cell, ','); ++column)
        if (rows.empty() && titles.size() == column)
          titles.push_back(cell.substr(0, cell.find(" [")));
        else
          for (unsigned int i = 0; i < 4; ++i)
            if (titles[column] == wanted[i])
              row[i] = std::stod(cell);
      rows.push_back(row);
    }
    return rows;
  }

  /// A stiff cube held on top and pressed down by 1 % on a plane that slides by 0.4 from t = 1 to 2.
  void check_dragged(const std::string &name, const Scheme scheme, const bool loops)
  {
    Parameters p          = case_of("dragged");
    p.bodies              = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.)};
    p.boundary_conditions = {
        condition("top", Type::displacement, region(1, {z_plus}), {0, 1, 2}, {"0", "0", "-0.01*min(t,1)"})};
    p.contact_pairs          = {on_rigid(Shape::plane, region(1, {z_minus}), scheme, 0.2)};
    auto &plane              = p.contact_pairs[0].master_surface;
    plane.axis               = Vector3({0., 0., 1.});
    plane.motion.translation = {"0.4*max(0,t-1)", "0.3*max(0,t-1)", "0"};
    p.load_stepping          = {{1., 2.}, {1, 4}};
    if (loops)
      use_loops(p);
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto &r = problem.contact_resultants()[0];
    check("dragged, " + name + (loops ? ", loops" : "") + ": friction x",
          r.slave_force[0] / r.slave_force[2],
          0.16,
          1e-8);
    check("  y", r.slave_force[1] / r.slave_force[2], 0.12, 1e-8);
    check("  on the plane", r.master_force[0] / r.slave_force[2], -0.16, 1e-8);
    check("  all nodes slip", r.open == 0 && r.stick == 0);
    const auto   rows = energies(p);
    const auto  &a = rows[rows.size() - 2], &b = rows.back();
    const double work = 0.2 * r.slave_force[2] * 0.125;
    check("  work of the plane in the last increment", b[0] - a[0], work, 1e-5);
    check("  dissipated", b[2] - a[2], work, 1e-5);
    check("  balance", b[3] - a[3], 0., 1e-5, work);
  }
  /// A stiff unit square pressed on a plane that turns below its centre: moment mu p int r dA.
  void check_turned(const std::string &name, const Scheme scheme)
  {
    Parameters p          = case_of("turned");
    p.bodies              = {box("square", "8,8,1", {-0.5, -0.5, 0}, {0.5, 0.5, 0.5}, 1e6, 0.)};
    p.boundary_conditions = {
        condition("top", Type::displacement, region(1, {z_plus}), {0, 1, 2}, {"0", "0", "-1e-6*min(t,1)"})};
    p.contact_pairs       = {on_rigid(Shape::plane, region(1, {z_minus}), scheme, 0.2)};
    auto &plane           = p.contact_pairs[0].master_surface;
    plane.axis            = Vector3({0., 0., 1.});
    plane.motion.rotation = "45*max(0,t-1)";
    p.load_stepping       = {{1., 2.}, {1, 3}};
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto &r = problem.contact_resultants()[0];
    check("turned, " + name + ": moment over mu times force",
          r.slave_moment[2] / (0.2 * r.slave_force[2]),
          (std::sqrt(2.) + std::log(1. + std::sqrt(2.))) / 6.,
          2e-2);
    check("  moment on the plane", r.master_moment[2], -r.slave_moment[2], 1e-8);
  }

  /// A cube tied to a plane that turns by 60 degrees about an oblique axis and moves: the motion of the plane.
  void check_tied(const std::string &name, const Scheme scheme, const bool loops)
  {
    Parameters p                   = case_of("tied");
    p.bodies                       = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.3)};
    p.bodies[0].material.law       = MaterialParameters::Law::neo_hookean;
    p.contact_pairs                = {on_rigid(Shape::plane, region(1, {z_minus}), scheme)};
    p.contact_pairs[0].contact_law = ContactPairParameters::ContactLaw::tied;
    auto &plane                    = p.contact_pairs[0].master_surface;
    plane.axis                     = Vector3({0., 0., 1.});
    plane.motion.rotation          = "60*t";
    plane.motion.rotation_axis     = Vector3({1., 2., 3.});
    plane.motion.rotation_centre   = {2., 1., 0.};
    plane.motion.translation       = {"t", "-2*t", "t^2"};
    p.load_stepping                = {{1.}, {6}};
    if (loops)
    {
      use_loops(p);
      p.geometry_loop.tolerance = 1e-8;
    }
    ContactProblem problem(p, world(), log());
    problem.run();
    const Point   X(1, 1, 1), c(2, 1, 0);
    const Vector3 e = plane.motion.rotation_axis / std::sqrt(14.), d = X - c;
    const Vector3 x = c + std::cos(dealii::numbers::PI / 3.) * d + 0.5 * (e * d) * e +
                      std::sin(dealii::numbers::PI / 3.) * dealii::cross_product_3d(e, d) + Vector3({1., -2., 1.});
    const Vector3 u = problem.displacement(1, X);
    check("tied, " + name + (loops ? ", loops" : "") + ": displacement", u, x - X, 1e-6);
    check("  no force", problem.contact_resultants()[0].slave_force.norm() < 1e-3);
  }

  /// A thick shell, radii 1 and 2, plane strain or spherical, nu = 0.3, over whose inner (outer) face a rigid body
  /// projects by 0.02: Lame's pressure.
  void check_shell(const Shape shape, const bool cavity, const Scheme scheme)
  {
    const bool   sphere = shape == Shape::sphere;
    const double E = 1000., nu = 0.3, a = 1., b = 2., delta = 2e-2;
    Parameters   p = case_of("shell");
    p.degree       = 2;
    p.bodies.resize(1);
    p.bodies[0].name                    = "shell";
    p.bodies[0].generator               = sphere ? "hyper_shell" : "cylinder_shell";
    p.bodies[0].generator_arguments     = sphere ? "0,0,0 : 1 : 2 : 6 : false" : "0.2 : 1 : 2 : 24 : 1";
    p.bodies[0].global_refinement       = sphere ? 2 : 0;
    p.bodies[0].material.law            = MaterialParameters::Law::linear_elastic;
    p.bodies[0].material.youngs_modulus = E;
    p.bodies[0].material.poissons_ratio = nu;
    p.boundary_conditions               = {hold("x", region(1, {0}, "abs(x)<1e-9"), {0}),
                                           hold("y", region(1, {0}, "abs(y)<1e-9"), {1}),
                                           hold("z", region(1, {0}, sphere ? "abs(z)<1e-9" : "z<1e-9 || z>0.2-1e-9"), {2})};
    const std::string r2                = sphere ? "x^2+y^2+z^2" : "x^2+y^2";
    // the centres of the ends of the cylinder are in between
    p.contact_pairs                    = {on_rigid(shape, region(1, {0}, r2 + (cavity ? ">3.6" : "<1.2")), scheme)};
    p.contact_pairs[0].surface_measure = ContactPairParameters::SurfaceMeasure::reference;
    auto &master                       = p.contact_pairs[0].master_surface;
    master.radius                      = cavity ? b - delta : a + delta;
    master.cavity                      = cavity;
    if (!sphere)
      master.axis = Vector3({0., 0., 1.});
    ContactProblem problem(p, world(), log());
    problem.run();
    // u = A r + B/r^m; radial stress p (A/(1 - 2 nu) - n B/r^(m+1)) with p = E/(1 + nu) or E
    const double m = sphere ? 2. : 1., n = sphere ? 2. / (1. + nu) : 1., factor = sphere ? E : E / (1. + nu);
    const double contact = cavity ? b : a, free = cavity ? a : b;
    const double A_of_B   = n * (1. - 2. * nu) / std::pow(free, m + 1.);
    const double B        = (cavity ? -delta : delta) / (A_of_B * contact + std::pow(contact, -m));
    const double pressure = -factor * (A_of_B / (1. - 2. * nu) - n / std::pow(contact, m + 1.)) * B;
    const auto  &fields   = problem.contact_fields()[0];
    double       force = 0., area = 0.;
    for (unsigned int k = 0; k < fields.pressure.size(); ++k)
    {
      force += fields.pressure[k] * fields.area[k];
      area += fields.area[k];
    }
    check(text_of(shape) + (cavity ? ", cavity" : "") + ", " + text_of(scheme) + ": mean pressure",
          force / area,
          pressure,
          1e-2);
  }
  /// A cube on a plane that slides and turns: the run that is stopped after increment 3 and continued is the other one.
  void check_restart(const Scheme scheme)
  {
    Parameters p          = case_of("restart");
    p.bodies              = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.3)};
    p.boundary_conditions = {
        condition("top", Type::displacement, region(1, {z_plus}), {0, 1, 2}, {"0", "0", "-0.01*min(t,1)"})};
    p.contact_pairs          = {on_rigid(Shape::plane, region(1, {z_minus}), scheme, 0.2)};
    auto &plane              = p.contact_pairs[0].master_surface;
    plane.axis               = Vector3({0., 0., 1.});
    plane.motion.translation = {"0.003*t", "0", "0.001*t"};
    plane.motion.rotation    = "t";
    p.load_stepping          = {{1., 2.}, {1, 4}};
    std::vector<Vector3> force, moment;
    for (const bool stops : {false, true})
    {
      if (stops)
      {
        ContactProblem first(p, world(), log());
        first.on_increment(
            [](const unsigned int increment, const double)
            {
              if (increment == 3)
                std::raise(SIGTERM);
            });
        try
        {
          first.run();
          check("stopped", false);
        }
        catch (const Interrupted &)
        {
        }
      }
      ContactProblem problem(p, world(), log());
      if (stops)
        problem.restart();
      problem.run();
      force.push_back(problem.contact_resultants()[0].master_force);
      moment.push_back(problem.contact_resultants()[0].master_moment);
    }
    check("restart, " + text_of(scheme) + ": force", force[1], force[0], 1e-8);
    check("  moment", moment[1], moment[0], 1e-8);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Signals::install();
  for (const auto &[name, scheme] : schemes)
  {
    for (const bool loops : {false, true})
    {
      check_pressed(name, scheme, loops, false);
      check_dragged(name, scheme, loops);
      check_tied(name, scheme, loops);
    }
    check_turned(name, scheme);
    check_restart(scheme);
    for (const bool cavity : {false, true})
    {
      check_shell(Shape::cylinder, cavity, scheme);
      if (scheme == Scheme::averaged)
        check_shell(Shape::sphere, cavity, scheme);
    }
    check_pressed(name, scheme, false, true);
  }
}
