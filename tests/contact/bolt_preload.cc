// The preload of bolts: tightened to a force, then locked at the length reached.
// - Bolt and sleeve as bars, all solvers and schemes: force, shortening, work; the service load that the bolt gets
//   a part of, and the one that takes the sleeve off.
// - The same turned to an oblique axis, with finite strains and meshes that do not match: closed form, all solvers.
// - Two bolts that are tightened one after the other: the first one slackens. The second one is there from
//   the start, or put in later.
// - Hanging nodes in the section, and a plane of symmetry through it.
// - An axis oblique to the section: equilibrium along it, quadratic convergence.
// - A mesh that is refined in both steps.
// - A bolt that nothing resists, and one whose section has nodes of another pair: named.
// On any number of ranks.

#include "../bolted_joint.h"
#include "driven_body.h"

using namespace BoltedJoint;

namespace
{
  using Solver = LinearSolverParameters::Type;
  using Scheme = ContactPairParameters::Scheme;

  const std::string folder = "bolt_preload_results";

  /// Values of all increments of the run.
  struct Step
  {
    double         t;
    PreloadSection section;
    Vector3        on_slave, on_sleeve;
  };
  std::vector<Step> steps_of(const Parameters &p)
  {
    ContactProblem    problem(p, world(), log());
    std::vector<Step> steps;
    problem.on_increment(
        [&](unsigned int, const double t)
        {
          steps.push_back({t,
                           problem.preload_sections()[0],
                           problem.contact_resultants()[section].slave_force,
                           problem.contact_resultants()[sleeve_on_head].slave_force});
        });
    problem.run();
    return steps;
  }

  /// Service loads of 30 and, so much that the sleeve comes off, 80.
  void check_bars(const Scheme scheme, const Solver solver)
  {
    Parameters p         = joint(folder, "30*max(t-1,0)");
    p.linear_solver.type = solver;
    for (ContactPairParameters &pair : p.contact_pairs)
      pair.scheme = scheme;
    if (scheme != Scheme::averaged) // their patch test
    {
      p.bodies[1].generator_arguments = box("", "2,2,2", {0, 0, 2}, {1, 1, 4}, 1, 0).generator_arguments;
      p.bodies[3].generator_arguments = box("", "12,8,1", {0, -1.5, 4}, {6, 2.5, 5}, 1, 0).generator_arguments;
      p.bodies[2].generator_arguments = box("", "8,8,3", {2, -1.5, 0}, {6, 2.5, 4}, 1, 0).generator_arguments;
    }
    check("bars, " + text_of(scheme) + ", " + text_of(solver), true);
    std::vector<Step> steps     = steps_of(p);
    const double      shortened = force / k_bolt + force / k_sleeve;
    const Step       &tightened = steps[1];
    check("  tightened: force", tightened.section.force, force, 1e-8);
    check("  on the slave side", tightened.on_slave[2], force, 1e-8);
    check("  on the sleeve", tightened.on_sleeve[2], -force, 1e-8);
    check("  shortened by", tightened.section.shortening, shortened, 1e-8);
    check("  locked: no", !tightened.section.locked);
    for (unsigned int i = 2; i < steps.size(); ++i)
    {
      const double load = 30. * (steps[i].t - 1.);
      check("  service load " + Numbers::plain(load) + ": force",
            steps[i].section.force,
            force + load * k_bolt / (k_bolt + k_sleeve),
            1e-8);
      check("  on the sleeve", -steps[i].on_sleeve[2], force - load * k_sleeve / (k_bolt + k_sleeve), 1e-8, force);
    }
    check("  still shortened by", steps.back().section.shortening, shortened, 1e-8);
    check("  locked", steps.back().section.locked);

    MPI_Barrier(world());
    const double work = 0.5 * force * shortened + 0.5 * 30. * 30. / (k_bolt + k_sleeve);
    check("  external work", last_energy(folder, "external work"), work, 1e-7);
    check("  is stored", last_energy(folder, "stored energy"), work, 1e-7);

    p.bodies[3].rigid_force[2] = "80*max(t-1,0)";
    steps                      = steps_of(p);
    for (const Step &step : steps)
      if (const double load = 80. * (step.t - 1.); load > 0.)
      {
        const bool together = load < force * (k_bolt + k_sleeve) / k_sleeve;
        check("  service load " + Numbers::plain(load) + (together ? "" : ", the sleeve is off") + ": force",
              step.section.force,
              together ? force + load * k_bolt / (k_bolt + k_sleeve) : load,
              1e-8);
      }
  }

  /// Stretch of a neo-Hookean bar without Poisson's ratio under a stress: E/2 (s - 1/s).
  double stretch(const double E, const double stress)
  {
    return stress / E + std::sqrt(stress * stress / (E * E) + 1.);
  }

  /// The head of @p p goes as far as bolt, sleeve and service load say; by bisection.
  double force_of_locked_bolt(const double shortened, const double load)
  {
    double low = 0., high = 500.;
    for (unsigned int i = 0; i < 200; ++i)
    {
      const double N                 = 0.5 * (low + high);
      const double height            = length * stretch(E_bolt, N) - shortened,
                   sleeve            = length * stretch(E_sleeve, (load - N) / 16.);
      (height > sleeve ? high : low) = N;
    }
    return low;
  }

  void check_turned(const Solver solver)
  {
    const Turn turn{Vector3({1., -2., 0.5}), 65.};
    Parameters p                     = joint(folder, "60*max(t-1,0)", turn);
    p.linear_solver.type             = solver;
    p.contact_pairs[0].preload.force = "80*min(t,1)";
    for (unsigned int b = 0; b < 3; ++b)
      p.bodies[b].material.law = MaterialParameters::Law::neo_hookean;
    const std::vector<Step> steps     = steps_of(p);
    const Vector3           axis      = turn.of(Vector3({0, 0, 1}));
    const double            shortened = length * (stretch(E_bolt, 80.) - stretch(E_sleeve, -80. / 16.));
    check("turned, finite strains, " + text_of(solver) + ": force", steps[1].section.force, 80., 1e-8);
    check("  on the slave side", steps[1].on_slave, 80. * axis, 1e-7);
    check("  across the axis", steps[1].section.shear.norm(), 0., 1e-7, 80.);
    check("  shortened by", steps[1].section.shortening, shortened, 1e-7);
    check("  under the service load: force", steps.back().section.force, force_of_locked_bolt(shortened, 60.), 1e-7);
    check("  still shortened by", steps.back().section.shortening, shortened, 1e-7);
  }

  void check_two(const bool later)
  {
    Parameters p = joint(folder, "0");
    p.bodies.push_back(box("second, lower half", "2,2,2", {7, 0, 0}, {8, 1, 1.5}, E_bolt, 0.));
    p.bodies.push_back(box("second, upper half", "2,3,2", {7, 0, 1.5}, {8, 1, 4}, E_bolt, 0.));
    p.bodies[3].generator_arguments = box("", "6,1,1", {0, -1.5, 4}, {8, 2.5, 5}, 1, 0).generator_arguments;
    p.boundary_conditions.push_back(hold("ground of the second", region(5, {z_minus}), {0, 1, 2}));
    // here the master side is the lower one
    p.contact_pairs.push_back(tied(region(6, {z_minus}), region(5, {z_plus})));
    p.contact_pairs.push_back(tied(region(6, {z_plus}), region(4, {z_minus})));
    p.contact_pairs[3].preload.force = "12*max(t-1,0)";
    p.contact_pairs[3].preload.axis  = Vector3({0., 0., 1.});
    if (later) // it is put in after the first one has been tightened, as long as the joint is then
    {
      p.contact_pairs[3].active_from               = 1.;
      p.contact_pairs[3].start.adjustment_distance = 0.2;
    }
    ContactProblem problem(p, world(), log());
    problem.run();
    const double head = -(force + k_bolt * force / k_sleeve + 12.) / (k_bolt + k_sleeve); // of the rigid head
    check(std::string("two bolts") + (later ? ", one put in later" : "") + ": force of the one that is locked",
          problem.preload_sections()[0].force,
          force + k_bolt * (head + force / k_sleeve),
          1e-8);
    check("  of the one that is tightened", problem.preload_sections()[1].force, 12., 1e-8);
    check("  it is shortened by",
          problem.preload_sections()[1].shortening,
          12. / k_bolt - head - (later ? force / k_sleeve : 0.),
          1e-8);
    check("  the head", problem.displacement(4, Point(8, 2.5, 5))[2], head, 1e-8);
    check_equal("  names", problem.preload_sections()[1].name == "pair 4", 1);
  }

  void check_hanging_nodes()
  {
    Parameters p                 = joint(folder, "30*max(t-1,0)");
    p.bodies[0].local_refinement = 1;
    p.bodies[0].refine_where     = "x<0.5";
    p.bodies[1].local_refinement = 1;
    p.bodies[1].refine_where     = "y>0.5";
    for (const unsigned int b : {1, 2})
      p.boundary_conditions.push_back(hold("symmetry " + std::to_string(b), region(b, {y_minus}), {1}));
    const std::vector<Step> steps = steps_of(p);
    check("hanging nodes, plane of symmetry: force", steps[1].section.force, force, 1e-8);
    check("  shortened by", steps[1].section.shortening, force / k_bolt + force / k_sleeve, 1e-8);
    check("  under the service load", steps.back().section.force, force + 30. * k_bolt / (k_bolt + k_sleeve), 1e-8);
  }

  void check_oblique()
  {
    Parameters p = joint(folder, "0");
    for (unsigned int b = 0; b < 3; ++b)
    {
      p.bodies[b].material.law            = MaterialParameters::Law::neo_hookean;
      p.bodies[b].material.poissons_ratio = 0.3;
    }
    const Vector3 axis         = Vector3({-0.3, 0.1, -1.});
    p.contact_pairs[0].preload = {"60*min(t,1)", 0., axis};
    p.load_stepping            = {{1.}, {2}};
    p.load_stepping.predictor  = false;
    const Step last            = steps_of(p).back();
    check("oblique axis: force along it", last.section.force, 60., 1e-8);
    check("  on the slave side", last.on_slave * (-1. / axis.norm() * axis), 60., 1e-8);
    check("  shear", (last.section.shear + 60. * (-1. / axis.norm() * axis)), last.on_slave, 1e-8);
    check("  quadratic", is_quadratic(folder));
  }

  void check_adapted()
  {
    Parameters p                 = joint(folder, "30*max(t-1,0)");
    p.adaptivity.interval        = 2;
    p.adaptivity.maximum_level   = 1;
    p.adaptivity.refine_fraction = 0.5;
    for (unsigned int b = 0; b < 2; ++b) // errors to refine for
      p.bodies[b].material.poissons_ratio = 0.3;
    const std::vector<Step> steps = steps_of(p);
    check("adapted: force", steps[1].section.force, force, 1e-8);
    check("  locked", steps[2].section.locked && steps[2].section.force > force);
    check("  still shortened by", steps.back().section.shortening, steps[2].section.shortening, 1e-8);
    check("  forces balance", steps.back().section.force + steps.back().on_sleeve[2], 30., 1e-7);
  }

  void expect_refusal(const std::string &name, const Parameters &p, const std::string &text)
  {
    std::string message;
    try
    {
      ContactProblem problem(p, world(), log());
      problem.run();
    }
    catch (const std::exception &error)
    {
      message = error.what();
    }
    const bool found = message.find(text) != std::string::npos;
    check(name + (found ? "" : " (" + message + ")"), found);
  }
} // namespace

int main(int argc, char *argv[])
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const Solver solver : {Solver::direct, Solver::condensed, Solver::block})
    check_bars(Scheme::averaged, solver);
  for (const Scheme scheme : {Scheme::nodal, Scheme::integration_point})
    check_bars(scheme, Solver::direct);
  for (const Solver solver : {Solver::direct, Solver::condensed, Solver::block})
    check_turned(solver);
  check_two(false);
  check_two(true);
  check_hanging_nodes();
  check_oblique();
  check_adapted();

  Parameters loose = joint(folder, "0");
  loose.contact_pairs.pop_back();
  expect_refusal("nothing resists: named", loose, "contact pair 1 (bolt) changes its length");
  Parameters shared                       = joint(folder, "0");
  shared.contact_pairs[2]                 = ContactPairParameters();
  shared.contact_pairs[2].slave           = region(3, {x_minus});
  shared.contact_pairs[2].master          = region(1, {x_plus});
  shared.contact_pairs[2].search_distance = 1.5;
  expect_refusal(
      "nodes of another pair: named",
      shared,
      "is on the slave side of the section of Contact pair 1 ('bolt'), which a preload moves; leave a row of "
      "faces between the two");
  return 0;
}
