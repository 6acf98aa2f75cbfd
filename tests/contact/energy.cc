// energy.csv against works and energies in closed form: springs, elastic and plastic bars, a released bar, friction.

#include "../cases.h"

#include "run/energy_audit.h"
#include "run/increment_loops.h"
#include "run/judge.h"
#include "run/strategy.h"

#include <deal.II/base/mpi.h>

#include <fstream>
#include <limits>
#include <map>

using namespace Cases;

namespace
{
  using Type = BoundaryConditionParameters::Type;
  using Row  = std::map<std::string, double>; ///< by the titles of the columns, without units

  std::vector<Row> run(Parameters p, const std::string &name, std::ostream &lines = log())
  {
    p.output.results_folder = "energy_results_" + name;
    p.output.write_vtu      = false;
    ContactProblem(p, world(), lines).run();
    MPI_Barrier(world());

    std::ifstream file(p.output.results_folder + "/energy.csv");
    const auto    cells = [](const std::string &line)
    {
      std::vector<std::string> all;
      std::istringstream       stream(line);
      for (std::string cell; std::getline(stream, cell, ',');)
        all.push_back(cell);
      return all;
    };
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> titles = cells(line);
    std::vector<Row>               rows;
    while (std::getline(file, line))
    {
      const std::vector<std::string> values = cells(line);
      rows.emplace_back();
      for (unsigned int i = 0; i < values.size(); ++i)
        rows.back()[titles[i].substr(0, titles[i].find(" ["))] = std::stod(values[i]);
    }
    return rows;
  }

  void compare(const std::string &what, const Row &row, const Row &expected, const double tolerance)
  {
    double scale = 0.;
    for (const auto &[title, value] : expected)
      scale = std::max(scale, std::abs(value));
    for (const auto &[title, value] : expected)
      check(what + ", " + title, row.at(title), value, tolerance, scale);
  }

  /// Two unit cubes on top of each other, E = 100, nu = 0, compressed by a tenth each: E/2 0.1^2 in each.
  Parameters pressed_cubes()
  {
    Parameters p;
    p.bodies              = {box("lower", "2,2,2", {0, 0, 0}, {1, 1, 1}, 100, 0.),
                             box("upper", "3,3,2", {0, 0, 1}, {1, 1, 2}, 100, 0.)};
    p.boundary_conditions = {
        hold("bottom", region(1, {z_minus}), {0, 1, 2}),
        condition("top", Type::displacement, region(2, {z_plus}), {0, 1, 2}, {"0", "0", "-0.2*t"})};
    p.contact_pairs           = {ContactPairParameters()};
    p.contact_pairs[0].slave  = region(2, {z_minus});
    p.contact_pairs[0].master = region(1, {z_plus});
    return p;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  {
    Parameters p    = pressed_cubes();
    p.load_stepping = {{1.}, {3}};
    compare("pressed cubes",
            run(p, "cubes").back(),
            {{"external work", 1.},
             {"stored energy", 1.},
             {"contact work", 0.},
             {"frictional dissipation", 0.},
             {"plastic dissipation", 0.},
             {"imbalance", 0.}},
            1e-7);
  }
  {
    // A unit cube, E = 100, nu = 0, on springs of stiffness 50, under the traction 10: 10^2/(2 50) + 10^2/(2 100).
    Parameters p;
    p.bodies              = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 100, 0.)};
    p.boundary_conditions = {hold("x", region(1, {x_minus}), {0}),
                             hold("y", region(1, {y_minus}), {1}),
                             condition("springs", Type::spring, region(1, {z_minus}), {2}, {"50"}),
                             condition("top", Type::traction, region(1, {z_plus}), {2}, {"-10*t"})};
    p.load_stepping       = {{1.}, {2}};
    compare(
        "springs", run(p, "springs").back(), {{"external work", 1.5}, {"stored energy", 1.5}, {"imbalance", 0.}}, 1e-7);
  }
  {
    // A bar, E = 200, stretched by a tenth and let go: what went in comes back.
    Parameters p;
    p.bodies                              = {box("bar", "2,1,1", {0, 0, 0}, {1, 1, 1}, 200, 0.3)};
    p.boundary_conditions                 = {hold("x", region(1, {x_minus}), {0}),
                                             hold("y", region(1, {y_minus}), {1}),
                                             hold("z", region(1, {z_minus}), {2}),
                                             drive("pull", region(1, {x_plus}), 0, "0.1*t")};
    p.boundary_conditions[3].active_until = 1.;
    p.load_stepping                       = {{1., 2.}, {2, 3}};
    const auto rows                       = run(p, "bar");
    compare("stretched bar", rows[1], {{"external work", 1.}, {"released work", 0.}, {"stored energy", 1.}}, 1e-7);
    compare("let go",
            rows.back(),
            {{"external work", 1.}, {"released work", -1.}, {"stored energy", 0.}, {"imbalance", 0.}},
            1e-7);
  }
  {
    // A metal bar, uniaxial logarithmic strain e: tau = E (e - a) = Y + H a, so that a = (E e - Y)/(E + H); plastic
    // work Y a + H a^2/2, stored tau^2/(2 E).
    const double E = 1000., Y = 10., H = 100., e = std::log(1.2), a = (E * e - Y) / (E + H), tau = Y + H * a;
    Parameters   p;
    p.bodies                               = {box("bar", "1,1,1", {0, 0, 0}, {1, 1, 1}, E, 0.3)};
    p.bodies[0].material.law               = MaterialParameters::Law::j2_plasticity;
    p.bodies[0].material.yield_stress      = Y;
    p.bodies[0].material.hardening_modulus = H;
    p.boundary_conditions                  = {hold("x", region(1, {x_minus}), {0}),
                                              hold("y", region(1, {y_minus}), {1}),
                                              hold("z", region(1, {z_minus}), {2}),
                                              drive("pull", region(1, {x_plus}), 0, "0.2*t")};
    const double plastic = Y * a + H * a * a / 2., stored = tau * tau / (2. * E);
    double       before = 0.;
    for (const unsigned int n : {10u, 20u})
    {
      p.load_stepping = {{1.}, {n}};
      const auto row  = run(p, "metal").back();
      if (n == 10)
      {
        compare("metal", row, {{"plastic dissipation", plastic}, {"stored energy", stored}}, 1e-7);
        before = row.at("imbalance");
      }
      else
        check_error(
            "twice the increments: imbalance over that before", std::abs(row.at("imbalance") / before), 1. / 3.);
      check("  external work", row.at("external work"), plastic + stored, n == 10 ? 2e-2 : 1e-2);
    }
  }
  {
    // A unit cube pressed with 2 on a rigid floor and dragged by 1, friction coefficient 0.3: 0.3 2 1.
    Parameters p;
    p.bodies              = {box("floor", "4,2,1", {-0.5, -0.5, -1}, {2.5, 1.5, 0}, 1e6, 0.),
                             box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1e6, 0.)};
    p.boundary_conditions = {hold("floor", region(1, {x_minus, x_plus, y_minus, y_plus, z_minus, z_plus}), {0, 1, 2}),
                             hold("guide", region(2, {y_minus, y_plus}, "z > 0.1"), {1}),
                             drive("drag", region(2, {x_minus, x_plus}, "z > 0.1"), 0, "max(0,t-1)"),
                             condition("weight", Type::traction, region(2, {z_plus}), {2}, {"-2*min(t,1)"})};
    p.contact_pairs       = {ContactPairParameters()};
    p.contact_pairs[0].slave                = region(2, {z_minus});
    p.contact_pairs[0].master               = region(1, {z_plus});
    p.contact_pairs[0].friction_coefficient = 0.3;
    p.load_stepping                         = {{1., 2.}, {1, 4}};
    // The force goes from zero to 0.6 within the first increment of the drag: its mean is half of what is dissipated.
    std::ostringstream lines;
    const auto         rows = run(p, "drag", lines);
    for (unsigned int n = 1; n < rows.size(); ++n)
    {
      const double s = 0.25 * n;
      compare("dragged by " + std::to_string(n) + "/4",
              rows[n],
              {{"external work", 0.6 * s - 0.075},
               {"frictional dissipation", 0.6 * s},
               {"contact work", 0.},
               {"imbalance", -0.075}},
              1e-4);
    }
    // The last line of the log says it once, and no increment warns of it.
    const std::string text = lines.str();
    const auto        at   = text.find("Energies: ");
    check("percent of the energies that the mean force misses",
          at == std::string::npos ? 0. : std::stod(text.substr(at + 10)), // printed on the root alone
          12.5,
          0.6,
          1.);
    check("no increment warns of energies", text.find("the bodies store") == std::string::npos);
  }
  {
    // A turned cube far above the other one moves as a whole: what round-off stores in it is not warned of.
    Parameters p                        = pressed_cubes();
    p.bodies[1]                         = box("upper", "3,3,2", {0, 0, 5}, {1, 1, 6}, 1e6, 0.3);
    p.bodies[1].material                = MaterialParameters(); // neo-Hookean
    p.bodies[1].material.youngs_modulus = 1e6;
    p.bodies[1].rotation_axis           = Vector3({1., 2., 3.});
    p.bodies[1].rotation_angle          = 20.;
    p.boundary_conditions[1].value      = {"3e-3*t", "-2e-3*t", "1e-3*t"};
    p.load_stepping                     = {{1.}, {2}};
    std::ostringstream lines;
    run(p, "apart", lines);
    check("a cube that moves as a whole is not warned of", lines.str().find("the bodies store") == std::string::npos);
  }
  {
    // An overlap of 0.2 that is pressed out: contact does the work that the cubes store.
    Parameters p                               = pressed_cubes();
    p.bodies[1]                                = box("upper", "3,3,2", {0, 0, 0.8}, {1, 1, 1.8}, 100, 0.);
    p.boundary_conditions[1].value             = {"0", "0", "0"};
    p.contact_pairs[0].start.overclosure       = ContactPairParameters::InitialOverclosure::interference;
    p.contact_pairs[0].start.overclosure_limit = 0.3;
    p.load_stepping                            = {{1.}, {3}};
    compare("pressed out",
            run(p, "fit").back(),
            {{"external work", 0.}, {"contact work", 1.}, {"stored energy", 1.}, {"imbalance", 0.}},
            1e-7);
  }
  {
    // A cube that dashpots alone hold, under the traction 1 from the beginning: they take what the load gives, but for
    // the first increment, at whose start the load counts as zero. They are gone at the end, and so is what is found.
    Parameters p             = pressed_cubes();
    p.bodies[1]              = box("upper", "3,3,2", {0, 0, 9}, {1, 1, 10}, 100, 0.);
    p.boundary_conditions[1] = condition("push", Type::traction, region(2, {z_plus}), {2}, {"-1"});
    p.boundary_conditions.push_back(hold("guide", region(2, {x_minus, x_plus, y_minus, y_plus}), {0, 1}));
    p.load_stepping                       = {{1.}, {5}};
    p.load_stepping.viscous_stabilisation = {1e-2};
    const auto rows                       = run(p, "dashpots");
    Row        change;
    for (const std::string title : {"external work", "stabilisation", "imbalance"})
      change[title] = rows[2].at(title) - rows[1].at(title);
    compare("held by dashpots, of the work in an increment",
            change,
            {{"stabilisation", change["external work"]}, {"imbalance", 0.}},
            1e-3);
  }
  {
    // The energy stored at the start is changed by half of what the two cubes store at the end, and to infinity.
    Parameters p            = pressed_cubes();
    p.output.results_folder = "changed";
    for (const double change : {0., 0.5, std::numeric_limits<double>::infinity()})
    {
      std::ostringstream lines;
      States             states;
      Journal            journal(p, world(), lines);
      Model              model(p, world(), states);
      Equilibrium        equilibrium(model, journal, states);
      LoadStepping       path(p.load_stepping);
      IncrementLoops     loops(model, journal, states, equilibrium, [] {});
      Strategy           strategy(model, journal, states, equilibrium, loops);
      EnergyAudit        audit(model, journal, states, equilibrium);
      Judge              judge(model, states, equilibrium);
      journal.tables = std::make_unique<Tables>(p.output.results_folder, world(), std::vector<std::string>());
      equilibrium.begin_on_mesh();
      model.begin_contact(states, 0.);
      equilibrium.begin_increment(path.at_hand());
      strategy.solve_increment();
      judge.judge();
      states.now.history = model.solid->reached();
      model.solid->start_from(states.now.history);
      states.now.energies.stored = change;
      try
      {
        audit.account(judge.inner_energy());
      }
      catch (const SolverFailure &failure)
      {
        report("stored energy at the start infinite", failure.what());
        continue;
      }
      const std::size_t at = lines.str().find("warning: the bodies");
      if (root())
        std::cout << "stored energy at the start changed by " << change << ": "
                  << (at == std::string::npos ? std::string("no warning")
                                              : lines.str().substr(at, lines.str().find(':', at + 9) - at))
                  << std::endl;
    }
  }
}
