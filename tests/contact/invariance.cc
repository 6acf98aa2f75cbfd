// Units and axes are the user's. A steel block is pressed on another with friction and dragged, slipping in part:
// - in mm and MPa, and in m and Pa, every increment takes the same number of Newton iterations and gives the same
//   forces in N;
// - turned by 33 degrees about an oblique axis, with its displacements or its loads, the forces turn with it.
// A block that leans forwards slides sideways on a rigid plane, on a part of its face: friction is mu times the
// pressure, in units of a modulus of 1 and of 1e9.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;

  constexpr double angle = 33.;
  const Vector3    axis({1, 2, 0.5});

  Vector3 turned(const Vector3 &x)
  {
    const Vector3 e = axis / axis.norm();
    const double  a = angle * dealii::numbers::PI / 180;
    return std::cos(a) * x + std::sin(a) * dealii::cross_product_3d(e, x) + (1 - std::cos(a)) * (e * x) * e;
  }

  /// Components of a(t) x + b(t) z as expressions; the directions are turned when @p rotated.
  std::vector<std::string> along(const std::string &a, const std::string &b, const double factor, const bool rotated)
  {
    const Vector3 x = rotated ? turned(Vector3({1, 0, 0})) : Vector3({1, 0, 0}),
                  z = rotated ? turned(Vector3({0, 0, 1})) : Vector3({0, 0, 1});
    std::vector<std::string> values;
    for (unsigned int c = 0; c < 3; ++c)
    {
      std::ostringstream value;
      value << std::setprecision(17) << factor * x[c] << "*(" << a << ")+(" << factor * z[c] << ")*(" << b << ")";
      values.push_back(value.str());
    }
    return values;
  }

  struct Case
  {
    Scheme                       scheme;
    bool                         loads  = false; ///< pressure, traction and springs on the top instead of displacements
    double                       length = 1., pressure = 1.; ///< units, in mm and MPa
    bool                         rotated = false;
    LinearSolverParameters::Type solver  = LinearSolverParameters::Type::direct;
  };

  Parameters blocks(const Case &c)
  {
    using Type       = BoundaryConditionParameters::Type;
    const double s   = 1. / c.length;
    const double E   = 210000. / c.pressure;
    const auto   top = region(2, {z_plus});
    Parameters   p;
    p.bodies = {box("lower", "5,4,2", {0, 0, 0}, {5 * s, 4 * s, 2 * s}, E, 0.3),
                box("upper", "3,3,2", {0.7 * s, 0.6 * s, 2 * s}, {3.7 * s, 3.4 * s, 4 * s}, E, 0.3)};
    for (auto &body : p.bodies)
    {
      body.material.law = MaterialParameters::Law::neo_hookean;
      if (c.rotated)
      {
        body.rotation_axis  = axis;
        body.rotation_angle = angle;
      }
    }
    p.boundary_conditions = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    if (c.loads)
    {
      std::ostringstream pressure, spring;
      pressure << std::setprecision(17) << 900. / c.pressure << "*t";
      spring << std::setprecision(17) << 300. * c.length / c.pressure;
      p.boundary_conditions.push_back(press("press", top, pressure.str()));
      p.boundary_conditions.push_back(
          condition("drag", Type::traction, top, {0, 1, 2}, along("120*t", "0", 1. / c.pressure, c.rotated)));
      p.boundary_conditions.push_back(
          condition("spring", Type::spring, top, {0, 1, 2}, std::vector<std::string>(3, spring.str())));
    }
    else
      p.boundary_conditions.push_back(condition(
          "top", Type::displacement, top, {0, 1, 2}, along("0.03*max(t-1,0)", "-0.02*min(t,1)", s, c.rotated)));

    ContactPairParameters contact;
    contact.name                  = "pair";
    contact.slave                 = region(2, {z_minus});
    contact.master                = region(1, {z_plus});
    contact.scheme                = c.scheme;
    contact.friction_coefficient  = 0.25;
    p.contact_pairs               = {contact};
    p.load_stepping.interval_ends = {1., 2.};
    p.load_stepping.increments    = {2, 2};
    p.linear_solver.type          = c.solver;
    if (c.loads && c.scheme == Scheme::integration_point)
      use_loops(p); // a merged iteration is given up here, and one that diverges magnifies round-off
    p.output.results_folder = "invariance_results";
    p.output.write_vtu      = false;
    return p;
  }

  struct Outcome
  {
    std::vector<unsigned int> iterations;
    std::vector<Vector3>      force; ///< on the slave [N]
    unsigned int              slip = 0, stick = 0;
  };

  Outcome run(const Case &c)
  {
    const double   newton = c.length * c.length * c.pressure; // the unit of force in N
    Outcome        outcome;
    ContactProblem problem(blocks(c), world(), log());
    problem.on_increment(
        [&](const unsigned int, const double)
        {
          const auto &contact = problem.contact_resultants()[0];
          outcome.iterations.push_back(problem.iterations().newton);
          outcome.force.push_back(newton * contact.slave_force);
          outcome.slip += contact.slip;
          outcome.stick += contact.stick;
        });
    problem.run();
    return outcome;
  }

  /// Largest difference of the forces against the largest force.
  void check_forces(const std::string &what, const Outcome &a, const Outcome &b, const bool turn)
  {
    double largest = 0., scale = 0.;
    for (unsigned int i = 0; i < a.force.size(); ++i)
    {
      largest = std::max(largest, ((turn ? turned(a.force[i]) : a.force[i]) - b.force[i]).norm());
      scale   = std::max(scale, a.force[i].norm());
    }
    check(what + ": difference of the forces", largest, 0., 1e-8, scale);
  }

  /// Friction over mu times the pressure, where sites that are open share multipliers with those that slide.
  void check_sliding(const std::string &name, const Scheme scheme, const double E)
  {
    Parameters p;
    p.bodies                                = {box("block", "2,2,1", {0, 0, 0}, {2, 1, 1}, E, 0.3)};
    p.bodies[0].rotation_axis               = Vector3({0, 1, 0});
    p.bodies[0].rotation_angle              = 1.;
    p.boundary_conditions                   = {condition("top",
                                       BoundaryConditionParameters::Type::displacement,
                                       region(1, {z_plus}),
                                       {0, 1, 2},
                                       {"0", "0.4*max(t-1,0)", "-0.02*min(t,1)"})};
    p.contact_pairs                         = {ContactPairParameters()};
    p.contact_pairs[0].slave                = region(1, {z_minus});
    p.contact_pairs[0].master_surface.shape = MasterSurfaceParameters::Shape::plane;
    p.contact_pairs[0].master_surface.point = Point(0., 0., -2. * std::sin(dealii::numbers::PI / 180));
    p.contact_pairs[0].master_surface.axis  = Vector3({0, 0, 1});
    p.contact_pairs[0].scheme               = scheme;
    p.contact_pairs[0].friction_coefficient = 0.8;
    p.load_stepping.interval_ends           = {1., 2.};
    p.load_stepping.increments              = {2, 4};
    p.output.results_folder                 = "invariance_results";
    p.output.write_vtu                      = false;
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto        &contact = problem.contact_resultants()[0];
    std::ostringstream label;
    label << name << ", E = " << E;
    check(label.str() + ": open and slipping, none that sticks",
          contact.open > 0 && contact.slip > 0 && contact.stick == 0);
    check("  friction over mu times the pressure", -contact.slave_force[1] / (0.8 * contact.slave_force[2]), 1., 1e-4);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const std::pair<Scheme, const char *> schemes[] = {
      {Scheme::averaged, "averaged"}, {Scheme::nodal, "nodal"}, {Scheme::integration_point, "integration point"}};
  for (const auto &[scheme, name] : schemes)
    for (const bool loads : {false, true})
    {
      const std::string label = std::string(name) + (loads ? ", loads" : ", displacements");
      Case              c;
      c.scheme         = scheme;
      c.loads          = loads;
      const Outcome mm = run(c);
      check(label + ": some nodes slip and some stick", mm.slip > 0 && mm.stick > 0);
      Case si         = c;
      si.length       = 1e3;
      si.pressure     = 1e-6;
      const Outcome m = run(si);
      check(label + ", mm and m: Newton iterations agree", mm.iterations == m.iterations);
      check_forces(label + ", mm and m", mm, m, false);
      Case oblique    = c;
      oblique.rotated = true;
      check_forces(label + ", rotated", mm, run(oblique), true);
    }

  // iterative solution has thresholds of its own
  Case c;
  c.scheme         = Scheme::averaged;
  c.solver         = LinearSolverParameters::Type::condensed;
  const Outcome mm = run(c);
  c.length         = 1e3;
  c.pressure       = 1e-6;
  const Outcome m  = run(c);
  check("condensed solver, mm and m: Newton iterations agree", mm.iterations == m.iterations);
  check_forces("condensed solver, mm and m", mm, m, false);

  for (const auto &[scheme, name] : schemes)
    for (const double E : {1., 1e9})
      check_sliding(name, scheme, E);
}
