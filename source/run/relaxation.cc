#include "run/relaxation.h"
#include "base/text.h"
#include "parallel/largest.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int max_steps = 200;
    /// Rates of the dashpots: of the first step from where nothing is known, and where it is given up.
    constexpr double first_rate = 1e-2, largest_rate = 1e8, smallest_rate = 1e-8;
    /// Steps that may fail where nothing but that no equilibrium was found speaks for a way out.
    constexpr unsigned int max_failures = 8;
    /// Factors on the rate after a step that failed, and that led to a state which is stable without dashpots.
    constexpr double harder = 4., softest = 0.1, gentle = 0.8;
    /// Between two rates that are tried where the stiffness is negative.
    constexpr double grid = 3.;
    /// An equilibrium that is not stable is left by this part of the largest box diagonal.
    constexpr double kick = 1e-4;
    /// Part of the largest nodal force that dashpots carry where equilibrium without them is tried.
    constexpr double settled = 1e-2;
  } // namespace

  Relaxation::Relaxation(Model          &model,
                         Journal        &journal,
                         States         &states,
                         Equilibrium    &equilibrium,
                         IncrementLoops &loops,
                         Stability      &stability)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , equilibrium_(equilibrium)
      , loops_(loops)
      , stability_(stability)
  {
  }

  void Relaxation::solve(const MergedLoops &merged, const Reason reason)
  {
    const bool from_equilibrium = reason == Reason::unstable_equilibrium;
    State      reached          = states_.now;
    Vector     anchor(reached.unknowns.block(0)), pull(anchor);
    pull                    = 0.; // what is out of balance without dashpots
    bool         pull_known = from_equilibrium;
    double       rate = first_rate, largest_part = settled, softer = softest;
    unsigned int failures = 0;
    equilibrium_.hold(0., anchor);
    if (from_equilibrium)
    {
      const Vector &mode = stability_.mode();
      const double  side = mode * anchor >= 0. ? 1. : -1.; // where the bodies lean already
      anchor.add(side * kick * 1e6 * model_.length_scale, mode);
      rate = smallest_stable(smallest_rate);
    }
    for (unsigned int n = 0; n < max_steps; ++n)
    {
      if (!step(merged, rate, anchor))
      {
        go_back_to(reached);
        softer = gentle;
        rate *= harder;
        if (rate > largest_rate || (++failures > max_failures && reason == Reason::no_equilibrium))
          break;
        continue;
      }
      Vector &u = states_.now.unknowns.block(0);
      Vector  moved(u), forces(equilibrium_.forces().drag);
      moved -= reached.unknowns.block(0);
      forces *= -1.;
      if (!std::exchange(pull_known, true))
        pull = forces;
      pull += forces;
      equilibrium_.add_relaxed_work(0.5 * (pull * moved)); // trapezoidal rule
      pull              = forces;
      const double part = largest_entry(forces) / equilibrium_.forces().scale;
      reached           = states_.now;
      anchor            = u;

      const bool stable = stability_.n_unstable() == 0;
      journal_.console.remark(text("relaxation, step ",
                                   n + 1,
                                   ": dashpots of rate ",
                                   rate,
                                   " carry ",
                                   100. * part,
                                   " % of the largest nodal force",
                                   stable ? "" : ", and hold what is not stable"));
      if (stable && part <= largest_part)
      {
        if (settles(merged, reached))
          return journal_.console.remark(
              text("the bodies have come to rest in a stable equilibrium; the dashpots took ",
                   equilibrium_.relaxed_work(),
                   " of energy"));
        largest_part *= 0.1;
      }
      rate   = stable ? softer * rate : smallest_stable(rate);
      softer = std::max(softest, softer * std::sqrt(softer));
    }
    equilibrium_.add_relaxed_work(-equilibrium_.relaxed_work()); // the bodies go back to where they were
    throw SolverFailure(std::string(reason == Reason::no_equilibrium ? "" : "iterates are not stable, and ") +
                            "relaxation found no stable equilibrium",
                        SolverFailure::Kind::newton_stalled);
  }

  /// Against dashpots at rest at @p anchor. @returns false where that has no solution, or one that is not stable in
  /// spite of them: bodies would be drawn towards what they are to leave.
  bool Relaxation::step(const MergedLoops &merged, const double rate, const Vector &anchor)
  {
    const State begin = states_.now;
    for (const MergedLoops &loops : {merged, MergedLoops()})
      try
      {
        equilibrium_.begin_attempt(loops);
        equilibrium_.hold(rate, anchor);
        loops_.solve();
        const bool stable = stability_.n_unstable(rate) == 0;
        equilibrium_.hold(0., anchor);
        return stable;
      }
      catch (const SolverFailure &failure)
      {
        journal_.diagnosis.end_attempt(failure.what());
        equilibrium_.hold(0., anchor);
        go_back_to(begin);
      }
    return false;
  }

  /// Whether there is a stable equilibrium without dashpots near the state at hand, which it is then.
  bool Relaxation::settles(const MergedLoops &merged, const State &reached)
  {
    try
    {
      equilibrium_.begin_attempt(merged);
      loops_.solve();
      if (stability_.n_unstable() == 0)
        return true;
    }
    catch (const SolverFailure &failure)
    {
      journal_.diagnosis.end_attempt(failure.what());
    }
    go_back_to(reached);
    return false;
  }

  void Relaxation::go_back_to(const State &reached)
  {
    states_.now = reached;
    model_.contact->resume(states_.now.unknowns, states_.committed.unknowns.block(0));
  }

  /// Near @p rate, the smallest one at which the state at hand is stable; not below the softest step.
  double Relaxation::smallest_stable(const double rate)
  {
    double smallest = rate;
    while (smallest > grid * softest * rate && stability_.n_unstable(smallest / grid) == 0)
      smallest /= grid;
    while (smallest < largest_rate && stability_.n_unstable(smallest) > 0)
      smallest *= grid;
    return smallest;
  }
} // namespace Nodus
