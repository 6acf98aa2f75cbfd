// Limit points of load and of prescribed displacement, passed under arc length: closed forms of homogeneous states, and
// bars that force presses through, whose states displacement control finds again.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>

using namespace Cases;
using Type    = BoundaryConditionParameters::Type;
using Control = LoadSteppingParameters::Control;

namespace
{
  /// Times after the increments of a run, what was seen then, and how the run ended: empty at the end of its path.
  struct Path
  {
    std::vector<double> times, values;
    std::string         end;
    unsigned int        most_iterations = 0; ///< of Newton's method in an increment under arc length

    unsigned int size() const
    {
      return times.size();
    }
    /// Increments in which time went back.
    unsigned int n_back() const
    {
      unsigned int n = 0;
      for (unsigned int i = 1; i < size(); ++i)
        n += times[i] < times[i - 1];
      return n;
    }
  };

  Path follow(const Parameters &p, const std::function<double(ContactProblem &)> &see)
  {
    ContactProblem problem(p, world(), log());
    Path           path;
    problem.on_increment(
        [&](const unsigned int increment, const double t)
        {
          path.times.push_back(t);
          path.values.push_back(see(problem));
          if (increment > 1)
            path.most_iterations = std::max(path.most_iterations, problem.iterations().newton);
        });
    try
    {
      problem.run();
    }
    catch (const SolverFailure &failure)
    {
      path.end = failure.what();
    }
    return path;
  }

  Parameters under_arc_length(const double arc_length, const unsigned int maximum_increments)
  {
    Parameters p;
    p.load_stepping.control            = {Control::arc_length};
    p.load_stepping.arc_length         = arc_length;
    p.load_stepping.maximum_increments = maximum_increments;
    p.output.results_folder            = "arc_length_results";
    p.output.vtu_interval              = 0;
    return p;
  }

  /// A unit cube of unit modulus that is held sideways, of the law of St. Venant and Kirchhoff: it bears
  /// lambda(lambda^2 - 1)/2 at the height lambda, which is least at 1/sqrt(3).
  void add_soft_block(Parameters &p)
  {
    p.bodies.push_back(box("block", "1,1,1", {0, 0, 0}, {1, 1, 1}, 1., 0.));
    p.bodies[0].material.law = MaterialParameters::Law::st_venant_kirchhoff;
    p.boundary_conditions.push_back(hold("bottom", region(1, {y_minus}), {1}));
    p.boundary_conditions.push_back(hold("sides", region(0, {x_minus, x_plus, y_minus, y_plus}), {0, 2}));
  }
  double borne(const double height)
  {
    return 0.5 * height * (1. - height * height);
  }

  double largest_deviation(const Path &path, const std::function<double(double)> &time)
  {
    double deviation = 0.;
    for (unsigned int i = 0; i < path.size(); ++i)
      deviation = std::max(deviation, std::abs(path.times[i] - time(path.values[i])));
    return deviation;
  }

  double height(ContactProblem &problem)
  {
    return 1. + problem.displacement(1, Point(0, 1, 0))[1];
  }

  /// The load, dead, has to go back where the block softens.
  void press_soft_block()
  {
    Parameters p = under_arc_length(0.05, 16);
    add_soft_block(p);
    p.boundary_conditions.push_back(condition("load", Type::traction, region(1, {y_plus}), {1}, {"-t"}));
    p.load_stepping.interval_ends = {0.2};
    p.load_stepping.increments    = {10};
    const Path path               = follow(p, height);
    report("a block that softens under a load", std::to_string(path.size()) + " increments");
    check("  load: off the closed form to 1e-9", largest_deviation(path, borne) < 1e-9);
    check("  least height", path.values.back(), 0.23, 0.05);
    check_equal("  increments in which the load goes back", path.n_back(), 7);
    check("  then", path.end.find("16 increments under arc length") != std::string::npos);
  }

  /// On top of it an elastic block that is softer than the other one softens, pressed down at its upper end: the
  /// displacement of that has to go back. The blocks are in contact.
  void press_two_blocks(const bool merged, const LinearSolverParameters::Type solver)
  {
    constexpr double stiffness = 0.125;
    Parameters       p         = under_arc_length(0.05, 16);
    add_soft_block(p);
    p.bodies.push_back(box("spring", "1,1,1", {0, 1, 0}, {1, 2, 1}, stiffness, 0.));
    p.contact_pairs = {pair(region(1, {y_plus}), region(2, {y_minus}))};
    p.boundary_conditions.push_back(drive("press", region(2, {y_plus}), 1, "-t"));
    p.load_stepping.interval_ends = {3.};
    p.load_stepping.increments    = {15};
    p.linear_solver.type          = solver;
    if (!merged)
      use_loops(p);
    const Path path = follow(p, height);
    report("and under an elastic block, " + std::string(merged ? "merged" : "three") + " loops, " + text_of(solver),
           std::to_string(path.size()) + " increments");
    const bool direct =
        solver == LinearSolverParameters::Type::direct; // others end at the tolerance of Newton's method
    check("  displacement: off the closed form to " + std::string(direct ? "1e-9" : "2e-8"),
          largest_deviation(path, [&](const double h) { return 1. - h + borne(h) / stiffness; }) <
              (direct ? 1e-9 : 2e-8));
    check_equal("  increments in which it goes back", path.n_back(), 5);
    check_count("  Newton iterations, most", path.most_iterations, 2);
  }
  /// A bar that rises from a clamp at its left end to the middle of an arch.
  Parameters bar(const double rise)
  {
    Parameters p               = under_arc_length(0.12, 100);
    p.degree                   = 2;
    p.bodies                   = {box("bar", "6,1,1", {0, 0, 0}, {10, 0.5, 1}, 1000., 0.3)};
    p.bodies[0].material.law   = MaterialParameters::Law::st_venant_kirchhoff;
    p.bodies[0].rotation_axis  = Vector3({0, 0, 1});
    p.bodies[0].rotation_angle = std::asin(rise / 10.) * 180. / dealii::numbers::PI;
    p.boundary_conditions      = {hold("clamp", region(1, {x_minus}), {0, 1, 2})};
    return p;
  }

  /// The rigid body @p press goes down: force finds the way through the limit points, and given displacements find the
  /// same equilibria.
  void check_press(const std::string &what, Parameters p, const unsigned int press, const double force)
  {
    const unsigned int number = press - 1;
    BodyParameters    &body   = p.bodies[number];
    body.rigid_free           = {1};
    body.rigid_force          = {"0", "-" + std::to_string(force) + "*t", "0"};
    const Path driven = follow(p, [](ContactProblem &problem) { return -problem.rigid_bodies()[0].translation[1]; });
    report(what, driven.end.empty() ? "to the end of the path" : driven.end);

    body.rigid_free               = {};
    body.rigid_force              = {"0", "0", "0"};
    body.motion.translation[1]    = "-t";
    p.load_stepping.interval_ends = {1.};
    const Path moved              = follow(p, [](ContactProblem &) { return 0.; });
    check("  its motion is given: to the end of the path", moved.end.empty());
    check_count("    Newton iterations, most", moved.most_iterations, 4);
    p.load_stepping               = LoadSteppingParameters();
    p.load_stepping.interval_ends = driven.values;
    p.load_stepping.increments.assign(driven.size(), 1);
    p.load_stepping.cut_back = false;
    p.strategy.without       = {"relaxation"}; // states that are not stable are asked for
    const Path given         = follow(p,
                              [&](ContactProblem &problem)
                              {
                                const auto &reactions = problem.reactions();
                                return -reactions.back().second[1] / force;
                              });
    check_equal("  states that displacements find again", given.size(), driven.size());
    double difference = 0.;
    for (unsigned int i = 0; i < given.size(); ++i)
      difference = std::max(difference, std::abs(given.values[i] - driven.times[i]));
    check("  forces: the same to 1e-8", difference < 1e-8);
    check("  the force goes back five times or more, and on", driven.n_back() >= 5 && driven.times.back() == 1.);
  }

  /// A rigid block that is tied to the upper end of the bar, until the force is @p end. The limit is 0.192: where the
  /// end is a little above that, it must not be met on the other branch.
  void press_tied_bar(const double end)
  {
    Parameters p = bar(1.2);
    p.bodies.push_back(box("press", "1,1,1", {10, 0, 0}, {10.5, 0.5, 1}, 0., 0.));
    p.bodies[1].rigid              = true;
    p.bodies[1].rotation_axis      = p.bodies[0].rotation_axis;
    p.bodies[1].rotation_angle     = p.bodies[0].rotation_angle;
    p.contact_pairs                = {pair(region(1, {x_plus}), region(2, {x_minus}))};
    p.contact_pairs[0].contact_law = ContactPairParameters::ContactLaw::tied;
    p.load_stepping.increments     = {20};
    check_press("a bar that snaps through, to " + Numbers::plain(end), p, 2, end);
  }

  /// A rigid cylinder on half of an arch, with friction; the limit is 0.212.
  void press_arch(const double end)
  {
    Parameters p = bar(1.2);
    p.boundary_conditions.push_back(hold("middle", region(1, {x_plus}), {0}));
    p.boundary_conditions.push_back(hold("plane strain", region(1, {z_minus, z_plus}), {2}));
    BodyParameters cylinder;
    cylinder.name  = "press";
    cylinder.rigid = true;
    p.bodies.push_back(cylinder);
    const double          angle = p.bodies[0].rotation_angle * dealii::numbers::PI / 180., radius = 2.;
    const Point           top(10. * std::cos(angle) - 0.5 * std::sin(angle), 1.2 + 0.5 * std::cos(angle), 0.5);
    ContactPairParameters contact = pair(region(1, {y_plus}), RegionParameters(), 0.3);
    contact.master.bodies         = {2};
    contact.scheme                = ContactPairParameters::Scheme::averaged;
    contact.master_surface.shape  = MasterSurfaceParameters::Shape::cylinder;
    contact.master_surface.radius = radius;
    contact.master_surface.axis   = Vector3({0, 0, 1});
    contact.master_surface.point  = top + Vector3({-1., radius - 0.1 - 0.01, 0});
    p.contact_pairs               = {contact};
    p.load_stepping.increments    = {20};
    check_press(
        "half of an arch that a rigid cylinder presses through with friction, to " + Numbers::plain(end), p, 2, end);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  press_soft_block();
  for (const auto solver : {LinearSolverParameters::Type::direct, LinearSolverParameters::Type::condensed})
    press_two_blocks(true, solver);
  press_two_blocks(false, LinearSolverParameters::Type::direct);
  press_tied_bar(1.);
  press_tied_bar(0.194);
  press_arch(1.);
  press_arch(0.213);
}
