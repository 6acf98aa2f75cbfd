// Pressure-gap laws and elastic slip against closed forms, all schemes, merged and nested loops, all solvers.
//
// A column of height 1 with E = 1000 and nu = 0 that is pressed against a held plane by 0.01: with the overclosure
// d(p), p/E + d(p) = 0.01.
//
// A cube with shear modulus G = 500 on hard contact is pressed down and driven by D(t) along x on its upper side. It
// has one layer of cells, so that its lower nodes have no vertical motion and it is in simple shear G (D - s), s the
// slip of its lower side. Tresca's friction is tau e/gamma with the elastic part e of s, and s - e grows while |e| =
// gamma. There and back, so that it sticks, slips, comes off the limit, and slips the other way. A cube that is as good
// as rigid (E = 1e10) on a linear layer has Coulomb's friction mu p e/gamma with s = D.
//
// The same cube with a friction law of the test's own, whose state is the way that a site has rubbed: mu follows it
// from increment to increment.
//
// Towards hard contact, force 10 = F: the error F/(1 + k/E) is proportional to the compliance 1/k in the end.

#include <nodus/plugins/friction_law.h>

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <fstream>
#include <functional>
#include <limits>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;
  using Solver = LinearSolverParameters::Type;
  using Gap    = PressureGapParameters;

  /// Coulomb's law whose coefficient falls with the way that a site has rubbed, its state.
  class RunningIn : public Nodus::FrictionLaw
  {
  public:
    static double coefficient(const double way)
    {
      return 0.2 + 0.4 * std::exp(-way / 0.05);
    }
    double limit(const FrictionPoint &point) const override
    {
      return coefficient(point.state[0]) * point.pressure;
    }
    double limit_by_pressure(const FrictionPoint &point) const override
    {
      return coefficient(point.state[0]);
    }
    std::array<double, FrictionPoint::max_state> next_state(const FrictionPoint &point,
                                                            const double         duration) const override
    {
      return {{point.state[0] + point.rate * duration, 0., 0., 0.}};
    }
  };

  struct Way
  {
    std::string name;
    Scheme      scheme;
    bool        loops;
    Solver      solver;
  };
  const Way ways[] = {{"nodal, merged loops, condensed", Scheme::nodal, false, Solver::condensed},
                      {"nodal, nested loops, direct", Scheme::nodal, true, Solver::direct},
                      {"averaged, merged loops, condensed", Scheme::averaged, false, Solver::condensed},
                      {"averaged, nested loops, block", Scheme::averaged, true, Solver::block},
                      {"integration point, merged loops, direct", Scheme::integration_point, false, Solver::direct},
                      {"integration point, nested loops, block", Scheme::integration_point, true, Solver::block}};

  Parameters case_of(const Way &way, const ContactPairParameters &laws)
  {
    Parameters p;
    p.bodies                      = {box("lower", "1,1,1", {-0.5, -0.5, -1}, {1.5, 1.5, 0}, 1000, 0.),
                                     box("upper", "2,2,1", {0, 0, 0}, {1, 1, 1}, 1000, 0.)};
    p.boundary_conditions         = {hold("ground", region(1, {0, 1, 2, 3, 4, 5}), {0, 1, 2})};
    ContactPairParameters contact = laws;
    contact.name                  = "pair";
    contact.slave                 = region(2, {z_minus});
    contact.master                = region(1, {z_plus});
    contact.scheme                = way.scheme;
    contact.surface_measure       = ContactPairParameters::SurfaceMeasure::reference;
    p.contact_pairs               = {contact};
    p.newton.contact_tolerance    = 1e-11;
    p.linear_solver.type          = way.solver;
    p.linear_solver.tolerance     = 1e-12;
    p.output.results_folder       = "surfaces_that_give_way_results";
    p.output.write_vtu            = false;
    if (way.loops)
      use_loops(p);
    p.threshold_loop.tolerance = 1e-11;
    return p;
  }

  double pressed(const Way &way, const Gap &gap, const std::string &by = "-0.01*t")
  {
    ContactPairParameters laws;
    laws.pressure_gap = gap;
    Parameters p      = case_of(way, laws);
    p.boundary_conditions.push_back(drive("down", region(2, {z_plus}), 2, by));
    p.boundary_conditions.push_back(hold("guide", region(2, {z_plus}), {0, 1}));
    p.load_stepping.increments = {2};
    ContactProblem problem(p, world(), log());
    problem.run();
    return problem.contact_resultants()[0].slave_force[2];
  }

  /// The pressure of the column that is pressed by @p by, by bisection.
  double root_of(const std::function<double(double)> &overclosure, const double by = 0.01)
  {
    double below = 0., above = 100.;
    for (unsigned int i = 0; i < 200; ++i)
    {
      const double p                                    = 0.5 * (below + above);
      (p / 1000. + overclosure(p) < by ? below : above) = p;
    }
    return below;
  }

  void press_against(const Way &way)
  {
    Gap gap;
    gap.law       = Gap::Law::linear;
    gap.stiffness = 500.;
    check("linear", pressed(way, gap), 0.01 / (1. / 1000. + 1. / 500.), 1e-8);
    gap.law               = Gap::Law::exponential;
    gap.stiffening_length = 0.002;
    check("exponential", pressed(way, gap), root_of([](const double p) { return 0.002 * std::log(1. + p); }), 1e-8);
    gap              = Gap();
    gap.law          = Gap::Law::table;
    gap.overclosures = {-0.002, 0.001, 0.0015};
    gap.pressures    = {0., 2., 6.};
    const auto table = [](const double p) { return p < 2. ? -0.002 + 0.0015 * p : 0.001 + 0.000125 * (p - 2.); };
    check("table that begins with a gap", pressed(way, gap), root_of(table), 1e-8);
    check("and in its first interval", pressed(way, gap, "-0.0001*t"), root_of(table, 0.0001), 1e-8);

    gap.law          = Gap::Law::linear;
    gap.overclosures = {};
    gap.pressures    = {};
    double error[2];
    for (const bool stiffer : {false, true})
    {
      gap.stiffness  = stiffer ? 1e6 : 1e5;
      error[stiffer] = 10. - pressed(way, gap);
    }
    check("towards hard contact: ratio of the errors, compliance 1/10", error[0] / error[1], 1001. / 101., 1e-5);
  }

  /// Friction on the slave along x after every increment, the upper side driven to each @p D.
  std::vector<double> sheared(const Way                   &way,
                              const ContactPairParameters &laws,
                              const double                 E,
                              const double                 down,
                              const std::vector<double>   &D)
  {
    Parameters p                        = case_of(way, laws);
    p.bodies[1].material.youngs_modulus = E;
    std::ostringstream drag;
    for (unsigned int i = 0; i + 1 < D.size(); ++i)
      drag << "if(t<" << (i + 1.5) / D.size() << ',' << D[i] << ',';
    drag << D.back() << std::string(D.size() - 1, ')');
    p.boundary_conditions.push_back(drive("down", region(2, {z_plus}), 2, std::to_string(-down)));
    p.boundary_conditions.push_back(hold("guide", region(2, {y_minus, y_plus}), {1}));
    p.boundary_conditions.push_back(drive("drag", region(2, {z_plus}), 0, drag.str()));
    p.load_stepping.increments = {static_cast<unsigned int>(D.size())};
    std::vector<double> forces;
    ContactProblem      problem(p, world(), log());
    problem.on_increment([&](unsigned int, double)
                         { forces.push_back(problem.contact_resultants()[0].slave_force[0]); });
    problem.run();
    return forces;
  }

  /// Last value of a column of energy.csv.
  double energy(const std::string &title)
  {
    MPI_Barrier(world());
    std::ifstream file("surfaces_that_give_way_results/energy.csv");
    std::string   titles, line, last;
    std::getline(file, titles);
    while (std::getline(file, line))
      last = line;
    std::istringstream keys(titles), values(last);
    for (std::string key, value; std::getline(keys, key, ',') && std::getline(values, value, ',');)
      if (key.substr(0, key.find(" [")) == title)
        return std::stod(value);
    return std::numeric_limits<double>::quiet_NaN();
  }

  void shear(const Way &way)
  {
    constexpr double      G = 500., gamma = 0.01, stiffness = 400.;
    ContactPairParameters laws;
    laws.friction_law                = ContactPairParameters::FrictionLaw::tresca;
    laws.shear_limit                 = stiffness * gamma;
    laws.elastic_slip                = gamma;
    const std::vector<double> D      = {0.01, 0.04, 0.02, -0.02};
    const auto                forces = sheared(way, laws, 1000., 0.02, D);
    double                    slip = 0., elastic = 0.;
    for (unsigned int i = 0; i < 4; ++i)
    {
      // as if it stuck, e = s - s_0 + e_0; else at the limit
      elastic = std::clamp(G * (D[i] - slip + elastic) / (G + stiffness), -gamma, gamma);
      slip    = D[i] - stiffness * elastic / G;
      check("Tresca, elastic slip " + std::to_string(elastic), -forces[i], stiffness * elastic, 1e-8);
    }

    // what slid is 0.022 forth and 0.024 back; the elastic slip has stored 400 e^2/2
    check("dissipated by friction", energy("frictional dissipation"), 4. * (0.022 + 0.024), 1e-8);
    check("stored in the surfaces", -energy("contact work"), 200. * gamma * gamma, 1e-8);

    laws                             = ContactPairParameters();
    laws.friction_coefficient        = 0.4;
    laws.elastic_slip                = gamma;
    laws.pressure_gap.law            = Gap::Law::linear;
    laws.pressure_gap.stiffness      = 2000.;
    const auto                layer  = laws;
    const std::vector<double> driven = {0.005, 0.04, 0.0325, -0.02}, expected = {0.005, 0.01, 0.0025, -0.01};
    const auto                stiff = sheared(way, laws, 1e10, 0.005, driven);
    for (unsigned int i = 0; i < 4; ++i)
      check("Coulomb, elastic slip " + std::to_string(expected[i]), -stiff[i], stiffness * expected[i], 1e-6);

    // slides forth by 0.03 in the second increment, unloads in the third, and slides back by 0.02 in the last one
    laws                         = ContactPairParameters();
    laws.pressure_gap            = layer.pressure_gap;
    laws.elastic_slip            = 1e-4;
    laws.friction_law            = ContactPairParameters::FrictionLaw::own;
    laws.own_friction_law.object = std::make_shared<RunningIn>();
    const auto run_in            = sheared(way, laws, 1e10, 0.005, {0.01, 0.04, 0.0399, 0.03, 0.01});
    const std::vector<std::pair<unsigned int, double>> way_before = {{0, 0.}, {1, 0.01}, {3, 0.0401}, {4, 0.05}};
    for (const auto &[i, before] : way_before)
      check("own law, way " + std::to_string(before),
            -run_in[i],
            (i < 2 ? 10. : -10.) * RunningIn::coefficient(before),
            1e-6);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const Way &way : ways)
  {
    if (root())
      std::cout << way.name << std::endl;
    press_against(way);
    shear(way);
  }
}
