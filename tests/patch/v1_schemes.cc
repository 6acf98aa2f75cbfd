// The patch test of every scheme: two blocks with non-matching faces pressed together by 25. Exact: lambda = -25
// everywhere, top displacement -0.025. Averaged jumps over segments pass to round-off, for three pairs of meshes, both
// choices of the slave, Q1 and Q2, upright and rotated; over a fixed rule to 1 %. The integration point scheme with 3
// Gauss points is compared with Code_Aster 14.6 (initial configuration, so reference surface measure), Q1.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

namespace
{
  constexpr double E = 2000., angle = 33.;
  const Vector3    axis({1, 2, 0.5});

  Vector3 turned(const Vector3 &x)
  {
    const Vector3 e = axis / axis.norm();
    const double  a = angle * dealii::numbers::PI / 180;
    return std::cos(a) * x + std::sin(a) * dealii::cross_product_3d(e, x) + (1 - std::cos(a)) * (e * x) * e;
  }

  /// @p rotated: turned by 33 degrees about (1, 2, 0.5), without Poisson's effect and on a clamped bottom; friction
  /// holds the upper block.
  Parameters blocks(const std::string &lower_cells,
                    const std::string &upper_cells,
                    const bool         upper_is_slave,
                    const unsigned int degree,
                    const bool         rotated)
  {
    Parameters   p;
    const double nu = rotated ? 0. : 0.3;
    p.degree        = degree;
    p.bodies        = {box("lower", lower_cells, {0, 0, 0}, {1, 1, 1}, E, nu),
                       box("upper", upper_cells, {0, 0, 1}, {1, 1, 2}, E, nu)};
    if (rotated)
    {
      for (auto &body : p.bodies)
      {
        body.rotation_axis  = axis;
        body.rotation_angle = angle;
      }
      p.boundary_conditions = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
      const Vector3 u       = turned(Vector3({0., 0., -0.025}));
      for (unsigned int c = 0; c < 3; ++c)
      {
        std::ostringstream value;
        value << std::setprecision(17) << u[c];
        p.boundary_conditions.push_back(drive("top " + std::to_string(c), region(2, {z_plus}), c, value.str()));
      }
    }
    else
      p.boundary_conditions = {hold("x", region(0, {x_minus}), {0}),
                               hold("y", region(0, {y_minus}), {1}),
                               hold("z", region(1, {z_minus}), {2}),
                               press("top", region(2, {z_plus}), "25")};
    const auto lower = region(1, {z_plus}), upper = region(2, {z_minus});
    p.contact_pairs                    = {upper_is_slave ? pair(upper, lower, rotated ? 0.5 : 0.)
                                                         : pair(lower, upper, rotated ? 0.5 : 0.)};
    p.contact_pairs[0].surface_measure = ContactPairParameters::SurfaceMeasure::reference;
    p.contact_pairs[0].scheme          = ContactPairParameters::Scheme::averaged;
    p.contact_pairs[0].start.status    = ContactPairParameters::InitialStatus::closed;
    p.linear_solver.type               = LinearSolverParameters::Type::direct; // answers to 1e-9 are asked for
    p.output.results_folder            = "schemes_results";
    return p;
  }

  /// The multiplier and the top displacement that are farthest from the exact ones.
  void check_patch(const std::string &name, const Parameters &p, const double tolerance)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    check(name + ": lambda", farthest(problem.contact_fields()[0].multiplier, -25.), -25., tolerance);
    if (p.bodies[0].rotation_angle != 0.)
      return;
    std::vector<double> top;
    for (const double x : {0., 1.})
      for (const double y : {0., 1.})
        top.push_back(problem.displacement(2, {x, y, 2.})[2]);
    check("  u_z(top)", farthest(top, -0.025), -0.025, tolerance);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Integration = ContactPairParameters::Integration;

  const std::pair<const char *, const char *> meshes[] = {{"3,3,2", "2,2,2"}, {"4,3,2", "3,5,1"}, {"2,2,1", "5,4,2"}};
  for (const unsigned int degree : {1u, 2u})
    for (const auto &[lower, upper] : meshes)
      for (const bool upper_is_slave : {true, false})
      {
        std::ostringstream name;
        name << "Q" << degree << ", " << lower << " under " << upper << ", slave "
             << (upper_is_slave ? "upper" : "lower");
        check_patch(name.str() + ", segment", blocks(lower, upper, upper_is_slave, degree, false), 1e-9);
        check_patch(name.str() + ", segment, rotated", blocks(lower, upper, upper_is_slave, degree, true), 1e-9);
        Parameters p                   = blocks(lower, upper, upper_is_slave, degree, false);
        p.contact_pairs[0].integration = Integration::face;
        check_patch(name.str() + ", face", p, 1e-2);
      }

  // integration points, 3 Gauss points per direction, against Code_Aster
  for (const bool upper_is_slave : {true, false})
  {
    Parameters p                         = blocks("3,3,2", "2,2,2", upper_is_slave, 1, false);
    p.contact_pairs[0].scheme            = ContactPairParameters::Scheme::integration_point;
    p.contact_pairs[0].quadrature_points = 3;
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto         &lambda = problem.contact_fields()[0].multiplier;
    std::vector<double> top;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        top.push_back(problem.displacement(2, {0.5 * i, 0.5 * j, 2})[2]);
    const auto [low, high]         = std::minmax_element(lambda.begin(), lambda.end());
    const auto [top_low, top_high] = std::minmax_element(top.begin(), top.end());
    const std::string name         = std::string("integration points, slave ") + (upper_is_slave ? "upper" : "lower");
    check(name + ", lambda min", *low, upper_is_slave ? -26.088299 : -26.398345, 1e-4);
    check(name + ", lambda max", *high, upper_is_slave ? -23.889236 : -24.275542, 1e-4);
    check(name + ", u_z(top) min", *top_low, upper_is_slave ? -0.025017752 : -0.025018205, 1e-4);
    check(name + ", u_z(top) max", *top_high, upper_is_slave ? -0.024991226 : -0.024991004, 1e-4);
  }
}
