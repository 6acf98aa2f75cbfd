#include "run/increment_loops.h"
#include "base/text.h"
#include "contact/loci.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Newton iterations without progress after which it is given up.
    constexpr unsigned int patience = 8;
    /// Of a Newton step into inverted cells.
    constexpr unsigned int maximum_halvings = 5;
    /// Passes whose change is more than this fraction of the one before are mixed with those before them; those of the
    /// geometry from the fourth on.
    constexpr double       geometry_contraction = 0.3, threshold_contraction = 0.7;
    constexpr unsigned int plain_geometry_passes = 3;
    /// Of the translation of a rigid body among the displacements that are mixed.
    constexpr double rigid_weight = 1e-6;
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

  double IncrementLoops::tolerated_rest(const double tolerance)
  {
    return std::max(tolerance, std::min(100. * tolerance, 1e-3));
  }

  void IncrementLoops::solve()
  {
    const MergedLoops &merged  = equilibrium_.merged();
    ContactInterface  &contact = *model_.contact;
    equilibrium_.begin_loops();
    const Newton newton(model_.parameters.newton, patience, uses(Remedy::shorter_step) ? maximum_halvings : 0);

    FixedPointLoop geometry("geometry", model_.parameters.geometry_loop);
    AndersonMixing mixing(model_.communicator);
    geometry_cycles_ = 0;
    rest_            = 0.;
    do
    {
      pair();
      FixedPointLoop threshold("threshold", model_.parameters.threshold_loop);
      AndersonMixing threshold_mixing(model_.communicator);
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
      } while (!threshold_converged(threshold, threshold_mixing));
    } while (!geometry_converged(geometry, mixing));
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
                   corrections_ += iteration > 0;
                   if (iteration == 0 && pass.threshold == 1 && pass.status == 1)
                     renewed_ = std::max(norms.force, norms.contact);
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
    corrections_   = 0;
    equilibrium_.pair();
    statuses_ = model_.contact->status().code();
  }

  /// Than this pass began with, on any rank.
  bool IncrementLoops::has_other_statuses() const
  {
    const std::vector<char> now   = model_.contact->status().code();
    unsigned int            other = 0;
    for (unsigned int s = 0; s < now.size(); ++s)
      other += model_.contact->surfaces().is_owned(s) && now[s] != statuses_[s];
    return dealii::Utilities::MPI::max(other, model_.communicator) > 0;
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
                              " sites keep the one that they have: " + equilibrium_.cycling());
    return loop.finished(update.changes, update.first);
  }

  /// Once all loops have converged: thresholds that are not final leave nodes neither open nor closed.
  void IncrementLoops::check_frozen_statuses()
  {
    const Status::Violation violation = model_.contact->frozen_violation();
    if (violation.sites == 0)
      return;
    const std::string locus = model_.contact->locus(violation.site);
    const std::string what  = text(violation.sites,
                                  " sites whose statuses cycled contradict them, the worst by ",
                                  violation.value,
                                  " of the largest pressure or of the cone, at ",
                                  locus);
    if (violation.value > tolerated_violation)
      throw SolverFailure(text("the status loop cycles: ", what, ", more than ", tolerated_violation),
                          SolverFailure::Kind::status_cycle);
    journal_.console.remark("warning: " + what);
  }

  bool IncrementLoops::threshold_converged(FixedPointLoop &loop, AndersonMixing &mixing)
  {
    ++journal_.counts.threshold;
    if (equilibrium_.merged().threshold)
      return true;
    ContactInterface &contact = *model_.contact;
    if (!contact.has_friction())
      return loop.finished(0., "");
    const auto                timer    = journal_.profile.time(Phase::status);
    const Status             &status   = contact.status();
    const Status::Change      change   = contact.threshold_change(equilibrium_.increment().duration());
    const std::vector<double> pressure = contact.pressure();
    const std::string         worst    = contact.locus(change.site);
    const auto                owned    = [&](const std::vector<double> &values)
    {
      std::vector<double> result;
      for (unsigned int s = 0; s < values.size(); ++s)
        if (contact.surfaces().is_owned(s))
          result.push_back(values[s]);
      return result;
    };
    std::vector<double> next = status.thresholds_at(pressure);
    mixing.add(owned(status.thresholds()), owned(next));
    journal_.console.remark(
        text("threshold changes by ", change.value, ", most at ", worst) +
        (mixing.contraction() > 0. ? text(", ", mixing.contraction(), " times the change before") : ""));
    note_pass(loop, change.value, worst);
    if (loop.finished(change.value, worst))
      return true;
    if (mixing.contraction() > threshold_contraction && uses(Remedy::mixed_thresholds))
    {
      journal_.count(Remedy::mixed_thresholds);
      const std::vector<double> mixed = mixing.mixed();
      auto                      value = mixed.begin();
      for (unsigned int s = 0; s < next.size(); ++s)
        if (contact.surfaces().is_owned(s))
          next[s] = *value++;
    }
    contact.freeze_thresholds(std::move(next));
    return false;
  }

  /// Eqs. L1 and L3.
  bool IncrementLoops::geometry_converged(FixedPointLoop &loop, AndersonMixing &mixing)
  {
    ++journal_.counts.geometry;
    if (equilibrium_.merged().geometry || model_.parameters.geometry_loop.mode == LoopParameters::Mode::once)
      return true;
    const auto             timer    = journal_.profile.time(Phase::pairing);
    const ContactSurfaces &surfaces = model_.contact->surfaces();
    Vector                &u        = states_.now.unknowns.block(0);
    std::string            worst;
    const double           change = largest_difference(surfaces, u, paired_, &worst);
    // what the solution of the pass before leaves out of balance with the geometry that it leads to; that of this pass
    // may be far from it where statuses have changed
    const bool   first = loop.counter() == 0, other = has_other_statuses();
    const double value = corrections_ == 0 ? 0. : first || other ? std::max(1., renewed_) : renewed_;

    journal_.console.remark(
        first
            ? "geometry: of the last increment so far; it changes most at " + worst
            : text("geometry: renewed, the last pass left ", renewed_, " out of balance; it changes most at ", worst) +
                  (other ? ", and statuses change" : ""));
    note_pass(loop, value, worst);
    const double before = loop.value();
    const bool   last   = loop.counter() + 1 >= model_.parameters.geometry_loop.maximum_passes;
    if (last && value > loop.tolerance() && value <= tolerated_rest(loop.tolerance()))
    {
      rest_ = value;
      journal_.console.remark(text("warning: the geometry loop ends with forces and contact laws off by ", value));
      return true;
    }
    if (loop.finished(value, worst))
      return true;

    // The solution of two passes ago again, while it differs from that of the last one: a 2-cycle; one that comes back
    // is no fixed point.
    const bool cycle = loop.counter() >= 3 && largest_difference(surfaces, u, paired_before_) <= 1e-6 * change;
    if (cycle && ++geometry_cycles_ > tolerated_geometry_cycles)
      throw SolverFailure(
          text("the geometry loop cycles with period 2, criterion ", value, ", worst at ", worst) +
              ": a slave node crosses an edge of the faceted master and back; try 'Normal = averaged' or "
              "smaller increments",
          SolverFailure::Kind::geometry_cycle);
    mixing.add(geometry_values(paired_, rigid_paired_), geometry_values(u, states_.now.rigid));
    if (loop.counter() >= plain_geometry_passes && value > geometry_contraction * before &&
        uses(Remedy::mixed_geometry))
    {
      journal_.console.remark("the geometry loop is slow: the next pass starts where the last ones lead to");
      journal_.count(Remedy::mixed_geometry);
      start_from_mixed(mixing);
    }
    return false;
  }

  /// What a pass of the geometry loop changes: displacements, and the motions of the driven rigid bodies. The latter
  /// weigh next to nothing, for the displacements of the bodies' nodes stand for them.
  std::vector<double> IncrementLoops::geometry_values(const Vector                          &u,
                                                      const std::vector<RigidBodies::State> &rigid) const
  {
    std::vector<double> values;
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      values.push_back(u(i));
    for (const RigidBodies::State &body : rigid)
      for (unsigned int d = 0; d < dim; ++d)
      {
        values.push_back(rigid_weight * body.translation[d]);
        values.push_back(model_.length_scale * body.turn[d]);
      }
    return values;
  }

  /// The next geometry pass starts where the last ones lead to, rigid bodies too.
  void IncrementLoops::start_from_mixed(const AndersonMixing &mixing)
  {
    const std::vector<double> values = mixing.mixed();
    auto                      value  = values.begin();
    Vector                   &u      = states_.now.unknowns.block(0);
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      u(i) = *value++;
    u.compress(dealii::VectorOperation::insert);
    for (RigidBodies::State &body : states_.now.rigid)
      for (unsigned int d = 0; d < dim; ++d)
      {
        body.translation[d] = *value++ / rigid_weight;
        body.turn[d]        = *value++ / model_.length_scale;
      }
    model_.rigid_bodies.move(u);
    model_.contact->gather(states_.now.unknowns, states_.committed.unknowns.block(0));
  }

  bool IncrementLoops::uses(const Remedy remedy) const
  {
    return model_.parameters.strategy.uses(remedy);
  }
} // namespace Nodus
