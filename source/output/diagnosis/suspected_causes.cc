#include "output/diagnosis/suspected_causes.h"

#include <algorithm>
#include <cmath>

// From numbers to causes: one function for each cause.

namespace Nodus
{
  namespace
  {
    /// A slave node that moves by more than this part of a face in an increment meets other faces in each iteration.
    constexpr double large_step = 0.5;
    /// Relative force residuals below this that do not fall any more are round-off of a badly conditioned system.
    constexpr double noise_floor = 1e-6;
    /// More passes or iterations than this are not worth while.
    constexpr unsigned int most_passes = 200;
  } // namespace

  namespace Suspects
  {
    std::string joined(const std::vector<double> &values)
    {
      std::string list;
      for (const double value : values)
        list += (list.empty() ? "" : ", ") + text(value);
      return list;
    }

    std::string in_pair(const unsigned int pair, const std::string &key)
    {
      return "Contact pair " + std::to_string(pair + 1) + '/' + key;
    }

    std::string pair_name(const Parameters &parameters, const unsigned int pair)
    {
      return text("contact pair ", pair + 1, " (", parameters.contact_pairs[pair].name, ')');
    }

    std::string body_name(const Parameters &parameters, const unsigned int body)
    {
      const std::string &name = parameters.bodies[body].name;
      return text("body ", body + 1, name.empty() ? "" : " (" + name + ')');
    }

    /// Geometric mean of the ratios of the last few values; 1 for fewer than two.
    double contraction(const std::vector<double> &values)
    {
      const std::size_t n = std::min<std::size_t>(values.size(), 5);
      if (n < 2 || values.back() <= 0. || values[values.size() - n] <= 0.)
        return 1.;
      return std::pow(values.back() / values[values.size() - n], 1. / (n - 1));
    }

    std::vector<double> last_of(const std::vector<double> &values, const std::size_t n)
    {
      return {values.end() - std::min(n, values.size()), values.end()};
    }

    std::size_t interval_of(const LoadSteppingParameters &load, const History &history)
    {
      const auto end = std::find_if(load.interval_ends.begin(),
                                    load.interval_ends.end(),
                                    [&](const double t) { return history.end <= t * (1. + 1e-12); });
      return std::min<std::size_t>(end - load.interval_ends.begin(), load.increments.size() - 1);
    }

    void add_smaller_increments(const Parameters &parameters, const History &history, SuspectedCause &cause)
    {
      const LoadSteppingParameters &load = parameters.load_stepping;
      if (!load.cut_back)
        cause.changes.push_back(
            {"Load stepping/Cut back", "false", "true", "an increment that fails is tried again in halves"});
      else
        cause.changes.push_back({"Load stepping/Minimum increment",
                                 load.minimum_increment > 0. ? text(load.minimum_increment) : "0 (automatic)",
                                 text((history.end - history.begin) / 16.),
                                 text("increments may become smaller than ", history.end - history.begin)});
      auto more = load.increments;
      more[interval_of(load, history)] *= 4;
      cause.changes.push_back(
          {"Load stepping/Increments", as_list(load.increments), as_list(more), "smaller increments from the start"});
    }

    void add_line_search(const Parameters &parameters, SuspectedCause &cause)
    {
      if (!parameters.newton.line_search)
        cause.changes.push_back(
            {"Newton/Line search", "false", "true", "corrections that increase the residual are shortened"});
    }

    void add_own_gaps(const Parameters &parameters, const unsigned int pair, SuspectedCause &cause)
    {
      using Pair       = ContactPairParameters;
      const Pair &keys = parameters.contact_pairs[pair];
      if (keys.scheme == Pair::Scheme::integration_point)
        cause.changes.push_back({in_pair(pair, "Scheme"),
                                 text_of(keys.scheme),
                                 "averaged",
                                 "a node has one gap and one pressure; points of a face share pressures, and what is "
                                 "right for one may be wrong for its neighbours"});
      else if (keys.scheme == Pair::Scheme::nodal && keys.weights == Pair::Weights::consistent)
        cause.changes.push_back({in_pair(pair, "Weights"),
                                 "consistent",
                                 "nodal quadrature",
                                 "a node has a gap of its own; consistent weights mix it with those of its neighbours, "
                                 "and what is right for one may be wrong for these"});
    }

    void add_newton_mode(const std::string &loop, const LoopParameters &parameters, SuspectedCause &cause)
    {
      if (parameters.mode == Mode::fixed_point)
        cause.changes.push_back(
            {loop + "/Mode", "fixed point", "newton", "the derivative takes the place of the fixed point iteration"});
    }

    void add_more_passes(const std::string &key,
                         const unsigned int now,
                         const double       rate,
                         const double       residual,
                         const double       tolerance,
                         SuspectedCause    &cause)
    {
      if (!(rate < no_contraction && residual > tolerance))
        return;
      const double more = std::ceil(std::log(tolerance / residual) / std::log(rate));
      if (now + more <= most_passes)
        cause.changes.push_back({key,
                                 text(now),
                                 text(now + std::max(5., more + 2.)),
                                 text("at a factor of ", rate, " each, ", more, " more are needed")});
    }
  } // namespace Suspects

  using namespace Suspects;

  namespace
  {
    void
    add_partners(const Parameters &parameters, const History &history, const FailureEvidence &evidence, Causes &causes)
    {
      for (unsigned int p = 0; p < evidence.pairs.size(); ++p)
      {
        const auto &pair = evidence.pairs[p];
        const auto &keys = parameters.contact_pairs[p];
        if (pair.lost == 0 && (pair.unpaired < pair.sites || pair.sites == 0))
          continue;
        SuspectedCause cause{
            pair.lost > 0 ? "slave nodes lost the master surface" : "the master is out of the search distance", {}, {}};
        cause.evidence.push_back(text(pair_name(parameters, p),
                                      ": ",
                                      pair.unpaired,
                                      " of ",
                                      pair.sites,
                                      " sites have no master point",
                                      keys.has_rigid_master() ? std::string() : text(" within ", pair.reach)));
        if (pair.lost > 0)
          cause.evidence.push_back(text(pair.lost,
                                        " of them were closed when the increment began, the first at (",
                                        pair.lost_X,
                                        "): they slid off the master or went through it"));
        const bool triangles = keys.master_surface.shape == MasterSurfaceParameters::Shape::triangles;
        if (triangles)
          cause.evidence.push_back("the triangles of " + keys.master_surface.file +
                                   " face away from the slave, which 'Master cavity' changes, or end at a rim");
        else if (keys.has_rigid_master())
          cause.evidence.push_back("the rigid " + text_of(keys.master_surface.shape) +
                                   " has no end: its body is on the other side of the slave, or beyond its centre");
        else
          cause.changes.push_back({in_pair(p, "Search distance"),
                                   keys.search_distance > 0. ? text(keys.search_distance) : "0 (automatic)",
                                   text(4. * pair.reach),
                                   "master points farther away are found"});
        if (pair.lost > 0 && (triangles || !keys.has_rigid_master()))
          cause.changes.push_back({in_pair(p, "Projection tolerance"),
                                   text(keys.projection_tolerance),
                                   text(std::max(0.5, 2. * keys.projection_tolerance)),
                                   "nodes may hang over the rim of the master that far (in faces)"});
        add_smaller_increments(parameters, history, cause);
        causes.push_back(cause);
      }
    }

    void add_distorted_cells(const Parameters      &parameters,
                             const History         &history,
                             const FailureEvidence &evidence,
                             Causes                &causes)
    {
      const auto    &cell = evidence.worst_cell;
      SuspectedCause cause{
          evidence.inverted_cells > 0 ? "cells are turned inside out" : "cells are strongly distorted", {}, {}};
      cause.evidence.push_back(text(evidence.inverted_cells,
                                    " cells with det F <= 0, ",
                                    evidence.distorted_cells,
                                    " with det F < ",
                                    Diagnosis::distorted,
                                    "; the smallest, ",
                                    cell.det_F,
                                    ", in the cell of ",
                                    body_name(parameters, cell.body),
                                    " centred at (",
                                    cell.X,
                                    "), now at (",
                                    cell.x,
                                    ')'));
      double motion = 0.;
      for (const auto &pair : evidence.pairs)
        motion = std::max({motion, pair.sliding, pair.penetration});
      if (!evidence.pairs.empty())
        cause.evidence.push_back(text("the contact surfaces move against each other by up to ",
                                      motion,
                                      " faces in the increment",
                                      motion > large_step ? ": the increment is too large" : ""));
      add_smaller_increments(parameters, history, cause);
      add_line_search(parameters, cause);
      const auto &body = parameters.bodies[cell.body];
      if (body.material.poissons_ratio > 0.49 &&
          body.volumetric_treatment == BodyParameters::VolumetricTreatment::standard)
        cause.changes.push_back({text("Body ", cell.body + 1, "/Volumetric treatment"),
                                 "standard",
                                 "mean dilatation",
                                 text("Poisson's ratio ", body.material.poissons_ratio, " locks standard cells")});
      cause.changes.push_back({text("Body ", cell.body + 1, "/Global refinement"),
                               text(body.global_refinement),
                               text(body.global_refinement + 1),
                               "smaller cells, if it is the mesh that cannot follow (or mesh that place anew)"});
      causes.push_back(cause);
    }

    void add_linear_solver(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes)
    {
      using Type            = LinearSolverParameters::Type;
      const auto    &solver = parameters.linear_solver;
      SuspectedCause cause{"the linear solver did not succeed", {evidence.message}, {}};
      if (evidence.linear_solver != Type::direct)
      {
        cause.changes.push_back({"Linear solver/Type",
                                 text_of(solver.type),
                                 "direct",
                                 "tells a singular system (and where) from a slow iteration"});
        cause.changes.push_back({"Linear solver/Maximum iterations",
                                 text(solver.maximum_iterations),
                                 text(4 * solver.maximum_iterations),
                                 "if the residual was still falling"});
      }
      else
        cause.changes.push_back({"Linear solver/Type", text_of(solver.type), "condensed", "needs less memory"});
      causes.push_back(cause);
    }

    void
    add_newton(const Parameters &parameters, const History &history, const FailureEvidence &evidence, Causes &causes)
    {
      std::vector<double> force, residual;
      for (const auto &i : history.iterations)
      {
        if (i.iteration == 0)
        {
          force.clear(); // another solution
          residual.clear();
        }
        force.push_back(i.norms.force);
        // until prescribed displacements are met, the force says nothing about progress
        if (i.norms.prescribed <= parameters.newton.contact_tolerance)
          residual.push_back(std::max(i.norms.force / parameters.newton.force_tolerance,
                                      i.norms.contact / parameters.newton.contact_tolerance));
      }
      const double rate   = contraction(residual);
      const bool   floor  = !force.empty() && force.back() < noise_floor && rate >= no_contraction;
      double       motion = 0.;
      for (const auto &pair : evidence.pairs)
        motion = std::max({motion, pair.sliding, pair.penetration});

      SuspectedCause cause{evidence.kind == Kind::not_finite ? "Newton's method met numbers that are not finite"
                           : rate < no_contraction           ? "Newton's method converges, but not in time"
                           : floor ? "Newton's method cannot meet its tolerance in these digits"
                                   : "Newton's method diverges or wanders: the increment is too large for it",
                           {},
                           {}};
      cause.evidence.push_back("relative force residual in the last iterations: " + joined(last_of(force, 6)));
      cause.evidence.push_back(text("each iteration multiplies the residual by ", rate));
      if (!evidence.pairs.empty())
        cause.evidence.push_back(
            text("the contact surfaces move against each other by up to ", motion, " faces in the increment"));
      if (evidence.worst_cell.det_F < 1.)
        cause.evidence.push_back(text("smallest det F ", evidence.worst_cell.det_F));
      add_more_passes("Newton/Maximum iterations",
                      parameters.newton.maximum_iterations,
                      rate,
                      residual.empty() ? 0. : residual.back(),
                      1.,
                      cause);
      if (floor)
        cause.changes.push_back({"Newton/Force tolerance",
                                 text(parameters.newton.force_tolerance),
                                 text(10. * force.back()),
                                 "what the conditioning of this system allows"});
      add_smaller_increments(parameters, history, cause);
      add_line_search(parameters, cause);
      causes.push_back(cause);
    }
  } // namespace

  std::vector<SuspectedCause>
  suspected_causes(const Parameters &parameters, const Diagnosis::History &history, const FailureEvidence &evidence)
  {
    Causes            causes;
    const Kind        kind       = evidence.kind;
    const std::string loop       = history.passes.empty() ? "" : history.passes.back().loop;
    const bool        in_a_loop  = kind == Kind::loop_limit || kind == Kind::geometry_cycle;
    const bool        statuses   = kind == Kind::status_cycle || (kind == Kind::loop_limit && loop == "status");
    bool              chattering = false; // statuses still changed when it ended
    for (std::size_t i = history.iterations.size() - std::min<std::size_t>(3, history.iterations.size());
         i < history.iterations.size();
         ++i)
      chattering = chattering || history.iterations[i].norms.changes > 0;

    // What the failure says itself, then what explains a failure of that kind, then the iteration as such.
    if (kind == Kind::prescribed_contact)
      add_prescribed_contact(parameters, evidence, causes);
    if (kind == Kind::judged)
    {
      add_coarse_slave(parameters, evidence, causes);
      add_edge_between_nodes(parameters, evidence, causes);
    }
    if (kind == Kind::over_constraint)
      add_over_constraint(parameters, evidence, causes);
    if (evidence.unstable && kind != Kind::free_body && kind != Kind::inverted_cell)
      add_instability(parameters, history, evidence, causes);
    if (kind == Kind::free_body || (!evidence.free_motions.empty() && !in_a_loop && !statuses))
      add_free_body(parameters, history, evidence, causes);
    if (in_a_loop || statuses || kind == Kind::judged || kind == Kind::newton_limit || kind == Kind::newton_stalled ||
        kind == Kind::newton_lost)
      add_stiff_slave(parameters, evidence, causes);
    if (statuses)
      add_status_cycle(parameters, history, evidence, causes);
    if (kind == Kind::loop_limit && loop == "threshold")
      add_threshold_loop(parameters, history, causes);
    if (kind == Kind::geometry_cycle || (kind == Kind::loop_limit && loop == "geometry"))
      add_geometry_loop(parameters, history, evidence, causes);
    if (kind == Kind::linear_solver)
      add_linear_solver(parameters, evidence, causes);
    if (kind == Kind::inverted_cell)
      add_distorted_cells(parameters, history, evidence, causes);
    add_partners(parameters, history, evidence, causes);
    if (kind != Kind::inverted_cell && evidence.worst_cell.det_F < Diagnosis::distorted)
      add_distorted_cells(parameters, history, evidence, causes);
    if (!history.threshold_passes.empty())
      add_threshold_loop(parameters, history, causes);
    // loops that end in a state that is no equilibrium do so where statuses contradict each other
    if (!statuses && !in_a_loop && (chattering || (kind == Kind::judged && evidence.n_changed_sites > 0)))
      add_status_cycle(parameters, history, evidence, causes);
    if (kind == Kind::newton_limit || kind == Kind::newton_stalled || kind == Kind::newton_lost ||
        kind == Kind::not_finite || causes.empty())
      add_newton(parameters, history, evidence, causes);
    return causes;
  }
} // namespace Nodus
