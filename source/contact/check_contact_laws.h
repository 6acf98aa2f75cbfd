#ifndef nodus_contact_check_contact_laws_h
#define nodus_contact_check_contact_laws_h

#include "base/law_check.h"
#include <nodus/plugins/friction_law.h>
#include <nodus/plugins/pressure_gap_law.h>

#include <vector>

namespace Nodus
{
  /// Compares the derivative of the limit with differences of the limit over pressures around @p stiffness, from a
  /// millionth of it on, at several slips and rates around @p length; relative to the limit over the pressure.
  std::vector<LawCheck> check_friction(const FrictionLaw &law, double stiffness, double length);

  /// The same of overclosure and compliance, relative to the overclosure over the pressure; and that the overclosure
  /// does not decrease.
  std::vector<LawCheck> check_pressure_gap(const PressureGapLaw &law, double stiffness);
} // namespace Nodus

#endif
