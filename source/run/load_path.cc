#include "run/load_path.h"
#include "base/text.h"
#include "contact/second_pass.h"
#include "run/unheld_bodies.h"

#include <sstream>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Times that an increment is halved before the bodies are relaxed, where iterates are not stable.
    constexpr unsigned int patient_halvings = 2;
    /// Of the contact force: the log says nothing of smaller friction.
    constexpr double negligible_friction = 1e-3;
    /// Arc lengths that the last increment of an interval may be long.
    constexpr double largest_closing = 2.;
  } // namespace

  LoadPath::LoadPath(const RunParts &parts)
      : parts_(parts)
      , audit_(parts.model, parts.journal, parts.states, parts.equilibrium)
      , judge_(parts.model, parts.states, parts.equilibrium)
      , remarks_(parts.model, parts.states, parts.equilibrium, parts.journal.console, parts.path.increment() == 1)
      , first_(parts.path.increment())
  {
  }

  void LoadPath::follow(const std::function<void(unsigned int, double)> &callback)
  {
    LoadStepping      &path       = parts_.path;
    const auto        &adaptivity = parts_.model.parameters.adaptivity;
    const unsigned int interval   = parts_.model.parameters.output.checkpoint_interval;
    parts_.journal.console.begin_at(path.progress());
    begin_interval();
    while (!path.finished())
    {
      if (path.exhausted())
        throw SolverFailure(text(parts_.model.parameters.load_stepping.maximum_increments,
                                 " increments under arc length have not come to the end of the interval, t = ",
                                 path.interval_end(),
                                 " ('Load stepping/Maximum increments'). The last converged state is t = ",
                                 path.time()));
      if (!solve())
        continue;
      if (mesh_repetitions_ < adaptivity.repetitions && parts_.adaptation.adapt())
      {
        ++mesh_repetitions_;
        begin_on_surfaces();
        parts_.journal.console.remark("the increment is repeated on the new mesh");
        continue;
      }
      mesh_repetitions_            = 0;
      const unsigned int increment = path.increment();
      finish(callback);
      if (adaptivity.interval > 0 && increment % adaptivity.interval == 0 && !path.finished() &&
          parts_.adaptation.adapt())
      {
        begin_on_surfaces();
        restore_equilibrium();
      }
      if (interval > 0 && increment % interval == 0)
        parts_.checkpointing.write(path);
      begin_interval();
    }
    remarks_.of_path();
  }

  /// Contact pairs begin and cease to act between two intervals; checkpoints have the state before that.
  void LoadPath::begin_interval()
  {
    const LoadStepping &path = parts_.path;
    if (path.finished() || path.time() == 0. || !path.at_hand().begins_interval())
      return;
    parts_.model.set_conditions(path.target());
    for (const std::string &sentence : parts_.model.begin_contact(parts_.states, path.time()))
      parts_.journal.console.remark("warning: " + sentence);
  }

  /// @returns false where the increment at hand has failed, and been halved. @throws SolverFailure where it cannot be.
  bool LoadPath::solve()
  {
    LoadStepping   &path      = parts_.path;
    Journal        &journal   = parts_.journal;
    const Increment increment = path.at_hand();
    journal.console.begin_increment(
        increment.number, increment.begin, increment.end, increment.finds_time() ? increment.arc : 0.);
    journal.diagnosis.begin_increment(increment.number, increment.begin, increment.end);
    parts_.equilibrium.begin_increment(increment);
    try
    {
      if (relaxing_)
        parts_.strategy.relax_increment(unstable_);
      else
        parts_.strategy.solve_increment();
      relaxing_ = relaxed_ = false;
      check_closing();
      check_stabilised_motion(parts_.model, parts_.states);
      judge();
      return true;
    }
    catch (const SolverFailure &failure)
    {
      std::ostringstream reason;
      reason << "geometry pass " << journal.pass.geometry << ", threshold pass " << journal.pass.threshold
             << ", status pass " << journal.pass.status << ": " << failure.what();
      journal.diagnosis.end_attempt(failure.what());
      unstable_ = parts_.equilibrium.unstable();
      const bool may_shrink =
          !parts_.strategy.begins_singular() && failure.kind() != SolverFailure::Kind::prescribed_contact;
      const auto  held   = may_shrink ? pair_to_hold(failure.kind()) : std::nullopt;
      const bool  relax  = may_shrink && may_relax(failure.kind());
      const bool  halved = may_shrink && !relax && !held && try_smaller(failure.kind());
      std::string hint;
      if (!halved && !relax && !held)
        hint = report_failure({parts_.model,
                               parts_.journal,
                               parts_.states,
                               parts_.equilibrium,
                               parts_.results,
                               parts_.strategy.softest_motion()},
                              failure,
                              may_shrink);
      parts_.model.roll_back(parts_.states);
      if (!halved && !relax && !held)
        give_up(reason.str(), hint, may_shrink);
      journal.console.remark(reason.str() + (held                   ? hold_master(*held)
                                             : relax                ? "; the bodies are relaxed"
                                             : path.ends_interval() ? "; it is tried to end there"
                                                                    : "; the increment is halved"));
      relaxing_ = relax;
      relaxed_  = relaxed_ || relax;
      cut_backs_ += halved && !path.ends_interval();
      return false;
    }
  }

  /// Halves the increment at hand, which has failed, or ends it with the interval. @returns false where it cannot.
  bool LoadPath::try_smaller(const SolverFailure::Kind failure)
  {
    if (failure != SolverFailure::Kind::beyond_interval)
      return parts_.path.cut_back();
    parts_.path.close_interval();
    return true;
  }

  /// The pair, of those that may have a second pass, for whose depth the judge has refused the state; none otherwise.
  std::optional<unsigned int> LoadPath::pair_to_hold(const SolverFailure::Kind failure) const
  {
    const Model &model = parts_.model;
    if (failure != SolverFailure::Kind::judged || !model.parameters.strategy.uses(Remedy::second_pass))
      return {};
    for (const Measure measure : {Measure::penetration, Measure::unseen_depth})
      if (const Verdict::Finding &depth = parts_.journal.verdict[measure];
          !depth.holds() && depth.pair < model.parameters.contact_pairs.size() &&
          may_have_second_pass(model.parameters, model.contact->surfaces(), depth.pair))
        return depth.pair;
    return {};
  }

  /// A second pass of it. @returns what happens, for the log.
  std::string LoadPath::hold_master(const unsigned int pair)
  {
    Model &model = parts_.model;
    model.add_second_passes({{pair, judge_.clearance(pair)}}, parts_.states);
    parts_.equilibrium.begin_on_mesh();
    parts_.results.begin_on_mesh();
    begin_on_surfaces();
    ++second_passes_;
    ++parts_.journal.used[Remedy::second_pass];
    const ContactPairParameters &second = model.parameters.contact_pairs.back();
    return text("; from now on nodes of the master may not be deeper than ",
                second.second_pass->clearance,
                " (",
                second.name,
                "), and the increment is repeated");
  }

  /// The mesh or the contact pairs have changed.
  void LoadPath::begin_on_surfaces()
  {
    judge_.begin_on_mesh();
    parts_.strategy.begin_on_mesh();
  }

  /// An increment that ends where an interval under arc length does is given its time: the equilibrium that was found
  /// may be on another branch. @throws SolverFailure where it is farther away than the arc length.
  void LoadPath::check_closing() const
  {
    const Increment &increment = parts_.equilibrium.increment();
    if (increment.arc == 0. || increment.finds_time())
      return;
    const double motion = parts_.equilibrium.arc_length().motion();
    if (!(motion > 0. && motion <= largest_closing * increment.arc))
      throw SolverFailure(text("the equilibrium at the end of the interval is ",
                               motion,
                               " along the path, the arc length is ",
                               increment.arc,
                               ": it may be on another branch"),
                          SolverFailure::Kind::judged);
  }

  /// When no smaller increment is left, for there may be no equilibrium nearby: friction lets go, a column that leans
  /// on a wall turns about where it does. Where iterates are not stable, once before, after a few halvings.
  bool LoadPath::may_relax(const SolverFailure::Kind failure) const
  {
    using Kind = SolverFailure::Kind;
    const bool newton =
        failure == Kind::newton_stalled || failure == Kind::newton_lost || failure == Kind::newton_limit;
    const bool loop = failure == Kind::status_cycle || failure == Kind::geometry_cycle || failure == Kind::loop_limit;
    const bool last = !parts_.path.may_cut_back(), early = !relaxed_ && cut_backs_ >= patient_halvings;
    return !relaxing_ && parts_.strategy.may_relax() && (newton || loop) && (last || (unstable_ && early));
  }

  /// Nothing is committed that does not hold where it is measured anew. @throws SolverFailure
  void LoadPath::judge()
  {
    Journal       &journal = parts_.journal;
    const auto     timer   = journal.profile.time(Phase::judgement);
    const Verdict &verdict = journal.verdict = judge_.judge(parts_.strategy.geometry_rest());
    if (const Measure worst = verdict.worst();
        !verdict.holds() && (worst == Measure::held_depth || worst == Measure::held_slip))
      throw SolverFailure(
          "displacements of both sides of the contact are prescribed, so that no pressure and no friction "
          "can be found there: " +
              verdict.text(worst) +
              "; leave the displacements of one side free there, for example by prescribing them on "
              "another face of that body",
          SolverFailure::Kind::prescribed_contact);
    if (!verdict.holds())
      throw SolverFailure("the loops have converged, but the state does not hold where it is measured anew: " +
                              verdict.text(verdict.worst()),
                          SolverFailure::Kind::judged);
    journal.verdicts.merge(verdict);
    ++journal.judged;
  }

  /// The increment at hand has converged.
  void LoadPath::finish(const std::function<void(unsigned int, double)> &callback)
  {
    LoadStepping   &path      = parts_.path;
    Journal        &journal   = parts_.journal;
    const Increment increment = parts_.equilibrium.increment();
    remarks_.of_increment();
    commit();
    path.accept(journal.counts.newton,
                journal.counts.fallbacks == 0,
                {increment.end, parts_.equilibrium.arc_length().last_motion()});
    journal.counts.cut_backs                     = std::exchange(cut_backs_, 0);
    journal.counts.remedies[Remedy::second_pass] = std::exchange(second_passes_, 0);
    {
      const auto timer = journal.profile.time(Phase::output);
      parts_.results.update();
      parts_.results.write(increment, path.finished());
    }
    const std::vector<ContactResultants> &resultants = parts_.results.resultants();
    remarks_.note(resultants);
    if (increment.finds_time())
      journal.console.remark(text("t = ", increment.end));
    journal.console.end_increment(journal.counts, resultants, path.progress());
    if (callback)
      callback(increment.number, increment.end);
  }

  /// The state at hand becomes the one that the next increment starts from, which is also what a checkpoint holds.
  void LoadPath::commit()
  {
    State &now   = parts_.states.now;
    Model &model = parts_.model;
    now.history  = model.solid->reached();
    model.solid->start_from(now.history);
    audit_.account(judge_.inner_energy());
    if (!parts_.equilibrium.increment().on_new_mesh())
      parts_.equilibrium.keep_motion(!parts_.strategy.relaxed());
    model.contact->end_increment(parts_.equilibrium.increment().duration());
    model.rigid_bodies.end_increment(parts_.equilibrium.driven().applied());
    if (parts_.equilibrium.increment().ends_interval)
      now.reaction = parts_.equilibrium.reactions();
    parts_.states.committed = now;
  }

  /// The state on a new mesh goes on from equilibrium at the time that has been reached.
  void LoadPath::restore_equilibrium()
  {
    Model     &model  = parts_.model;
    State     &start  = parts_.states.committed;
    Status    &status = model.contact->status();
    const auto before = parts_.results.resultants();
    parts_.equilibrium.begin_increment(parts_.path.standstill());
    status.hold_friction(true);
    try
    {
      parts_.strategy.solve_increment();
      judge();
    }
    catch (const SolverFailure &failure)
    {
      parts_.journal.diagnosis.end_attempt(failure.what());
      model.roll_back(parts_.states);
      status.hold_friction(false);
      return parts_.journal.console.remark(std::string("no equilibrium on the new mesh: ") + failure.what() +
                                           "; the next increment goes on from the state as it was taken over");
    }
    // the forces that were taken over belong to the mesh before: they do no work
    start.applied = parts_.equilibrium.applied_forces();
    for (unsigned int s = 0; s < start.contact.force.size(); ++s)
      start.contact.force[s] = -model.contact->residual().jump[s];
    commit();
    status.hold_friction(false);
    parts_.results.update();
    say_what_changed(before);
  }

  void LoadPath::say_what_changed(const std::vector<ContactResultants> &before) const
  {
    const auto change = [](const Vector3 &force, const Vector3 &force_before)
    { return force_before.norm() > 0. ? 100. * (force - force_before).norm() / force_before.norm() : 0.; };
    const auto &now = parts_.results.resultants();
    for (unsigned int p = 0; p < now.size(); ++p)
    {
      std::ostringstream text;
      text.precision(3);
      text << "new mesh: the contact force of " << now[p].name << " changes by "
           << change(now[p].slave_force, before[p].slave_force) << " %";
      if (before[p].friction.norm() > negligible_friction * before[p].slave_force.norm())
        text << ", friction by " << change(now[p].friction, before[p].friction) << " %";
      parts_.journal.console.remark(text.str());
    }
  }

  /// The state is the last converged one. @p hint: where to read more. @p may_shrink: smaller increments might help.
  void LoadPath::give_up(const std::string &reason, const std::string &hint, const bool may_shrink)
  {
    const LoadStepping &path = parts_.path;
    parts_.journal.tables->add_failure();
    if (path.increment() > first_)
    {
      const auto timer = parts_.journal.profile.time(Phase::output);
      parts_.results.write_state(path.increment() - 1, path.time());
    }
    std::ostringstream message;
    const Increment    increment = path.at_hand();
    message << "increment " << increment.number;
    if (increment.finds_time())
      message << " (from t = " << increment.begin << ", arc length " << increment.arc << "), ";
    else
      message << " (t = " << increment.end << "), ";
    message << reason << ". The last converged state is t = " << path.time()
            << (path.increment() > 1 ? "" : " (no increment converged)");
    if (!may_shrink)
      message << ". Smaller increments do not change that, so the increment was not cut back";
    else if (parts_.model.parameters.load_stepping.cut_back)
      message << ". The increment was cut back to "
              << (increment.finds_time() ? increment.arc : increment.end - increment.begin);
    message << hint;
    throw SolverFailure(message.str());
  }
} // namespace Nodus
