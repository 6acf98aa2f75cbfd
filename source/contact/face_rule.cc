#include "contact/face_rule.h"

#include <deal.II/base/quadrature_lib.h>

namespace Nodus
{
  namespace
  {
    /// Closed rule with n equidistant points; n as Parameters::check allows.
    dealii::Quadrature<1> newton_cotes(const unsigned int n)
    {
      switch (n)
      {
        case 2:
          return dealii::QTrapezoid<1>();
        case 3:
          return dealii::QSimpson<1>();
        case 4: // Simpson's 3/8 rule
          return {{dealii::Point<1>(0.), dealii::Point<1>(1. / 3), dealii::Point<1>(2. / 3), dealii::Point<1>(1.)},
                  {1. / 8, 3. / 8, 3. / 8, 1. / 8}};
        case 5:
          return dealii::QMilne<1>();
        default:
          return dealii::QWeddle<1>();
      }
    }
  } // namespace

  dealii::Quadrature<2> face_rule(const ContactPairParameters &pair, const unsigned int degree)
  {
    using Rule         = ContactPairParameters::QuadratureRule;
    using Scheme       = ContactPairParameters::Scheme;
    const bool   gauss = pair.quadrature_rule == Rule::gauss;
    unsigned int n     = pair.quadrature_points;
    if (n == 0 && pair.scheme == Scheme::averaged)
      n = gauss ? (degree == 1 ? 6 : 10) : 7; // Gauss: within 1 % on non-matching patch tests
    else if (n == 0)
      n = !gauss ? 2 * degree + 1 : pair.scheme == Scheme::nodal ? degree + 2 : degree + 1;
    switch (pair.quadrature_rule)
    {
      case Rule::gauss:
        return dealii::QGauss<2>(n);
      case Rule::simpson:
        return dealii::Quadrature<2>(dealii::QIterated<1>(dealii::QSimpson<1>(), (n - 1) / 2));
      default:
        return dealii::Quadrature<2>(newton_cotes(n));
    }
  }
} // namespace Nodus
