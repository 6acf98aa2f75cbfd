// A cube in a corner: two of its sides are slaves of two pairs, and the nodes of the edge between them are slaves of
// both.
// - without friction: each wall carries the pressure that pushes against it, the same at all of its nodes;
// - pushed into a V by the weight P and dragged along it, each wall carries P / (2 sin a), a = 45 degrees, and friction
//   2 mu P / (2 sin a); in a right-angled corner mu_1 P_1 + mu_2 P_2.
// Walls are planes in closed form, rigid blocks, or elastic blocks; all schemes, degrees and solvers.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <cmath>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;
  using Solver = LinearSolverParameters::Type;
  using Type   = BoundaryConditionParameters::Type;

  enum class Wall
  {
    plane,
    rigid,
    elastic
  };

  constexpr double E = 1000.;

  /// Of a block of the wall, with the cube's face at @p side of it.
  BodyParameters wall_block(const std::string &name, const bool floor, const Wall wall)
  {
    BodyParameters body = floor ? box(name, "3,4,1", {-0.1, -1, -0.5}, {1.6, 3, 0}, E, 0.)
                                : box(name, "1,5,3", {-0.5, -1, -0.1}, {0, 3, 1.6}, E, 0.);
    body.rigid          = wall == Wall::rigid;
    return body;
  }

  /// The cube [0,1]^3 in the corner of the floor z = 0 and the wall x = 0; all of it turned by @p angle about y.
  Parameters cube_in_corner(const Wall                      wall,
                            const Scheme                    scheme,
                            const double                    angle,
                            const std::array<double, 2>    &friction,
                            const std::vector<std::string> &traction)
  {
    Parameters p;
    p.bodies = {box("cube", "3,3,3", {0, 0, 0}, {1, 1, 1}, E, 0.3)};
    if (wall != Wall::plane)
      for (const bool floor : {true, false})
        p.bodies.push_back(wall_block(floor ? "floor" : "wall", floor, wall));
    for (auto &body : p.bodies)
    {
      body.rotation_axis  = Vector3({0., 1., 0.});
      body.rotation_angle = angle;
    }
    for (const bool floor : {true, false})
    {
      const unsigned int    side = floor ? z_minus : x_minus;
      ContactPairParameters pair;
      pair.name                 = floor ? "floor" : "wall";
      pair.slave                = region(1, {side});
      pair.scheme               = scheme;
      pair.friction_coefficient = friction[floor ? 0 : 1];
      if (wall == Wall::plane)
      {
        const double a            = angle * dealii::numbers::PI / 180.;
        pair.master_surface.shape = MasterSurfaceParameters::Shape::plane;
        pair.master_surface.axis =
            floor ? Vector3({std::sin(a), 0., std::cos(a)}) : Vector3({std::cos(a), 0., -std::sin(a)});
      }
      else
        pair.master = region(floor ? 2 : 3, {floor ? z_plus : x_plus});
      p.contact_pairs.push_back(pair);
      if (wall == Wall::elastic)
        p.boundary_conditions.push_back(
            hold(floor ? "below" : "behind", region(floor ? 2 : 3, {floor ? z_minus : x_minus}), {0, 1, 2}));
    }
    p.boundary_conditions.push_back(
        condition("top", Type::traction, region(1, {z_plus}), {0, 1, 2}, {traction[0], "0", traction[1]}));
    p.boundary_conditions.push_back(
        condition("side", Type::traction, region(1, {x_plus}), {0, 1, 2}, {traction[2], "0", traction[3]}));
    p.output.write_vtu      = false;
    p.output.results_folder = "corner_results";
    return p;
  }

  void check_uniform(
      const std::string &name, const Wall wall, const Scheme scheme, const unsigned int degree, const Solver solver)
  {
    Parameters p         = cube_in_corner(wall, scheme, 0., {{0., 0.}}, {"0", "-20", "-10", "0"});
    p.degree             = degree;
    p.linear_solver.type = solver;
    p.boundary_conditions.push_back(hold("y", region(1, {y_minus}), {1}));
    for (auto &pair : p.contact_pairs)
      pair.surface_measure = ContactPairParameters::SurfaceMeasure::reference;
    p.load_stepping = {{1.}, {1}};
    ContactProblem problem(p, world(), log());
    problem.run();
    report(name, "");
    const auto &fields = problem.contact_fields();
    for (unsigned int k = 0; k < 2; ++k)
    {
      const double reference = k == 0 ? 20. : 10.;
      check(k == 0 ? "  pressure of the floor, farthest" : "  pressure of the wall, farthest",
            farthest(fields[k].pressure, reference),
            reference,
            1e-7);
      check("  force", problem.contact_resultants()[k].slave_force[k == 0 ? 2 : 0], reference, 1e-8);
    }
    check("  pressure at an end of the edge", fields[0].pressure[node_at(fields[0], {0, 0, 0})], 20., 1e-7);
    check_equal("  slave nodes", fields[0].X.size() + fields[1].X.size(), 2 * (3 * degree + 1) * (3 * degree + 1));
  }

  /// On a mesh with nodes that hang, on the edge too, and on meshes that change on the way.
  void check_adapted(const bool on_the_way)
  {
    Parameters p = cube_in_corner(Wall::plane, Scheme::averaged, 0., {{0., 0.}}, {"0", "-20*t", "-10*t", "0"});
    if (on_the_way)
    {
      p.adaptivity.interval        = 1;
      p.adaptivity.refine_fraction = 0.4;
      p.adaptivity.maximum_level   = 1;
    }
    else
    {
      p.bodies[0].local_refinement = 1;
      p.bodies[0].refine_where     = "y<0.4";
    }
    p.boundary_conditions.push_back(hold("y", region(1, {y_minus}), {1}));
    for (auto &pair : p.contact_pairs)
      pair.surface_measure = ContactPairParameters::SurfaceMeasure::reference;
    p.load_stepping = {{1.}, {3}};
    ContactProblem problem(p, world(), log());
    problem.run();
    report(on_the_way ? "refined on the way" : "hanging nodes", "");
    for (unsigned int k = 0; k < 2; ++k)
    {
      const double         reference = k == 0 ? 20. : 10.;
      const ContactFields &fields    = problem.contact_fields()[k];
      check("  pressure, farthest", farthest(fields.pressure, reference), reference, 1e-7);
      check("  more nodes than before", fields.X.size() > 16);
    }
  }

  void check_dragged(const std::string &name,
                     const Wall         wall,
                     const Scheme       scheme,
                     const Solver       solver,
                     const bool         v,
                     const bool         in_two = false)
  {
    const std::array<double, 2> mu = v ? std::array<double, 2>{{0.4, 0.4}} : std::array<double, 2>{{0.2, 0.5}};
    Parameters p         = v ? cube_in_corner(wall, scheme, -45., mu, {"0", "-5*min(1,2*t)", "0", "-5*min(1,2*t)"})
                             : cube_in_corner(wall, scheme, 0., mu, {"0", "-20*min(1,2*t)", "-10*min(1,2*t)", "0"});
    p.linear_solver.type = solver;
    for (const unsigned int side : {z_plus, x_plus})
      p.boundary_conditions.push_back(
          drive(side == z_plus ? "drag top" : "drag side", region(1, {side}, "x*x+z*z>1.2"), 1, "max(0,2*t-1)"));
    p.load_stepping = {{0.5, 1.}, {2, 10}};
    if (in_two)
    {
      Parameters first                 = p;
      first.load_stepping              = {{0.5}, {2}};
      first.output.checkpoint_interval = 2;
      ContactProblem(first, world(), log()).run();
      MPI_Barrier(world());
    }
    ContactProblem problem(p, world(), log());
    if (in_two)
      problem.restart();
    problem.run();
    report(name, "");
    const double N[2]  = {v ? std::sqrt(0.5) * 10. : 20., v ? std::sqrt(0.5) * 10. : 10.};
    double       drag  = 0.;
    unsigned int stick = 0;
    for (unsigned int k = 0; k < 2; ++k)
    {
      const auto   &pair = problem.contact_resultants()[k];
      const double  a    = v ? dealii::numbers::PI / 4. : 0.;
      const Vector3 n    = k == 0 ? Vector3({-std::sin(a), 0., std::cos(a)}) : Vector3({std::cos(a), 0., std::sin(a)});
      const char   *what = k == 0 ? "  pressed on the floor by" : "  on the wall by";
      if (wall == Wall::elastic) // which tilts
        check_error(what + std::string(", off by"), std::abs(pair.slave_force * n / N[k] - 1.), 0.01);
      else
        check(what, pair.slave_force * n, N[k], 1e-6);
      drag -= pair.slave_force[1];
      stick += pair.stick;
    }
    const double expected = mu[0] * N[0] + mu[1] * N[1];
    if (wall == Wall::elastic)
      check_error("  drag, off by", std::abs(drag / expected - 1.), 0.005);
    else
      check("  drag", drag, expected, 1e-6);
    check_equal("  sites that stick", stick, 0);
  }

  void refuse(const std::string &name, const Parameters &p)
  {
    try
    {
      ContactProblem(p, world(), log());
      report(name, "NO");
    }
    catch (const InputError &error)
    {
      report(name, error.what());
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_uniform("averaged, planes", Wall::plane, Scheme::averaged, 1, Solver::automatic);
  check_uniform("nodal, planes, direct", Wall::plane, Scheme::nodal, 1, Solver::direct);
  check_uniform("integration points, planes, block", Wall::plane, Scheme::integration_point, 1, Solver::block);
  check_uniform("averaged, planes, quadratic, condensed", Wall::plane, Scheme::averaged, 2, Solver::condensed);
  check_uniform("averaged, rigid blocks, block", Wall::rigid, Scheme::averaged, 1, Solver::block);
  check_uniform("averaged, rigid blocks, condensed", Wall::rigid, Scheme::averaged, 1, Solver::condensed);

  check_dragged("V of planes", Wall::plane, Scheme::averaged, Solver::condensed, true);
  check_dragged("V of rigid blocks, nodal, direct", Wall::rigid, Scheme::nodal, Solver::direct, true);
  check_dragged("V of elastic blocks", Wall::elastic, Scheme::averaged, Solver::condensed, true);
  check_dragged("right angle of planes", Wall::plane, Scheme::averaged, Solver::block, false);
  check_dragged("right angle of planes, restarted", Wall::plane, Scheme::nodal, Solver::direct, false, true);
  check_dragged("right angle of elastic blocks", Wall::elastic, Scheme::averaged, Solver::automatic, false);

  check_adapted(false);
  check_adapted(true);

  Parameters p             = cube_in_corner(Wall::plane, Scheme::averaged, 0., {{0., 0.}}, {"0", "0", "0", "0"});
  p.contact_pairs[0].slave = region(1, {z_minus, x_minus});
  refuse("a face of both pairs", p);
  p.contact_pairs[0].slave = region(1, {z_minus}, "x<0.6");
  p.contact_pairs[1].slave = region(1, {z_minus}, "x>0.6");
  refuse("no edge between them", p);
  p = cube_in_corner(Wall::plane, Scheme::integration_point, 0., {{0., 0.1}}, {"0", "0", "0", "0"});
  refuse("friction of integration points", p);
  return 0;
}
