#ifndef nodus_plugins_friction_law_h
#define nodus_plugins_friction_law_h

#include <nodus/base/types.h>
#include <nodus/plugins/plugin.h>

#include <array>

namespace Nodus
{
  /// What a friction law knows of a place on the slave surface.
  struct FrictionPoint
  {
    static constexpr unsigned int max_state = 4;

    Point                         X;             ///< reference position
    double                        pressure = 0.; ///< >= 0
    double                        slip     = 0.; ///< accumulated while in contact, as the crow flies [length]
    double                        rate     = 0.; ///< slip of the increment over its time [length/time]
    std::array<double, max_state> state{};       ///< of the law, as the increment begins
  };

  /// How large the friction traction gets: a radius tau of the cone (theory section 12). Slip goes along the traction.
  ///
  /// Pressure acts at once, and with its derivative in the tangent; slip, rate and state are those of the last iterate
  /// of the threshold loop, which ends when tau no longer changes. The law is asked on every rank for its own sites.
  class FrictionLaw : public Plugin
  {
  public:
    static constexpr const char *kind = "friction law";

    /// tau >= 0 [pressure]
    virtual double limit(const FrictionPoint &point) const = 0;
    /// d tau/d pressure
    virtual double limit_by_pressure(const FrictionPoint &point) const = 0;
    /// Whether tau depends on the pressure at all.
    virtual bool follows_pressure() const
    {
      return true;
    }

    /// State of a site that has not been in contact.
    virtual std::array<double, FrictionPoint::max_state> initial_state() const
    {
      return {};
    }
    /// State at the end of an increment of this @p duration in which the site was closed. @p point has the state at
    /// its begin.
    virtual std::array<double, FrictionPoint::max_state> next_state(const FrictionPoint &point,
                                                                    double /*duration*/) const
    {
      return point.state;
    }
  };
} // namespace Nodus

/// NODUS_REGISTER_FRICTION(RunningIn, "running in", "Coulomb's law with a coefficient that falls as surfaces wear.");
#define NODUS_REGISTER_FRICTION(Class, name, meaning) NODUS_REGISTER(Nodus::FrictionLaw, Class, name, meaning)

#endif
