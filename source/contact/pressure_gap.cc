#include "contact/pressure_gap.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// p = k d
    class Linear : public PressureGapLaw
    {
    public:
      explicit Linear(const double stiffness)
          : compliance_(1. / stiffness)
      {
      }
      double overclosure(const double pressure) const override
      {
        return compliance_ * pressure;
      }
      double compliance(double) const override
      {
        return compliance_;
      }

    private:
      double compliance_;
    };

    /// p = k l (exp(d/l) - 1)
    class Exponential : public PressureGapLaw
    {
    public:
      Exponential(const double stiffness, const double length)
          : pressure_(stiffness * length)
          , length_(length)
      {
      }
      double overclosure(const double pressure) const override
      {
        return length_ * std::log1p(pressure / pressure_);
      }
      double compliance(const double pressure) const override
      {
        return length_ / (pressure_ + pressure);
      }

    private:
      double pressure_, length_;
    };

    /// Linear between points, and behind the last one as before it.
    class Table : public PressureGapLaw
    {
    public:
      Table(const std::vector<double> &overclosures, const std::vector<double> &pressures)
          : overclosures_(overclosures)
          , pressures_(pressures)
      {
      }
      double overclosure(const double pressure) const override
      {
        const unsigned int i = interval(pressure);
        return overclosures_[i] + slope(i) * (pressure - pressures_[i]);
      }
      double compliance(const double pressure) const override
      {
        return slope(interval(pressure));
      }

    private:
      /// Number of the point that the interval begins with.
      unsigned int interval(const double pressure) const
      {
        const auto next = std::upper_bound(pressures_.begin() + 1, pressures_.end() - 1, pressure);
        return next - pressures_.begin() - 1;
      }
      double slope(const unsigned int i) const
      {
        return (overclosures_[i + 1] - overclosures_[i]) / (pressures_[i + 1] - pressures_[i]);
      }

      std::vector<double> overclosures_, pressures_;
    };
  } // namespace

  std::shared_ptr<const PressureGapLaw> make_pressure_gap_law(const ContactPairParameters &pair)
  {
    using Law                      = PressureGapParameters::Law;
    const PressureGapParameters &p = pair.pressure_gap;
    switch (p.law)
    {
      case Law::hard:
        return nullptr;
      case Law::linear:
        return std::make_shared<Linear>(p.stiffness);
      case Law::exponential:
        return std::make_shared<Exponential>(p.stiffness, p.stiffening_length);
      case Law::table:
        return std::make_shared<Table>(p.overclosures, p.pressures);
      case Law::own:
        return p.own_law.object;
    }
    return nullptr;
  }

  Closure closure_at(const PressureGapLaw *const law, const double lambda)
  {
    if (law == nullptr)
      return {};
    const double  pressure = std::max(-lambda, 0.);
    const Closure closure  = {law->overclosure(pressure), law->compliance(pressure)};
    return {closure.overclosure - (lambda > 0. ? closure.compliance * lambda : 0.), closure.compliance};
  }
} // namespace Nodus
