#ifndef nodus_run_strategy_h
#define nodus_run_strategy_h

#include "run/relaxation.h"

#include <optional>
#include <vector>

namespace Nodus
{
  /// The attempts at an increment (theory section 21.3), one after the other until one succeeds: which loops are merged
  /// into Newton's iteration. Each starts from the state that the increment began with.
  class Strategy
  {
  public:
    /// All outlive it.
    Strategy(Model &model, Journal &journal, States &states, Equilibrium &equilibrium, IncrementLoops &loops);

    /// A rung of the ladder. Those that do not go on start where the last increment ended.
    struct Attempt
    {
      const char *name;
      MergedLoops merged;
      /// What it is counted as, and the failures of attempts before it after which it is tried; none for the first one.
      std::optional<Remedy>            remedy;
      std::vector<SolverFailure::Kind> answers;
      bool                             goes_on; ///< along the motion of the last increment, as far as there is one
    };
    /// Those that are of use in the case at hand, in their order.
    std::vector<Attempt> ladder() const;

    /// The mesh is a new one.
    void begin_on_mesh()
    {
      stability_.begin_on_mesh();
    }

    /// Solves the increment that Equilibrium::begin_increment() was given. @throws SolverFailure of the last attempt,
    /// whose state is still at hand.
    void solve_increment();
    /// The same by relaxation, where smaller increments do not help. @param unstable: iterates have not been stable.
    /// Otherwise it is the last resort, and the failure that it did not cure is thrown again.
    void relax_increment(bool unstable);
    /// The motion that was resisted least in the last states, empty where none has been followed (Stability).
    const Vector &softest_motion() const
    {
      return stability_.mode();
    }
    /// Bodies have been let go in the increment, and have gone elsewhere than loads drove them.
    bool relaxed() const
    {
      return journal_.counts.remedies[Remedy::relaxation] > 0;
    }
    bool may_relax() const
    {
      return model_.parameters.strategy.uses(Remedy::relaxation) && stability_.can_count() &&
             !equilibrium_.increment().follows_branch;
    }

    /// No attempt came beyond its first system, which leaves bodies free, and that is the one of the last converged
    /// state: all smaller increments begin with it, too. Collective.
    bool begins_singular() const;

    /// IncrementLoops::rest() of the last attempt.
    double geometry_rest() const
    {
      return loops_.rest();
    }

  private:
    void run(const Attempt &attempt);
    void relax(Relaxation::Reason reason);
    void leave_if_unstable(const Attempt &attempt);

    Model          &model_;
    Journal        &journal_;
    States         &states_;
    Equilibrium    &equilibrium_;
    IncrementLoops &loops_;
    Stability       stability_;
    Relaxation      relaxation_;
  };
} // namespace Nodus

#endif
