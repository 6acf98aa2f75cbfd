#include "bulk/hardening.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace Nodus
{
  Hardening::Hardening(const MaterialParameters &parameters)
      : yield_(parameters.yield_stress)
      , modulus_(parameters.hardening_modulus)
      , saturation_(parameters.saturation_rate > 0. ? parameters.saturation_stress - yield_ : 0.)
      , rate_(parameters.saturation_rate)
      , strain_(parameters.hardening_strains)
      , stress_(parameters.hardening_stresses)
  {
    if (!stress_.empty())
      yield_ = stress_[0];
    if (!(yield_ > 0. && modulus_ >= 0. && saturation_ >= 0.) || strain_.size() != stress_.size() ||
        (!strain_.empty() && strain_[0] != 0.) ||
        std::adjacent_find(strain_.begin(), strain_.end(), std::greater_equal<>()) != strain_.end() ||
        std::adjacent_find(stress_.begin(), stress_.end(), std::greater<>()) != stress_.end())
      throw InputError("Material: the yield stress must be > 0 and must not fall with the plastic strain, which begins "
                       "with 0 in a table");
  }

  unsigned int Hardening::interval(const double a) const
  {
    return std::upper_bound(strain_.begin() + 1, strain_.end(), a) - strain_.begin() - 1;
  }

  double Hardening::yield_stress(const double a) const
  {
    if (strain_.empty())
      return yield_ + modulus_ * a - saturation_ * std::expm1(-rate_ * a);
    const unsigned int i = interval(a);
    return stress_[i] + slope(a) * (a - strain_[i]);
  }

  double Hardening::slope(const double a) const
  {
    if (strain_.empty())
      return modulus_ + saturation_ * rate_ * std::exp(-rate_ * a);
    const unsigned int i = interval(a);
    return i + 1 < strain_.size() ? (stress_[i + 1] - stress_[i]) / (strain_[i + 1] - strain_[i]) : 0.;
  }

  double Hardening::work(const double a) const
  {
    if (strain_.empty())
      return (yield_ + modulus_ / 2. * a + saturation_) * a +
             (saturation_ > 0. ? saturation_ / rate_ * std::expm1(-rate_ * a) : 0.);
    const unsigned int i    = interval(a);
    double             work = 0.;
    for (unsigned int j = 0; j < i; ++j)
      work += (stress_[j] + stress_[j + 1]) / 2. * (strain_[j + 1] - strain_[j]);
    return work + (stress_[i] + yield_stress(a)) / 2. * (a - strain_[i]);
  }

  double Hardening::increment(const double a, const double trial, const double stiffness) const
  {
    if (!strain_.empty())
      for (unsigned int i = interval(a);; ++i)
      {
        // the line of each interval, until the answer is in its own
        const bool   last    = i + 1 == strain_.size();
        const double tangent = slope(strain_[i]);
        const double d       = (trial - stress_[i] - tangent * (a - strain_[i])) / (stiffness + tangent);
        if (last || a + d <= strain_[i + 1])
          return d;
      }
    // The excess is a convex decreasing function of the increment: Newton goes up to the root from the left.
    double d = 0.;
    for (unsigned int iteration = 0; iteration < 100; ++iteration)
    {
      const double change = (trial - stiffness * d - yield_stress(a + d)) / (stiffness + slope(a + d));
      d += change;
      if (change <= 1e-15 * d)
        break;
    }
    return d;
  }
} // namespace Nodus
