#ifndef nodus_run_arc_length_h
#define nodus_run_arc_length_h

#include "run/driven_rigid_bodies.h"

namespace Nodus
{
  /// Time as an unknown of an increment, and the equation that it is found by: the motion of the bodies along the
  /// secant of the last increment has a given length (theory section 21.5).
  class ArcLength
  {
  public:
    /// Both outlive it.
    ArcLength(Model &model, const States &states);

    /// The increment at hand is @p increment, and sets out along State::motion. Collective.
    void begin(const Increment &increment);
    /// Time is an unknown of it.
    bool acts() const
    {
      return increment_.finds_time();
    }
    /// Motion along the secant since the increment began [length]; 0 where it has none (eq. Z1). Collective.
    double motion() const;
    /// What the state at hand lacks of the length that is given [length]; 0 where time is. Collective.
    double missing() const;
    /// Largest displacement of a free node in the last increment [length]. Collective.
    double last_motion() const;

    /// Rates at time @p t and the state at hand (eq. Z2), with the contact as it is. @p u: displacement with ghosts; @p
    /// linearise_threshold, @p with_geometry: as in the matrix that is solved with. Conditions are those of time @p t
    /// before and after. Collective.
    TimeRates rates(
        double t, const Vector &u, const DrivenRigidBodies &driven, bool linearise_threshold, bool with_geometry) const;
    /// Finds the step in time of the correction from the state at hand at time @p t, which is @p fixed at this time and
    /// changes by @p rate per time (eq. Z3). Collective. @throws SolverFailure where it leaves the interval, and where
    /// nothing moves in time.
    void   find_step(double t, const BlockVector &fixed, const BlockVector &rate);
    double step() const
    {
      return step_;
    }
    /// Once @p part of it is taken.
    double time(const double part) const
    {
      return time_ + part * step_;
    }

  private:
    Vector free_part(const Vector &motion) const;
    Vector prescribed(const Vector &u) const;
    Vector force_change(double t, double step, const Vector &prescribed) const;
    void   add_contact(bool linearise_threshold, bool with_geometry, TimeRates &rates) const;

    Model        &model_;
    const States &states_;
    Increment     increment_;
    Vector        direction_;             ///< its product with a displacement is the motion along the secant
    double        time_ = 0., step_ = 0.; ///< of the iterate; of its correction
  };
} // namespace Nodus

#endif
