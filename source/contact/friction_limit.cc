#include "contact/friction_limit.h"
#include "parameters/expression.h"

#include <deal.II/base/function_parser.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    using ContactLaw = ContactPairParameters::ContactLaw;
    using Friction   = ContactPairParameters::FrictionLaw;
  } // namespace

  FrictionLimit::FrictionLimit(const ContactPairParameters &pair, const double stiffness)
      : pair_(pair)
      , stiffness_(stiffness)
  {
    set_time(0.);
  }

  FrictionLimit::~FrictionLimit()                         = default;
  FrictionLimit::FrictionLimit(FrictionLimit &&) noexcept = default;

  bool FrictionLimit::exists() const
  {
    return pair_.contact_law == ContactLaw::tied || own_law() != nullptr || pair_.friction_law == Friction::tresca ||
           pair_.friction_coefficient > 0.;
  }

  bool FrictionLimit::follows_pressure() const
  {
    if (pair_.contact_law == ContactLaw::tied)
      return false;
    if (own_law() != nullptr)
      return own_law()->follows_pressure();
    return pair_.friction_law == Friction::coulomb && pair_.friction_coefficient > 0.;
  }

  void FrictionLimit::set_time(const double t)
  {
    if (pair_.friction_factor == "1")
      return;
    factor_ = std::make_unique<dealii::FunctionParser<dim>>(1); // which takes four variables: the time is a constant
    factor_->initialize("x,y,z,v", pair_.friction_factor, {{"pi", dealii::numbers::PI}, {"t", t}}, true);
  }

  double FrictionLimit::factor(const Point &X, const double rate) const
  {
    if (!factor_)
      return 1.;
    factor_->set_time(rate); // the fourth variable
    return factor_->value(X);
  }

  double FrictionLimit::pressure(const double lambda) const
  {
    // a bilateral contact rubs in tension, too
    return pair_.contact_law == ContactLaw::bilateral ? std::abs(lambda) : std::max(-lambda, 0.);
  }

  double FrictionLimit::threshold(const double lambda, const double factor, const FrictionPoint &point) const
  {
    if (pair_.contact_law == ContactLaw::tied)
      return -stiffness_;
    double limit;
    if (own_law() != nullptr)
    {
      FrictionPoint at = point;
      at.pressure      = pressure(lambda);
      limit            = own_law()->limit(at);
    }
    else if (pair_.friction_law == Friction::tresca)
      return -factor * pair_.shear_limit;
    else
      limit = factor * pair_.friction_coefficient * pressure(lambda);
    return pair_.shear_limit > 0. ? -std::min(limit, pair_.shear_limit) : -limit;
  }

  double FrictionLimit::slope(const double lambda, const double factor, const FrictionPoint &point) const
  {
    const double limit = threshold(lambda, factor, point);
    if (!follows_pressure() || lambda == 0. || (pair_.shear_limit > 0. && -limit >= pair_.shear_limit))
      return 0.;
    if (own_law() == nullptr)
      return limit / lambda;
    FrictionPoint at = point;
    at.pressure      = pressure(lambda);
    return at.pressure > 0. ? (lambda < 0. ? 1. : -1.) * own_law()->limit_by_pressure(at) : 0.;
  }
} // namespace Nodus
