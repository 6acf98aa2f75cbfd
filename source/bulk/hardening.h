#ifndef nodus_bulk_hardening_h
#define nodus_bulk_hardening_h

#include <nodus/parameters/parameters.h>

#include <vector>

namespace Nodus
{
  /// Yield stress over the equivalent plastic strain a: yield + modulus a + (saturation - yield) (1 - exp(-rate a))
  /// (Voce), or a table, linear in between and constant behind its end.
  class Hardening
  {
  public:
    /// @throws InputError when the yield stress is not positive or the curve falls.
    explicit Hardening(const MaterialParameters &parameters);

    double yield_stress(double a) const;
    /// d(yield stress)/da, to the right of a point of the table
    double slope(double a) const;
    /// Integral of the yield stress from 0 to @p a: plastic work per volume.
    double work(double a) const;
    /// The increment d with trial - stiffness d = yield_stress(a + d). @p trial > yield_stress(a), @p stiffness > 0.
    double increment(double a, double trial, double stiffness) const;

  private:
    /// The interval of the table that @p a is in; the last one does not end.
    unsigned int interval(double a) const;

    double              yield_, modulus_, saturation_, rate_;
    std::vector<double> strain_, stress_;
  };
} // namespace Nodus

#endif
