#include "run/increment_loops.h"

#include <deal.II/base/utilities.h>

#include <sstream>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Newton iterations without progress after which a merged iteration is given up.
    constexpr unsigned int patience = 8;
    /// Geometry passes that change more than this fraction of the one before are mixed with those before it; with
    /// rigid bodies that forces drive, those that change more than the second are damped.
    constexpr double plain_contraction = 0.3, slow_contraction = 0.9;
    /// Times that a geometry loop may come back to the pass before the last.
    constexpr unsigned int tolerated_geometry_cycles = 2;
    /// Sites whose statuses cycle may contradict them by this much, of the largest pressure or of the cone.
    constexpr double tolerated_violation = 1e-3;
  } // namespace

  IncrementLoops::IncrementLoops(
      Model &model, Journal &journal, States &states, Equilibrium &equilibrium, std::function<void()> heed_signals)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , equilibrium_(equilibrium)
      , heed_signals_(std::move(heed_signals))
  {
  }

  void IncrementLoops::solve(const bool first_iterate)
  {
    const MergedLoops &merged  = equilibrium_.merged();
    ContactInterface  &contact = *model_.contact;
    equilibrium_.begin_loops();
    const Newton newton(model_.parameters.newton, merged.any() ? patience : 0);

    FixedPointLoop geometry("geometry", model_.parameters.geometry_loop);
    AndersonMixing mixing;
    geometry_cycles_ = 0;
    do
    {
      pair();
      FixedPointLoop     threshold("threshold", model_.parameters.threshold_loop);
      SecantAcceleration secant(model_.communicator);
      do
      {
        {
          const auto timer = journal_.profile.time(Phase::status);
          if (!merged.threshold && threshold.counter() == 0)
            contact.freeze_threshold(equilibrium_.increment().duration());
          contact.status().begin_loop(merged.status);
        }
        FixedPointLoop statuses("status", model_.parameters.status_loop);
        do
        {
          journal_.pass.geometry  = geometry.counter() + 1;
          journal_.pass.threshold = threshold.counter() + 1;
          journal_.pass.status    = statuses.counter() + 1;
          iterate(newton);
        } while (!statuses_converged(statuses));
      } while (!threshold_converged(threshold, secant));
    } while (!geometry_converged(geometry, mixing, merged.geometry || first_iterate));
    if (!merged.status)
      check_frozen_statuses();
  }

  /// Newton's method, the innermost loop.
  void IncrementLoops::iterate(const Newton &newton)
  {
    newton.solve(equilibrium_,
                 [&](const unsigned int iteration, const NewtonProblem::Norms &norms, const unsigned int krylov)
                 {
                   IterationCounts &pass = journal_.pass, &counts = journal_.counts;
                   journal_.console.newton_iteration(pass, iteration, norms, krylov);
                   pass.fallbacks                    = counts.fallbacks;
                   const Increment        &increment = equilibrium_.increment();
                   const Tables::Iteration row{increment.number, increment.end, pass, iteration, norms, krylov};
                   journal_.tables->add(row);
                   journal_.diagnosis.add(row);
                   heed_signals_();
                   counts.newton += iteration > 0;
                   counts.krylov += krylov;
                   journal_.profile.newton_iterations += iteration > 0;
                   journal_.profile.krylov_iterations += krylov;
                 });
  }

  void IncrementLoops::pair()
  {
    paired_before_ = paired_;
    paired_        = states_.now.unknowns.block(0);
    rigid_paired_  = states_.now.rigid;
    equilibrium_.pair();
  }

  void IncrementLoops::note_pass(const FixedPointLoop &loop, const double value, const std::string &worst)
  {
    journal_.diagnosis.add(Diagnosis::Pass{loop.name(), loop.counter() + 1, value, loop.tolerance(), worst});
  }

  bool IncrementLoops::statuses_converged(FixedPointLoop &loop)
  {
    ++journal_.counts.status;
    if (equilibrium_.merged().status)
      return true;
    const Equilibrium::StatusChanges update = equilibrium_.update_statuses();
    journal_.tables->add_status_changes(update.changes);
    note_pass(loop, update.changes, update.first);
    if (update.frozen > 0)
      journal_.console.remark("the statuses cycle: " + std::to_string(update.frozen) +
                              " sites keep the one that they contradict least: " + equilibrium_.cycling());
    return loop.finished(update.changes, update.first);
  }

  /// Once all loops have converged: thresholds that are not final leave nodes neither open nor closed.
  void IncrementLoops::check_frozen_statuses()
  {
    const Status::Violation violation = model_.contact->frozen_violation();
    if (violation.sites == 0)
      return;
    const std::string  locus = model_.contact->locus(violation.site);
    std::ostringstream text;
    text << violation.sites << " sites whose statuses cycled contradict them, the worst by " << violation.value
         << " of the largest pressure or of the cone, at " << locus;
    if (violation.value > tolerated_violation)
      throw SolverFailure("the status loop cycles: " + text.str() + ", more than " +
                              dealii::Utilities::to_string(tolerated_violation),
                          SolverFailure::Kind::status_cycle);
    journal_.console.remark("warning: " + text.str());
  }

  bool IncrementLoops::threshold_converged(FixedPointLoop &loop, SecantAcceleration &secant)
  {
    ++journal_.counts.threshold;
    if (equilibrium_.merged().threshold)
      return true;
    ContactInterface &contact = *model_.contact;
    if (!contact.has_friction())
      return loop.finished(0., "");
    const auto timer = journal_.profile.time(Phase::status);
    contact.update_slip_rates(equilibrium_.increment().duration());
    Status                   &status   = contact.status();
    const std::vector<double> pressure = contact.pressure();
    const Status::Change      change   = status.threshold_change(pressure);
    const std::string         worst    = contact.locus(change.site);
    std::vector<double>       next     = secant.next(status.thresholds(), status.thresholds_at(pressure));
    std::ostringstream        text;
    text << "threshold changes by " << change.value << ", most at " << worst;
    if (secant.contraction() > 0.)
      text << ", " << secant.contraction() << " times the change before";
    journal_.console.remark(text.str());
    note_pass(loop, change.value, worst);
    if (loop.finished(change.value, worst))
      return true;
    status.freeze(std::move(next));
    return false;
  }

  /// Eqs. L1 and L4.
  bool IncrementLoops::geometry_converged(FixedPointLoop &loop, AndersonMixing &mixing, const bool once)
  {
    ++journal_.counts.geometry;
    if (once)
      return true;
    const auto              timer   = journal_.profile.time(Phase::pairing);
    const ContactInterface &contact = *model_.contact;
    Vector                 &u       = states_.now.unknowns.block(0);
    std::string             worst;
    const double            change = contact.largest_difference(u, paired_, &worst);
    const double            step   = contact.largest_difference(paired_, states_.committed.unknowns.block(0));
    const double            value  = change <= 1e-12 * model_.length_scale ? 0. : step > 0. ? change / step : 1.;

    std::ostringstream text;
    text << "geometry changes by " << value << " of the step, most at " << worst;
    journal_.console.remark(text.str());
    note_pass(loop, value, worst);
    const double before = loop.value();
    if (loop.finished(value, worst))
      return true;

    // The solution of two passes ago again, while it differs from that of the last one: a 2-cycle; one that comes back
    // is no fixed point.
    const bool cycle = loop.counter() >= 3 && contact.largest_difference(u, paired_before_) <= 1e-6 * change;
    if (cycle && ++geometry_cycles_ > tolerated_geometry_cycles)
      throw SolverFailure(
          "the geometry loop cycles with period 2, criterion " + std::to_string(value) + ", worst at " + worst +
              ": a slave node crosses an edge of the faceted master and back; try 'Normal = averaged' or "
              "smaller increments",
          SolverFailure::Kind::geometry_cycle);
    if (model_.rigid_bodies.size() == 0)
    {
      Vector correction(u);
      correction -= paired_;
      const bool mix = loop.counter() >= 3 && value > plain_contraction * before;
      u              = mixing.next(correction, mix);
      u += paired_;
      if (mix)
      {
        journal_.console.remark("the geometry loop is slow: the next pass starts where the last ones lead to");
        model_.contact->gather(states_.now.unknowns, states_.committed.unknowns.block(0));
      }
    }
    else if (cycle || (loop.counter() >= 3 && value > slow_contraction * before))
    {
      journal_.console.remark(cycle ? "the geometry loop cycles with period 2: the next pass starts half-way"
                                    : "the geometry loop does not contract: the next pass starts half-way");
      start_half_way();
    }
    return false;
  }

  /// The next geometry pass starts in the middle between the last pairing and its solution, rigid bodies too.
  void IncrementLoops::start_half_way()
  {
    Vector &u = states_.now.unknowns.block(0);
    u.sadd(0.5, 0.5, paired_);
    for (unsigned int b = 0; b < rigid_paired_.size(); ++b)
    {
      RigidBodies::State &now = states_.now.rigid[b];
      now.translation         = 0.5 * (now.translation + rigid_paired_[b].translation);
      now.turn                = 0.5 * (now.turn + rigid_paired_[b].turn);
    }
    model_.rigid_bodies.move(u);
    model_.contact->gather(states_.now.unknowns, states_.committed.unknowns.block(0));
  }
} // namespace Nodus
