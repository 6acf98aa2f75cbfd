// Columns without any imperfection, which buckle under dead loads and under prescribed shortenings: Euler's elastica in
// closed form. Newton's method stays on the straight branch; the run leaves it, or says that it is not stable: with the
// direct solver, which the slender ones take, and with the iterative one, which the stocky one takes.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <cmath>

using namespace Cases;
using Type = BoundaryConditionParameters::Type;

namespace
{
  constexpr double length = 40., modulus = 1e5, bending = modulus / 12.; // of a section of 1 x 1

  /// Of a column that is clamped below and turns by @p degrees at its free end (Love, Mathematical theory of
  /// elasticity, 262): load over Euler's, height and deflection of the end over the length.
  struct Elastica
  {
    explicit Elastica(const double degrees)
    {
      const double k = std::sin(degrees * dealii::numbers::PI / 360.), K = std::comp_ellint_1(k);
      load       = std::pow(2. * K / dealii::numbers::PI, 2);
      height     = 2. * std::comp_ellint_2(k) / K - 1.;
      deflection = 2. * k / K;
    }
    double load, height, deflection;
  };

  Parameters column()
  {
    Parameters p;
    p.degree                      = 2;
    p.bodies                      = {box("column", "1,20,1", {-0.5, 0, 0}, {0.5, length, 1}, modulus, 0.)};
    p.bodies[0].material.law      = MaterialParameters::Law::st_venant_kirchhoff;
    p.boundary_conditions         = {hold("clamp", region(1, {y_minus}), {0, 1, 2}),
                                     hold("plane strain", region(1, {z_minus, z_plus}), {2})};
    p.load_stepping.interval_ends = {1.};
    p.load_stepping.increments    = {2};
    p.output.results_folder       = "buckling_results";
    p.output.vtu_interval         = 0;
    return p;
  }

  /// A dead load on the free end, in two increments: the first one ends below Euler's load.
  void load_column(const double degrees)
  {
    const Elastica elastica(degrees);
    const double   load = elastica.load * dealii::numbers::PI * dealii::numbers::PI * bending / (4. * length * length);
    Parameters     p    = column();
    p.boundary_conditions.push_back(
        condition("load", Type::traction, region(1, {y_plus}), {1}, {"-" + std::to_string(load) + "*t"}));
    ContactProblem problem(p, world(), log());
    problem.run();
    const Vector3 u = problem.displacement(1, Point(0, length, 0));
    report("free end turns by", Numbers::plain(degrees) + " degrees");
    check("  height", 1. + u[1] / length, elastica.height, 0.01, 1.);
    check("  deflection", std::abs(u[0]) / length, elastica.deflection, 0.01, 1.);
  }

  /// Both ends are clamped, and one is moved: four quarters of the elastica.
  Parameters shortened_column(const double shortening)
  {
    Parameters p = column();
    p.boundary_conditions.push_back(hold("guide", region(1, {y_plus}), {0, 2}));
    p.boundary_conditions.push_back(
        drive("press", region(1, {y_plus}), 1, "-" + std::to_string(shortening * length) + "*t"));
    return p;
  }

  /// Of 1 x 10 x 1, free to bend to all sides.
  Parameters stocky_column(const double shortening)
  {
    Parameters p               = column();
    p.bodies                   = {box("column", "3,10,3", {0, 0, 0}, {1, 10, 1}, modulus, 0.)};
    p.bodies[0].material.law   = MaterialParameters::Law::st_venant_kirchhoff;
    p.boundary_conditions      = {hold("clamp", region(1, {y_minus}), {0, 1, 2}),
                                  drive("press", region(1, {y_plus}), 1, "-" + std::to_string(shortening * 10.) + "*t")};
    p.load_stepping.increments = {4};
    return p;
  }

  double force(const Parameters &p)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    return problem.reactions()[0].second[1];
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  load_column(60.);
  load_column(120.);

  const Elastica   elastica(30.);
  const double     euler = 4. * dealii::numbers::PI * dealii::numbers::PI * bending / (length * length);
  const Parameters p     = shortened_column(1. - elastica.height);
  check("both ends clamped: force over Euler's", force(p) / euler, elastica.load, 0.02);

  Parameters straight = p;
  straight.strategy.without.push_back("relaxation");
  check("  without relaxation, straight: over what presses it together",
        force(straight) / (modulus * (1. - elastica.height)),
        1.,
        0.2);

  // a guided end; its shear, kappa = 5/6, takes 2 per cent from the load (Timoshenko & Gere, section 2.17)
  const double stocky_euler = dealii::numbers::PI * dealii::numbers::PI * bending / 100.;
  check("stocky: force over Euler's with shear",
        force(stocky_column(0.015)) / stocky_euler * (1. + stocky_euler / (0.5 * modulus * 5. / 6.)),
        1.,
        0.03);
}
