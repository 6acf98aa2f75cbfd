#include "contact/check_contact_laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Over the stiffness of the bodies.
    constexpr std::array<double, 4> pressures = {{1e-6, 1e-4, 1e-3, 1e-2}};

    /// df/dp by differences of fourth order.
    template <typename Function>
    double derivative(const Function &f, const double p)
    {
      const double step = 1e-3 * p;
      return (8. * (f(p + step) - f(p - step)) - (f(p + 2. * step) - f(p - 2. * step))) / (12. * step);
    }
  } // namespace

  std::vector<LawCheck> check_friction(const FrictionLaw &law, const double stiffness, const double length)
  {
    std::vector<LawCheck> checks(1);
    checks[0].what = "limit by pressure against differences";
    for (const double relative : pressures)
      for (const double slip : {0., 1e-3, 0.1})
        for (const double rate : {0., 1e-3, 0.1})
        {
          FrictionPoint point;
          point.slip       = slip * length;
          point.rate       = rate * length;
          point.state      = law.initial_state();
          const auto limit = [&](const double pressure)
          {
            FrictionPoint at = point;
            at.pressure      = pressure;
            return law.limit(at);
          };
          point.pressure           = relative * stiffness;
          const double       p     = point.pressure;
          const double       scale = std::max(std::abs(law.limit(point)) / p, 1e-3);
          std::ostringstream where;
          where << "pressure " << p << ", slip " << point.slip << ", rate " << point.rate;
          checks[0].add(std::abs(law.limit_by_pressure(point) - derivative(limit, p)) / scale, where.str());
        }
    return checks;
  }

  std::vector<LawCheck> check_pressure_gap(const PressureGapLaw &law, const double stiffness)
  {
    std::vector<LawCheck> checks(2);
    checks[0].what = "compliance against differences of the overclosure";
    checks[1].what = "decrease of the overclosure with the pressure";
    for (const double relative : pressures)
    {
      const double       p = relative * stiffness, scale = std::abs(law.overclosure(p) - law.overclosure(0.)) / p;
      std::ostringstream where;
      where << "pressure " << p;
      const double slope = derivative([&](const double pressure) { return law.overclosure(pressure); }, p);
      checks[0].add(std::abs(law.compliance(p) - slope) / (scale > 0. ? scale : 1.), where.str());
      checks[1].add(scale > 0. ? std::max(-law.compliance(p), 0.) / scale : 0., where.str());
    }
    return checks;
  }
} // namespace Nodus
