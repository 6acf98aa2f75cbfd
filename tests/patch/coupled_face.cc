// Faces that move as rigid bodies do and are driven by force and moment. A square bar without Poisson's ratio, clamped
// at one end, is a bar and Euler-Bernoulli's beam without shear: it elongates by F L/(E A), its end turns by M L/(E I)
// and moves aside by half of that times L, quadratic elements having exactly these displacements, with hanging nodes,
// too. A bar whose ends may warp turns by T L/(G J) with J = 0.140577 a^4 (Timoshenko & Goodier, Theory of Elasticity,
// section 109). A strip of unit width that a moment bends by theta at large rotations is an arc of the length L. A
// contact has the force and the moment of a face that presses it.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <functional>
#include <utility>

using namespace Cases;

namespace
{
  constexpr double E = 200., L = 4.;

  BoundaryConditionParameters couple(const RegionParameters          &where,
                                     const std::vector<unsigned int> &components,
                                     const std::vector<unsigned int> &free,
                                     const std::vector<std::string>  &force,
                                     const std::vector<std::string>  &moment)
  {
    auto c                   = condition("tip", BoundaryConditionParameters::Type::rigid_motion, where, components, {});
    c.free                   = free;
    c.force                  = force;
    c.moment                 = moment;
    c.motion.rotation_centre = {0, 0, L};
    return c;
  }

  Parameters bar(const std::string &name, const std::string &cells, const double nu)
  {
    Parameters p;
    p.degree                = 2;
    p.bodies                = {box("bar", cells, {-0.5, -0.5, 0}, {0.5, 0.5, L}, E, nu)};
    p.load_stepping         = {{1.}, {1}};
    p.output.results_folder = "coupled_face_" + name;
    p.output.write_vtu      = false;
    return p;
  }

  Vector3 numbers(const std::vector<std::string> &text)
  {
    return Vector3({std::stod(text[0]), std::stod(text[1]), std::stod(text[2])});
  }

  void compare(const std::string &what, const Vector3 &value, const Vector3 &reference, const double scale)
  {
    if (reference.norm() > 0.)
      check(what, value, reference, 1e-4);
    else
      check(what, value.norm() / scale, 0., 1e-4, 1.);
  }

  const std::vector<std::string> none = {"0", "0", "0"};

  /// Clamped at the bottom, all six components free at the top.
  void clamped(const std::string              &name,
               const std::string              &refine_where,
               const std::vector<std::string> &force,
               const std::vector<std::string> &moment,
               const Vector3                  &translation,
               const Vector3                  &rotation)
  {
    Parameters p = bar(name, "2,2,3", 0.);
    if (!refine_where.empty())
    {
      p.bodies[0].local_refinement = 1;
      p.bodies[0].refine_where     = refine_where;
    }
    p.boundary_conditions = {hold("clamped", region(1, {z_minus}), {0, 1, 2}),
                             couple(region(1, {z_plus}), {0, 1, 2}, {0, 1, 2, 3, 4, 5}, force, moment)};
    ContactProblem problem(p, world(), log());
    problem.run();
    const RigidBodyMotion &tip  = problem.rigid_bodies().front();
    const double           size = translation.norm();
    compare(name + ": translation", tip.translation, translation, size);
    compare("  rotation", tip.rotation, rotation, size);
    compare("  corner",
            problem.displacement(1, {0.5, 0.5, L}),
            translation + dealii::cross_product_3d(rotation, Vector3({0.5, 0.5, 0.})),
            size);
    const double load = numbers(force).norm() + numbers(moment).norm();
    compare("  force", tip.force, numbers(force), load);
    compare("  moment", tip.moment, numbers(moment), load);
  }

  /// Pressed on another one and tilted, with friction.
  void pressed_block()
  {
    Parameters p = bar("pressed", "1,1,1", 0.);
    p.bodies     = {box("upper", "2,2,2", {0, 0, 1}, {1, 1, 2}, 1000., 0.3),
                    box("lower", "3,3,2", {-0.1, -0.1, 0}, {1.1, 1.1, 1}, 1000., 0.3)};
    for (BodyParameters &body : p.bodies)
      body.material.law = MaterialParameters::Law::neo_hookean;
    p.degree              = 1;
    p.load_stepping       = {{1.}, {2}};
    p.boundary_conditions = {
        hold("ground", region(2, {z_minus}), {0, 1, 2}),
        couple(region(1, {z_plus}), {0, 1, 2}, {2, 3, 4}, {"0", "0", "-100*t"}, {"6*t", "0", "0"})};
    p.boundary_conditions[1].motion.rotation_centre = {0.5, 0.5, 2};
    p.boundary_conditions[1].motion.translation     = {"0.01*t", "0", "0"};
    p.contact_pairs                                 = {pair(region(1, {z_minus}), region(2, {z_plus}), 0.2)};
    p.contact_pairs[0].scheme                       = ContactPairParameters::Scheme::averaged;
    p.contact_pairs[0].normal                       = ContactPairParameters::Normal::averaged;
    ContactProblem problem(p, world(), log());
    problem.run();
    const RigidBodyMotion   &top     = problem.rigid_bodies().front();
    const ContactResultants &contact = problem.contact_resultants().front();
    const Vector3            centre  = Vector3({0.5, 0.5, 2}) + top.translation;
    check("pressed block: force", -top.force[2], 100., 1e-6);
    check("  moment", top.moment[0], 6., 1e-6);
    check("  the contact balances: force", (contact.slave_force + top.force).norm() / top.force.norm(), 0., 1e-6, 1.);
    check("  moment",
          (contact.slave_moment + top.moment + dealii::cross_product_3d(centre, top.force)).norm() / top.force.norm(),
          0.,
          1e-6,
          1.);
  }

  struct Strip
  {
    RigidBodyMotion tip;
    double          moment;
  };
  /// Bent to a quarter of a circle in six increments; "from a checkpoint" from the last one of the run before.
  Strip strip(const std::string &name, const std::function<void(Parameters &)> &change)
  {
    const double       theta = dealii::numbers::PI / 2., thickness = 0.2;
    const double       moment = E * std::pow(thickness, 3) / 12. * theta / L;
    std::ostringstream expression;
    expression << std::setprecision(17) << moment << "*t";
    Parameters p             = bar(name, "1,1,12", 0.);
    p.bodies                 = {box("strip", "1,1,12", {-thickness / 2., -0.5, 0}, {thickness / 2., 0.5, L}, E, 0.)};
    p.bodies[0].material.law = MaterialParameters::Law::st_venant_kirchhoff;
    p.load_stepping          = {{1.}, {6}};
    p.newton.force_tolerance = 1e-11;
    p.linear_solver.type     = LinearSolverParameters::Type::direct;
    p.output.checkpoint_interval = 4;
    p.boundary_conditions        = {
               hold("clamped", region(1, {z_minus}), {0, 1, 2}),
               couple(region(1, {z_plus}), {0, 1, 2}, {0, 1, 2, 3, 4, 5}, none, {"0", expression.str(), "0"})};
    change(p);
    ContactProblem problem(p, world(), log());
    if (name == "from a checkpoint")
      problem.restart();
    problem.run();
    MPI_Barrier(world());
    if (name == "strip")
    {
      check("strip: rotation", problem.rigid_bodies().front().rotation, Vector3({0, theta, 0}), 1e-2);
      check("  translation", problem.rigid_bodies().front().translation, Vector3({L / theta, 0, L / theta - L}), 1e-2);
    }
    return {problem.rigid_bodies().front(), moment};
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const double                             I = 1. / 12., M = 1e-4, F = 1e-3;

  clamped("axial", "", {"0", "0", "1e-3"}, none, Vector3({0, 0, F * L / E}), Vector3());
  clamped("bending",
          "",
          none,
          {"0", "1e-4", "0"},
          Vector3({0.5 * M * L * L / (E * I), 0, 0}),
          Vector3({0, M * L / (E * I), 0}));
  clamped("hanging",
          "x+y>0.1 && z>2.8",
          none,
          {"0", "1e-4", "0"},
          Vector3({0.5 * M * L * L / (E * I), 0, 0}),
          Vector3({0, M * L / (E * I), 0}));
  {
    const double nu = 0.25, G = E / (2. * (1. + nu)), T = 1e-2;
    Parameters   p        = bar("torsion", "4,4,4", nu);
    p.boundary_conditions = {hold("end", region(1, {z_minus}), {0, 1}),
                             hold("corner", region(1, {z_minus}, "abs(x)+abs(y) < 1e-6"), {2}),
                             couple(region(1, {z_plus}), {0, 1}, {5}, none, {"0", "0", "1e-2"})};
    ContactProblem problem(p, world(), log());
    problem.run();
    check("torsion: rotation", problem.rigid_bodies().front().rotation[2], T * L / (G * 0.140577), 5e-3);
  }
  {
    Parameters p          = bar("corner", "2,2,4", 0.3);
    p.degree              = 1;
    p.boundary_conditions = {
        hold("clamped", region(1, {z_minus}), {0, 1, 2}),
        couple(region(1, {z_plus}, "x>0.4 && y>0.4"), {0, 1, 2}, {0, 1, 2}, {"1e-4", "2e-4", "-3e-4"}, none)};
    ContactProblem problem(p, world(), log());
    problem.run();
    const RigidBodyMotion &node = problem.rigid_bodies().front();
    check("force at a node: reaction", problem.reactions()[0].second, Vector3({-1e-4, -2e-4, 3e-4}), 1e-6);
    check("  displacement", problem.displacement(1, {0.5, 0.5, L}), node.translation, 1e-6);
  }
  pressed_block();
  const Strip direct = strip("strip", [](Parameters &) {});
  check("  stored energy",
        last_energy("coupled_face_strip", "stored") / direct.moment,
        0.5 * direct.tip.rotation[1],
        1e-3);
  check("  external work",
        last_energy("coupled_face_strip", "external") / direct.moment,
        0.5 * direct.tip.rotation[1],
        1e-2);
  for (const auto &[name, change] :
       std::vector<std::pair<std::string, std::function<void(Parameters &)>>>{
           {"block solver", [](Parameters &p) { p.linear_solver.type = LinearSolverParameters::Type::block; }},
           {"condensed solver", [](Parameters &p) { p.linear_solver.type = LinearSolverParameters::Type::condensed; }},
           {"arc length",
            [](Parameters &p) { p.load_stepping.control = {LoadSteppingParameters::Control::arc_length}; }},
           {"from a checkpoint", [](Parameters &p) { p.output.results_folder = "coupled_face_strip"; }}})
  {
    const RigidBodyMotion tip = strip(name, change).tip;
    check(name + ": the same rotation", (tip.rotation - direct.tip.rotation).norm(), 0., 1e-7, 1.);
    check("  translation", (tip.translation - direct.tip.translation).norm(), 0., 1e-7, 1.);
  }
  const RigidBodyMotion refined = strip("refined while it bends",
                                        [](Parameters &p)
                                        {
                                          p.adaptivity.interval        = 2;
                                          p.adaptivity.maximum_level   = 1;
                                          p.adaptivity.refine_fraction = 0.4;
                                        })
                                      .tip;
  check("refined while it bends: rotation", refined.rotation, Vector3({0, dealii::numbers::PI / 2., 0}), 1e-2);
  check("  moment", refined.moment[1], direct.moment, 1e-6);
}
