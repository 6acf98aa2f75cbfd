#ifndef nodus_run_increment_loops_h
#define nodus_run_increment_loops_h

#include "run/equilibrium.h"
#include "run/fixed_point_loop.h"
#include "solve/anderson_mixing.h"

#include <functional>

namespace Nodus
{
  /// The three nested fixed-point loops of an increment around Newton (theory section 21.1): geometry, friction
  /// thresholds, statuses. Those that are merged into Newton's iteration are passed through once.
  class IncrementLoops
  {
  public:
    /// What a geometry loop with a @p tolerance may leave out of balance at its last pass: where points of a fixed rule
    /// come and go with the overlap of the surfaces, it does not settle any further.
    static double tolerated_rest(double tolerance);

    /// All outlive it. @p heed_signals is called in every Newton iteration, and may throw.
    IncrementLoops(
        Model &model, Journal &journal, States &states, Equilibrium &equilibrium, std::function<void()> heed_signals);

    /// Solves from the state at hand, with the loops merged as Equilibrium::begin_attempt() said. @throws SolverFailure
    void solve();

    /// What the geometry loop of the last solve() has left out of balance, with a warning; 0 where it has settled.
    double rest() const
    {
      return rest_;
    }

  private:
    void                pair();
    void                iterate(const Newton &newton);
    bool                geometry_converged(FixedPointLoop &loop, AndersonMixing &mixing);
    bool                threshold_converged(FixedPointLoop &loop, AndersonMixing &mixing);
    bool                statuses_converged(FixedPointLoop &loop);
    void                check_frozen_statuses();
    bool                has_other_statuses() const;
    void                start_from_mixed(const AndersonMixing &mixing);
    bool                uses(Remedy remedy) const;
    std::vector<double> geometry_values(const Vector &u, const std::vector<RigidBodies::State> &rigid) const;
    void                note_pass(const FixedPointLoop &loop, double value, const std::string &worst);

    Model                          &model_;
    Journal                        &journal_;
    States                         &states_;
    Equilibrium                    &equilibrium_;
    std::function<void()>           heed_signals_;
    Vector                          paired_, paired_before_; ///< displacements of this and the previous pairing
    std::vector<RigidBodies::State> rigid_paired_;           ///< at this pairing
    unsigned int                    geometry_cycles_ = 0;    ///< with period 2, in the geometry loop at hand
    double                          renewed_         = 0.;   ///< norm that this pass of the geometry loop began with
    double                          rest_            = 0.;   ///< see rest()
    unsigned int                    corrections_     = 0;    ///< of Newton, in this pass
    std::vector<char>               statuses_;               ///< that this pass began with
  };
} // namespace Nodus

#endif
