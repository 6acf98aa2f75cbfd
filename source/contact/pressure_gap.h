#ifndef nodus_contact_pressure_gap_h
#define nodus_contact_pressure_gap_h

#include <nodus/parameters/parameters.h>
#include <nodus/plugins/pressure_gap_law.h>

#include <memory>

namespace Nodus
{
  /// The law of a pair; null: hard contact.
  std::shared_ptr<const PressureGapLaw> make_pressure_gap_law(const ContactPairParameters &pair);

  /// What a law gives way at a multiplier, and minus its derivative by that.
  struct Closure
  {
    double overclosure = 0.; ///< [length]
    double compliance  = 0.; ///< [length/pressure]
  };

  /// Of the multiplier @p lambda, in compression < 0 [pressure]; in tension, which iterates pass through and bilateral
  /// contact bears, the law goes on linearly (eq. C1). @p law null: hard.
  Closure closure_at(const PressureGapLaw *law, double lambda);
} // namespace Nodus

#endif
