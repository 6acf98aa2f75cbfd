#ifndef nodus_plugins_pressure_gap_law_h
#define nodus_plugins_pressure_gap_law_h

#include <nodus/plugins/plugin.h>

namespace Nodus
{
  /// How far surfaces in contact give way under pressure: asperities, a coating, a gasket that the mesh does not show
  /// (theory section 9). Contact without such a law is hard: the overclosure is 0.
  class PressureGapLaw : public Plugin
  {
  public:
    static constexpr const char *kind = "pressure-gap law";

    /// Overclosure d_n, minus the gap, at a pressure >= 0 [length]. It does not decrease with the pressure. At pressure
    /// 0 surfaces begin to touch: a negative value is the gap at which they do.
    virtual double overclosure(double pressure) const = 0;
    /// Its derivative, finite and >= 0 [length/pressure].
    virtual double compliance(double pressure) const = 0;
  };
} // namespace Nodus

/// NODUS_REGISTER_PRESSURE_GAP(Asperities, "asperities", "Rough surfaces.");
#define NODUS_REGISTER_PRESSURE_GAP(Class, name, meaning) NODUS_REGISTER(Nodus::PressureGapLaw, Class, name, meaning)

#endif
