#ifndef nodus_run_relaxation_h
#define nodus_run_relaxation_h

#include "run/increment_loops.h"
#include "run/stability.h"

namespace Nodus
{
  /// Finds a stable equilibrium where Newton's method finds none, or one that is not stable: the bodies creep there
  /// against dashpots, in steps of pseudo-time, under the loads at the end of the increment (theory section 21.4). The
  /// dashpots are gone in the state that it ends with, which solves the same equations as any other. Slip and
  /// plastic flow count from the start of the increment.
  class Relaxation
  {
  public:
    /// All outlive it.
    Relaxation(Model          &model,
               Journal        &journal,
               States         &states,
               Equilibrium    &equilibrium,
               IncrementLoops &loops,
               Stability      &stability);

    /// Why the bodies are let go: from the state at hand, which is not stable, along Stability::mode(), or from where
    /// the increment began, after iterates that were not stable, or that led nowhere.
    enum class Reason
    {
      unstable_equilibrium,
      unstable_iterates,
      no_equilibrium
    };
    /// @param merged into Newton's iteration. @throws SolverFailure
    void solve(const MergedLoops &merged, Reason reason);

  private:
    bool   step(const MergedLoops &merged, double rate, const Vector &anchor);
    bool   settles(const MergedLoops &merged, const State &reached);
    void   go_back_to(const State &reached);
    double smallest_stable(double rate);

    Model          &model_;
    Journal        &journal_;
    States         &states_;
    Equilibrium    &equilibrium_;
    IncrementLoops &loops_;
    Stability      &stability_;
  };
} // namespace Nodus

#endif
