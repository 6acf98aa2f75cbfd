#include "parameters/parameter_keys.h"
#include "parameters/plugin_keys.h"
#include <nodus/base/remedy.h>
#include <nodus/parameters/parameters.h>
#include <nodus/plugins/error_indicator.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <limits>

// Keys of how a case is solved: loops, Newton, linear solver, strategy, load stepping, adaptive meshes.

namespace Nodus
{
  namespace
  {
    using namespace ParameterKeys;

    /// Beyond these what has 'converged' says nothing: with a force tolerance of 1 no load need be carried at all.
    constexpr double largest_newton_tolerance = 1e-3, largest_loop_tolerance = 0.01, largest_linear_tolerance = 0.01;

    Patterns::Double at_most(const double limit)
    {
      return Patterns::Double(std::numeric_limits<double>::min(), limit);
    }

    const Names<LoopParameters::Mode> mode_names          = {{LoopParameters::Mode::fixed_point, "fixed point"},
                                                             {LoopParameters::Mode::newton, "newton"}};
    const Names<LoopParameters::Mode> geometry_mode_names = {{LoopParameters::Mode::fixed_point, "fixed point"},
                                                             {LoopParameters::Mode::newton, "newton"},
                                                             {LoopParameters::Mode::once, "once"}};

    const Names<LinearSolverParameters::Type> solver_names = {{LinearSolverParameters::Type::automatic, "automatic"},
                                                              {LinearSolverParameters::Type::direct, "direct"},
                                                              {LinearSolverParameters::Type::block, "block"},
                                                              {LinearSolverParameters::Type::condensed, "condensed"}};

    const Names<LinearSolverParameters::Preconditioner> preconditioner_names = {
        {LinearSolverParameters::Preconditioner::nodus, "nodus"},
        {LinearSolverParameters::Preconditioner::ml, "ML"},
        {LinearSolverParameters::Preconditioner::muelu, "MueLu"}};

    const Names<LoadSteppingParameters::Control> control_names = {
        {LoadSteppingParameters::Control::time, "time"}, {LoadSteppingParameters::Control::arc_length, "arc length"}};

    const Names<AdaptivityParameters::Indicator> indicator_names = {
        {AdaptivityParameters::Indicator::stress_and_contact, "stress and contact"}};

    const Names<AdaptivityParameters::Marking> marking_names = {
        {AdaptivityParameters::Marking::fixed_fraction, "fixed fraction"},
        {AdaptivityParameters::Marking::target_error, "target error"}};

    void add(ParameterHandler                  &prm,
             LoopParameters                    &loop,
             const std::string                 &mode,
             const std::string                 &tolerance,
             const Names<LoopParameters::Mode> &names = mode_names)
    {
      const bool may_be_once = names.size() > mode_names.size();
      add_choice(prm,
                 "Mode",
                 loop.mode,
                 names,
                 "fixed point: a loop around Newton's method; newton: " + mode +
                     " in each Newton iteration, with loops as the fallback where that stalls" +
                     (may_be_once
                          ? "; once: as the increment begins, for displacements that are small against the faces"
                          : "") +
                     " [-].");
      prm.add_parameter("Maximum passes", loop.maximum_passes, "Passes before the increment is cut [-].", at_least_one);
      if (!tolerance.empty())
        prm.add_parameter("Tolerance", loop.tolerance, tolerance, at_most(largest_loop_tolerance));
    }

    void add(ParameterHandler &prm, NewtonParameters &newton)
    {
      prm.add_parameter(
          "Maximum iterations", newton.maximum_iterations, "Iterations before the increment is cut [-].", at_least_one);
      prm.add_parameter("Force tolerance",
                        newton.force_tolerance,
                        "Largest nodal force out of balance relative to the largest nodal force [-].",
                        at_most(largest_newton_tolerance));
      prm.add_parameter("Contact tolerance",
                        newton.contact_tolerance,
                        "Gap and slip relative to the displacement of the step, friction law absolute [-].",
                        at_most(largest_newton_tolerance));
      prm.add_parameter("Line search",
                        newton.line_search,
                        "Shorten every correction that increases the residual [-]; without, this is done where no "
                        "status changes and the iterates get no better.");
      prm.add_parameter("Largest forcing term",
                        newton.largest_forcing_term,
                        "Relative accuracy of corrections by an iterative linear solver far from the solution; near it "
                        "they become as accurate as Newton's method can use. With 0 all have the tolerance of the "
                        "linear solver [-].",
                        Patterns::Double(0., 0.1));
    }

    void add(ParameterHandler &prm, LinearSolverParameters &solver)
    {
      add_choice(
          prm,
          "Type",
          solver.type,
          solver_names,
          "Linear solver [-]: direct is MUMPS; condensed eliminates multipliers and held slave displacements and "
          "needs conjugate gradients with algebraic multigrid (large models); block is GMRES on all unknowns, "
          "for what cannot be condensed: integration points and consistent weights. automatic takes direct up to "
          "1500 displacements, from 150000 on condensed, or block where that is needed, and between them whichever "
          "costs less.");
      prm.add_parameter("Tolerance",
                        solver.tolerance,
                        "Block and condensed solver: least relative residual; corrections that Newton goes on from "
                        "need not reach it [-].",
                        at_most(largest_linear_tolerance));
      prm.add_parameter("Maximum iterations",
                        solver.maximum_iterations,
                        "Block and condensed solver: iterations before they give up [-].",
                        at_least_one);
      prm.add_parameter("Augmentation factor",
                        solver.augmentation_factor,
                        "Block solver: weight of the constraints in units of the diagonal of the stiffness [-].",
                        not_negative);
      add_choice(prm,
                 "Preconditioner",
                 solver.preconditioner,
                 preconditioner_names,
                 "Block and condensed solver: algebraic multigrid on the displacements [-]: nodus's own, or that of "
                 "Trilinos, where nodus was built with it: ML on Epetra matrices, MueLu on Tpetra matrices. Answers "
                 "are the same; what each costs is in contrib/studies/scaling/preconditioners.md.");
    }

    void add(ParameterHandler &prm, StrategyParameters &strategy)
    {
      std::string names;
      for (const char *name : remedy_names)
        names += (names.empty() ? "" : "|") + std::string(name);
      prm.add_parameter("Without",
                        strategy.without,
                        "What is not tried where something fails, for studies of what each is good for (see "
                        "architecture.md) [-]; contact.csv counts how often each was used.",
                        Patterns::List(Patterns::Selection(names), 0, remedy_names.size(), ","));
    }

    /// What finds the time of the increments, and what that needs.
    void add_control(ParameterHandler &prm, LoadSteppingParameters &load)
    {
      std::string controls;
      for (const auto control : load.control)
        controls += (controls.empty() ? "" : ", ") + text_of(control, control_names);
      prm.declare_entry("Control",
                        controls,
                        Patterns::List(Patterns::Selection(selection(control_names)), 1, 1000000, ","),
                        "What an increment is given [-], for all intervals or for each: time, or arc length, a motion "
                        "along that of the increment before. Then the time t of all loads and prescribed motions is "
                        "found with the equilibrium: it goes back beyond limit points, where bodies snap through or "
                        "back, and equilibria that are not stable are followed. The first increment of an interval is "
                        "given the time that Increments says; the interval ends where t comes to its end.");
      prm.add_action("Control",
                     [&load](const std::string &text)
                     {
                       load.control.clear();
                       for (const auto &name : dealii::Utilities::split_string_list(text, ','))
                         load.control.push_back(value_of(name, control_names));
                     });
      prm.add_parameter("Arc length",
                        load.arc_length,
                        "Under arc length: how far the node that moves most goes in an increment, as long as the "
                        "motion stays the same [length]; 0: as far as in the first increment of the interval. Where "
                        "increments fail it is halved, up to 1/64, and it grows back after easy ones.",
                        not_negative);
      prm.add_parameter("Maximum increments",
                        load.maximum_increments,
                        "Under arc length: increments of an interval after which a run is given up [-].",
                        at_least_one);
    }

    void add(ParameterHandler &prm, LoadSteppingParameters &load)
    {
      const unsigned int many = std::numeric_limits<unsigned int>::max();
      prm.add_parameter("Interval ends",
                        load.interval_ends,
                        "Increasing times at which the intervals end [-]; the first interval starts at 0.",
                        Patterns::List(not_negative, 1, many, ","));
      prm.add_parameter("Increments",
                        load.increments,
                        "Number of equal increments of each interval [-], unless they fail or grow.",
                        Patterns::List(Patterns::Integer(1, 1000000), 1, many, ","));
      prm.add_parameter(
          "Predictor",
          load.predictor,
          "Whether an increment starts where the motion of the last one leads, from the second of each "
          "interval on [-]. It saves iterations where the path is smooth and bodies yield or slide; where "
          "Newton's method fails from there, it starts from the last state.");
      prm.add_parameter("Cut back",
                        load.cut_back,
                        "Whether an increment that fails is halved and tried again [-]. After an easy one (see Easy "
                        "iterations) increments grow back; the times that Increments asks for are met all the same.");
      prm.add_parameter("Minimum increment",
                        load.minimum_increment,
                        "Increment of time below which a run is given up [-]; 0: 1/64 of what Increments asks for.",
                        not_negative);
      prm.add_parameter("Maximum increment",
                        load.maximum_increment,
                        "Increment of time up to which easy increments grow, beyond what Increments asks for [-]; the "
                        "ends of the intervals are met all the same. 0: no such growth.",
                        not_negative);
      prm.add_parameter("Easy iterations",
                        load.easy_iterations,
                        "An increment with at most so many Newton iterations, and no fallback, is "
                        "easy: the next one may be twice as large [-].",
                        count);
      prm.add_parameter("Viscous stabilisation",
                        load.viscous_stabilisation,
                        "Dashpots at all nodes for bodies that nothing holds before contact closes, relative to the "
                        "stiffness of the body, e.g. 1e-2; one for all intervals, or one for each: 0 for those that "
                        "begin with closed "
                        "contact. They fade in the course of each interval and are reported [-].",
                        Patterns::List(not_negative, 1, std::numeric_limits<unsigned int>::max(), ","));
      add_control(prm, load);
    }

    void add(ParameterHandler &prm, AdaptivityParameters &adaptivity)
    {
      const Patterns::Double fraction(0., 1.);
      prm.add_parameter("Interval",
                        adaptivity.interval,
                        "Increments between two refinements of the mesh [-]; 0: the mesh stays as it is.",
                        count);
      prm.add_parameter("Initial cycles",
                        adaptivity.initial_cycles,
                        "Refinements before the first increment, of the cells on both sides of gaps up to Contact "
                        "distance [-].",
                        count);
      prm.add_parameter("Contact distance",
                        adaptivity.contact_distance,
                        "Gap that is expected to close [length]; 0: the mean slave face size of the pair.",
                        not_negative);
      prm.add_parameter("Repetitions",
                        adaptivity.repetitions,
                        "Times that an increment is repeated on the refined mesh, until no cell is to be refined [-].",
                        count);
      add_choice(prm,
                 "Indicator",
                 adaptivity.indicator,
                 indicator_names,
                 AdaptivityParameters::Indicator::own,
                 adaptivity.own_indicator,
                 "What says where the mesh is to be finer [-]. stress and contact: the estimated error of the stress, "
                 "and the contact terms.");
      prm.add_parameter(
          "Bulk weight",
          adaptivity.bulk_weight,
          "Weight, in the indicator of the error, of the difference between the stress and the one recovered at the "
          "nodes [-].",
          not_negative);
      prm.add_parameter("Contact weight",
                        adaptivity.contact_weight,
                        "Weight of the contact terms in it: the jump between the contact traction and the stress below "
                        "it, gaps and penetrations between the nodes, ends of the contact and of the stick zone [-].",
                        not_negative);
      add_choice(prm,
                 "Marking",
                 adaptivity.marking,
                 marking_names,
                 "fixed fraction: the cells with the largest errors that hold Refine fraction of the squared error are "
                 "refined, those with the smallest that hold Coarsen fraction coarsened; target error: cells above "
                 "their equal share of Target error are refined, those far below coarsened [-].");
      prm.add_parameter("Refine fraction",
                        adaptivity.refine_fraction,
                        "Part of the squared error in the cells that are refined [-].",
                        fraction);
      prm.add_parameter("Coarsen fraction",
                        adaptivity.coarsen_fraction,
                        "Part of the squared error in the cells that are coarsened [-].",
                        fraction);
      prm.add_parameter("Target error",
                        adaptivity.target_error,
                        "Estimated error of the stress relative to the stress, in the norm of the energy [-]; of an "
                        "indicator of one's own, the root of the sum of its squares [as it says].",
                        positive);
      prm.add_parameter(
          "Maximum level", adaptivity.maximum_level, "Refinements of a cell beyond those of its body [-].", count);
      prm.add_parameter("Maximum unknowns",
                        adaptivity.maximum_unknowns,
                        "Displacement degrees of freedom that refinement stops at [-].",
                        positive);
      prm.add_parameter(
          "Slave at least as fine",
          adaptivity.slave_at_least_as_fine,
          "Whether slave faces are refined until they are no larger than the master faces they face [-].");
    }

    template <typename Struct, typename... Arguments>
    void add_subsection(ParameterHandler &prm, const std::string &name, Struct &parameters, const Arguments &...more)
    {
      prm.enter_subsection(name);
      add(prm, parameters, more...);
      prm.leave_subsection();
    }
  } // namespace

  void ParameterKeys::add_solution(ParameterHandler &prm, Parameters &parameters)
  {
    add_subsection(
        prm,
        "Geometry loop",
        parameters.geometry_loop,
        "projections, normals and areas are renewed and linearised",
        "Out of balance where the geometry is that of the last solution: nodal forces relative to the largest, gap "
        "and slip relative to the displacement of the step, friction law absolute [-].",
        geometry_mode_names);
    add_subsection(prm,
                   "Threshold loop",
                   parameters.threshold_loop,
                   "the friction threshold follows the pressure and is linearised",
                   "Change of the contact pressure, relative [-].");
    // no tolerance: no status may change
    add_subsection(prm, "Status loop", parameters.status_loop, "statuses are tested and changed", "");
    add_subsection(prm, "Newton", parameters.newton);
    add_subsection(prm, "Linear solver", parameters.linear_solver);
    add_subsection(prm, "Strategy", parameters.strategy);
    add_subsection(prm, "Load stepping", parameters.load_stepping);
    add_subsection(prm, "Adaptivity", parameters.adaptivity);
  }

  bool StrategyParameters::uses(const Remedy remedy) const
  {
    return std::find(without.begin(), without.end(), remedy_names[static_cast<unsigned int>(remedy)]) == without.end();
  }

  double LoadSteppingParameters::stabilisation(const unsigned int interval) const
  {
    return viscous_stabilisation[std::min<std::size_t>(interval, viscous_stabilisation.size() - 1)];
  }

  bool LoadSteppingParameters::is_stabilised() const
  {
    return *std::max_element(viscous_stabilisation.begin(), viscous_stabilisation.end()) > 0.;
  }

  bool LoadSteppingParameters::has_arc_length(const unsigned int interval) const
  {
    return control[std::min<std::size_t>(interval, control.size() - 1)] == Control::arc_length;
  }

  bool LoadSteppingParameters::has_arc_length() const
  {
    return std::find(control.begin(), control.end(), Control::arc_length) != control.end();
  }

  std::string text_of(const LoopParameters::Mode mode)
  {
    return text_of(mode, geometry_mode_names);
  }

  std::string text_of(const LinearSolverParameters::Type type)
  {
    return text_of(type, solver_names);
  }

  std::string text_of(const LinearSolverParameters::Preconditioner preconditioner)
  {
    return text_of(preconditioner, preconditioner_names);
  }
} // namespace Nodus
