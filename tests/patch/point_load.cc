// Loads and springs at points that are no nodes, and along axes that are not x, y, z. Statics gives what they do to a
// body whatever its mesh: six springs that hold it in a determinate way elongate by their force over their stiffness, a
// clamped face takes force and moment. A bar of one cell across has uniform stress under a force in the middle of its
// end (degree 1), and under nine forces that stand as 1:4:1 x 1:4:1 (degree 2). Linear laws take in half of the force
// times the way of its point.

#include "../cases.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/physics/transformations.h>

#include <functional>
#include <map>

using namespace Cases;

namespace
{
  using Type = BoundaryConditionParameters::Type;

  BoundaryConditionParameters at_point(const std::string               &name,
                                       const Type                       type,
                                       const Point                     &X,
                                       const std::vector<unsigned int> &components,
                                       const std::vector<std::string>  &value)
  {
    auto c  = condition(name, type, {}, components, value);
    c.point = {X[0], X[1], X[2]};
    return c;
  }

  /// Runs, from a checkpoint if asked, and says whether the log has a warning.
  bool warns(ContactProblem &problem, std::ostringstream &own_log, const bool restarts = false)
  {
    if (restarts)
      problem.restart();
    problem.run();
    MPI_Barrier(world());
    if (std::getenv("NODUS_TEST_LOG") != nullptr && root())
      std::cout << own_log.str();
    return own_log.str().find("warning") != std::string::npos;
  }

  /// The last displacement of each point in points.csv.
  std::map<std::string, Vector3> displacements(const std::string &folder)
  {
    std::ifstream                  file(folder + "/points.csv");
    std::map<std::string, Vector3> last;
    std::string                    line, cell;
    std::getline(file, line);
    while (std::getline(file, line))
    {
      std::istringstream       cells(line);
      std::vector<std::string> row;
      while (std::getline(cells, cell, ','))
        row.push_back(cell);
      last[row[2].substr(1, row[2].size() - 2)] = Vector3({std::stod(row[3]), std::stod(row[4]), std::stod(row[5])});
    }
    return last;
  }

  struct Spring
  {
    Point        X;
    unsigned int component;
  };
  const std::vector<Spring> springs = {{{0.2, 0.3, 0.}, 2},
                                       {{0.9, 0.15, 0.}, 2},
                                       {{0.35, 0.8, 0.1}, 2},
                                       {{0.5, 0.5, 0.5}, 1},
                                       {{0.7, 0., 0.45}, 1},
                                       {{0., 0.4, 0.55}, 0}};
  const Vector3             force   = Vector3({1., -2., 3.});
  const Point               loaded(0.63, 0.71, 1.);
  constexpr double          stiffness = 500.;

  /// Displacements that statics gives to the springs under @p force at #loaded.
  std::vector<double> elongations()
  {
    dealii::FullMatrix<double> matrix(6, 6);
    dealii::Vector<double>     rhs(6), tension(6);
    const Vector3              moment = dealii::cross_product_3d(Vector3(loaded), force);
    for (unsigned int s = 0; s < 6; ++s)
    {
      Vector3 e;
      e[springs[s].component] = 1.;
      const Vector3 turns     = dealii::cross_product_3d(Vector3(springs[s].X), e);
      for (unsigned int c = 0; c < dim; ++c)
      {
        matrix(c, s)       = e[c];
        matrix(dim + c, s) = turns[c];
        rhs(c)             = force[c];
        rhs(dim + c)       = moment[c];
      }
    }
    matrix.gauss_jordan();
    matrix.vmult(tension, rhs);
    std::vector<double> u;
    for (const double t : tension)
      u.push_back(t / stiffness);
    return u;
  }

  Parameters cube(const std::string &name, const unsigned int degree)
  {
    Parameters p;
    p.degree                 = degree;
    p.bodies                 = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000., 0.3)};
    p.load_stepping          = {{1.}, {1}};
    p.newton.force_tolerance = 1e-10;
    p.output.results_folder  = "point_load_" + name;
    p.output.write_vtu       = false;
    p.linear_solver.type     = LinearSolverParameters::Type::direct;
    return p;
  }

  void refine_corner(Parameters &p)
  {
    p.bodies[0].local_refinement = 1;
    p.bodies[0].refine_where     = "x+y+z>1.6";
  }

  /// Directions and all points turned about (1, 1, 1).
  const dealii::Tensor<2, dim> R =
      dealii::Physics::Transformations::Rotations::rotation_matrix_3d(Point(Vector3({1, 1, 1}) / std::sqrt(3.)), 0.5);
  std::vector<double> turned(const Vector3 &v)
  {
    const Vector3 there = R * v;
    return {there[0], there[1], there[2]};
  }
  void turn(BodyParameters &body)
  {
    body.rotation_axis  = Vector3({1, 1, 1});
    body.rotation_angle = 0.5 * 180. / dealii::numbers::PI;
  }
  /// Turns what on_springs() makes; the load becomes one along its direction.
  void turn(Parameters &p)
  {
    turn(p.bodies[0]);
    for (auto &c : p.boundary_conditions)
    {
      Vector3 along = force;
      if (c.type == Type::point_spring)
      {
        along                  = Vector3();
        along[c.components[0]] = 2.; // of any length
      }
      c.point      = turned(Vector3({c.point[0], c.point[1], c.point[2]}));
      c.direction  = turned(along);
      c.components = {};
    }
    std::ostringstream load;
    load << std::setprecision(17) << force.norm() << "*t";
    p.boundary_conditions[0].value = {load.str()};
    for (auto &point : p.output_points)
      point.position = R * point.position;
  }

  /// @p expected_part of the load at the end.
  void on_springs(const std::string                       &name,
                  const unsigned int                       degree,
                  const double                             expected_part,
                  const std::function<void(Parameters &)> &change,
                  const bool                               restarts = false)
  {
    Parameters p = cube(name, degree);
    p.boundary_conditions.push_back(at_point("load", Type::point_load, loaded, {2, 0, 1}, {"3*t", "t", "-2*t"}));
    for (unsigned int s = 0; s < springs.size(); ++s)
    {
      const std::string number = "spring " + std::to_string(s + 1);
      p.boundary_conditions.push_back(
          at_point(number, Type::point_spring, springs[s].X, {springs[s].component}, {std::to_string(stiffness)}));
      p.output_points.push_back({number, 1, Vector3(springs[s].X)});
    }
    p.output_points.push_back({"loaded", 1, Vector3(loaded)});
    change(p);
    std::ostringstream own_log;
    ContactProblem     problem(p, world(), own_log);
    check(name + ": no warning", !warns(problem, own_log, restarts));
    auto u = displacements(p.output.results_folder);
    if (!p.boundary_conditions[0].direction.empty())
      for (auto &[point, there] : u)
        there = transpose(R) * there;
    const auto   reference = elongations();
    const double largest   = std::abs(*std::max_element(
        reference.begin(), reference.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    double       worst     = 0.;
    for (unsigned int s = 0; s < springs.size(); ++s)
      worst = std::max(
          worst,
          std::abs(u.at("spring " + std::to_string(s + 1))[springs[s].component] - expected_part * reference[s]));
    check("  springs", worst / largest, 0., 1e-9, 1.);
    if (expected_part == 0.)
      return;
    const double work = 0.5 * (force * u.at("loaded"));
    check("  stored energy", last_energy(p.output.results_folder, "stored") / work, 1., 1e-8);
    if (p.load_stepping.increments.front() == 1)
      check("  work of the load", last_energy(p.output.results_folder, "external") / work, 1., 1e-8);
  }

  /// The moment of the clamp about one of its points, where a spring takes the force along z.
  void clamped(const std::string &name, const unsigned int degree, const std::function<void(Parameters &)> &change)
  {
    const Point X(0.37, 0.61, 0.83), spring(0.25, 0.7, 1.), centre(0.5, 0.4, 0.);
    Parameters  p         = cube(name, degree);
    p.boundary_conditions = {hold("clamp", region(1, {z_minus}), {0, 1, 2}),
                             at_point("load", Type::point_load, X, {0, 1, 2}, {"1", "-2", "3"})};
    change(p);
    {
      std::ostringstream own_log;
      ContactProblem     problem(p, world(), own_log);
      check(name + ": no warning", !warns(problem, own_log));
      check(
          "  sum of reactions and load", (problem.reactions()[0].second + force).norm() / force.norm(), 0., 1e-9, 1.);
    }
    auto base                   = condition("clamp", Type::rigid_motion, region(1, {z_minus}), {0, 1, 2}, {});
    base.free                   = {2};
    base.motion.rotation_centre = {centre[0], centre[1], centre[2]};
    p.boundary_conditions[0]    = base;
    p.boundary_conditions.push_back(at_point("spring", Type::point_spring, spring, {2}, {"500"}));
    p.output_points = {{"spring", 1, Vector3(spring)}};
    ContactProblem problem(p, world(), log());
    problem.run();
    MPI_Barrier(world());
    const RigidBodyMotion &clamp = problem.rigid_bodies().front();
    check("  spring", displacements(p.output.results_folder).at("spring")[2], force[2] / 500., 1e-9);
    check("  force of the clamp", Vector3(clamp.force), Vector3({-1, 2, 0}), 1e-9);
    check("  moment",
          Vector3(clamp.moment),
          -(dealii::cross_product_3d(Vector3(X - centre), force) +
            dealii::cross_product_3d(Vector3(spring - centre), Vector3({0, 0, -force[2]}))),
          1e-9);
  }

  /// St. Venant-Kirchhoff without Poisson's ratio: F = E A/2 (s^2 - 1) s at the stretch s = 1.1.
  void pulled_bar(const unsigned int degree)
  {
    constexpr double E = 200., L = 4., s = 1.1, F = E / 2. * (s * s - 1.) * s;
    const auto       text = [](const double value)
    {
      std::ostringstream stream;
      stream << std::setprecision(17) << value << "*t";
      return stream.str();
    };
    Parameters p             = cube("bar", degree);
    p.bodies                 = {box("bar", "1,1,4", {-0.5, -0.5, 0}, {0.5, 0.5, L}, E, 0.)};
    p.bodies[0].material.law = MaterialParameters::Law::st_venant_kirchhoff;
    p.load_stepping          = {{1.}, {4}};
    p.boundary_conditions    = {hold("bottom", region(1, {z_minus}), {2}),
                                hold("x", region(1, {z_minus}, "x<-0.4"), {0}),
                                hold("y", region(1, {z_minus}, "y<-0.4"), {1})};
    if (degree == 1)
      p.boundary_conditions.push_back(at_point("pull", Type::point_load, {0, 0, L}, {2}, {text(F)}));
    else
      for (int i = -1; i < 2; ++i)
        for (int j = -1; j < 2; ++j)
          p.boundary_conditions.push_back(at_point("pull " + std::to_string(3 * i + j),
                                                   Type::point_load,
                                                   {0.5 * i, 0.5 * j, L},
                                                   {2},
                                                   {text(F * (i == 0 ? 4. : 1.) * (j == 0 ? 4. : 1.) / 36.)}));
    std::ostringstream own_log;
    ContactProblem     problem(p, world(), own_log);
    check("bar of degree " + std::to_string(degree) + ": no warning", !warns(problem, own_log));
    check("  elongation", problem.displacement(1, {0.5, -0.5, L}), Vector3({0, 0, (s - 1.) * L}), 1e-8);
    check("  middle", problem.displacement(1, {-0.5, -0.5, L / 2}), Vector3({0, 0, (s - 1.) * L / 2}), 1e-8);
    check("  reaction", problem.reactions()[0].second[2], -F, 1e-9);
  }

  /// A column that stands askew on springs along its axis, held across it by others, under its weight and a traction:
  /// it goes down by (T + b)/k at the bottom, and by T/E + b/(2 E) more at the top.
  void askew_column(const unsigned int degree)
  {
    constexpr double E = 1000., k = 300., T = 2., b = 3.;
    Parameters       p = cube("column", degree);
    p.bodies           = {box("column", "2,2,3", {0, 0, 0}, {1, 1, 1}, E, 0.)};
    turn(p.bodies[0]);
    const auto along = [&](const Type type, const RegionParameters &where, const Vector3 &direction, const double value)
    {
      auto c      = condition("", type, where, {}, {std::to_string(value)});
      c.direction = turned(direction);
      p.boundary_conditions.push_back(c);
    };
    along(Type::spring, region(1, {x_minus}), Vector3({1, 0, 0}), k);
    along(Type::spring, region(1, {y_minus}), Vector3({0, 1, 0}), k);
    along(Type::spring, region(1, {z_minus}), Vector3({0, 0, 5}), k);
    along(Type::traction, region(1, {z_plus}), Vector3({0, 0, -1}), T);
    along(Type::body_force, region(1, {}), Vector3({0, 0, -1}), b);
    std::ostringstream own_log;
    ContactProblem     problem(p, world(), own_log);
    check("askew column of degree " + std::to_string(degree) + ": no warning", !warns(problem, own_log));
    const double u = (T + b) / k;
    check("  bottom", problem.displacement(1, Point(R * Vector3({1, 0, 0}))), R * Vector3({0, 0, -u}), 1e-8);
    check("  top",
          problem.displacement(1, Point(R * Vector3({0, 1, 1}))),
          R * Vector3({0, 0, -u - (T + 0.5 * b) / E}),
          1e-8);
    check("  stored energy",
          last_energy(p.output.results_folder, "stored"),
          0.5 * (T + b) * u + 0.5 / E * (T * T + T * b + b * b / 3.),
          degree == 2 ? 1e-8 : 1e-3);
  }

  /// A contact takes the force and its moment.
  void pressed_block(const unsigned int degree)
  {
    Parameters p              = cube("pressed", degree);
    p.bodies                  = {box("upper", "2,2,2", {0, 0, 1}, {1, 1, 2}, 1000., 0.3),
                                 box("lower", "3,3,2", {-0.1, -0.1, 0}, {1.1, 1.1, 1}, 1000., 0.3)};
    p.newton.force_tolerance  = 1e-10;
    p.boundary_conditions     = {hold("ground", region(2, {z_minus}), {0, 1, 2}),
                                 hold("x", region(1, {x_minus}), {0}),
                                 hold("y", region(1, {y_minus}), {1}),
                                 at_point("press", Type::point_load, {0.4, 0.55, 2}, {2}, {"-20*t"})};
    p.contact_pairs           = {pair(region(1, {z_minus}), region(2, {z_plus}))};
    p.contact_pairs[0].scheme = ContactPairParameters::Scheme::averaged;
    std::ostringstream own_log;
    ContactProblem     problem(p, world(), own_log);
    check("pressed block: no warning", !warns(problem, own_log));
    check("  contact", problem.contact_resultants().front().slave_force[2], 20., 1e-7);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const auto                               nothing = [](Parameters &) {};

  for (const unsigned int degree : {1, 2})
  {
    const std::string of_degree = " of degree " + std::to_string(degree);
    on_springs("springs" + of_degree, degree, 1., nothing);
    on_springs("hanging" + of_degree, degree, 1., refine_corner);
    on_springs("turned" + of_degree, degree, 1., [](Parameters &p) { turn(p); });
    askew_column(degree);
    clamped("clamp" + of_degree, degree, nothing);
    clamped("hanging clamp" + of_degree, degree, refine_corner);
    pulled_bar(degree);
  }
  on_springs("taken away",
             1,
             0.,
             [](Parameters &p)
             {
               p.load_stepping                       = {{1., 2.}, {1, 1}};
               p.boundary_conditions[0].active_until = 1.;
             });
  const auto refined = [](Parameters &p)
  {
    p.load_stepping              = {{1.}, {6}};
    p.adaptivity.interval        = 2;
    p.adaptivity.maximum_level   = 2;
    p.adaptivity.refine_fraction = 0.4;
    p.output.checkpoint_interval = 4;
    p.output.results_folder      = "point_load_refined";
  };
  on_springs("refined on the way", 1, 1., refined);
  on_springs("from a checkpoint", 1, 1., refined, true);
  pressed_block(1);
  pressed_block(2);
}
