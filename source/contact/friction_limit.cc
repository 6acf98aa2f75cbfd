#include "contact/friction_limit.h"
#include "parameters/expression.h"

#include <deal.II/base/function_parser.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    using ContactLaw  = ContactPairParameters::ContactLaw;
    using FrictionLaw = ContactPairParameters::FrictionLaw;
  } // namespace

  FrictionLimit::FrictionLimit(const ContactPairParameters &pair, const double stiffness)
      : pair_(pair)
      , stiffness_(stiffness)
  {
    if (pair.friction_factor == "1")
      return;
    factor_ = std::make_unique<dealii::FunctionParser<dim>>(1);
    factor_->initialize("x,y,z,v", pair.friction_factor, {{"pi", dealii::numbers::PI}}, true);
  }

  FrictionLimit::~FrictionLimit()                         = default;
  FrictionLimit::FrictionLimit(FrictionLimit &&) noexcept = default;

  bool FrictionLimit::exists() const
  {
    return pair_.contact_law == ContactLaw::tied || pair_.friction_law == FrictionLaw::tresca ||
           pair_.friction_coefficient > 0.;
  }

  bool FrictionLimit::follows_pressure() const
  {
    return pair_.contact_law != ContactLaw::tied && pair_.friction_law == FrictionLaw::coulomb &&
           pair_.friction_coefficient > 0.;
  }

  double FrictionLimit::factor(const Point &X, const double rate) const
  {
    if (!factor_)
      return 1.;
    factor_->set_time(rate); // the fourth variable
    return factor_->value(X);
  }

  double FrictionLimit::threshold(const double lambda, const double factor) const
  {
    if (pair_.contact_law == ContactLaw::tied)
      return -stiffness_;
    if (pair_.friction_law == FrictionLaw::tresca)
      return -factor * pair_.shear_limit;
    // a bilateral contact rubs in tension, too
    const double pressure = pair_.contact_law == ContactLaw::bilateral ? std::abs(lambda) : std::max(-lambda, 0.);
    const double limit    = factor * pair_.friction_coefficient * pressure;
    return pair_.shear_limit > 0. ? -std::min(limit, pair_.shear_limit) : -limit;
  }

  double FrictionLimit::slope(const double lambda, const double factor) const
  {
    const double limit = threshold(lambda, factor);
    if (!follows_pressure() || limit == 0. || (pair_.shear_limit > 0. && -limit >= pair_.shear_limit))
      return 0.;
    return limit / lambda;
  }
} // namespace Nodus
