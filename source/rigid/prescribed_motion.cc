#include "rigid/prescribed_motion.h"
#include "parameters/expression.h"

#include <deal.II/base/numbers.h>

#include <cmath>
#include <sstream>

namespace Nodus
{
  PrescribedMotion::PrescribedMotion(const PrescribedMotionParameters &parameters,
                                     const Point                      &centre,
                                     const Vector3                    &axis,
                                     const std::string                &label)
      : label_(label)
      , centre_(centre)
      , axis_(parameters.rotation_axis.norm() > 0. ? parameters.rotation_axis : axis)
  {
    for (unsigned int c = 0; c < parameters.rotation_centre.size(); ++c)
      centre_[c] = parameters.rotation_centre[c];
    if (axis_.norm() > 0.)
      axis_ /= axis_.norm();
    std::vector<std::string> expressions = parameters.translation;
    expressions.push_back(parameters.rotation);
    for (const std::string &expression : expressions)
      if (const std::string complaint = expression_complaint(expression, "t"); !complaint.empty())
        throw InputError(label + ": '" + expression + "' cannot be evaluated (" + complaint +
                         "); write an expression of t");
    auto function = std::make_unique<dealii::FunctionParser<1>>(dim + 1);
    function->initialize("t", expressions, {{"pi", dealii::numbers::PI}});
    function_ = std::move(function);
  }

  std::array<double, dim + 1> PrescribedMotion::values(const double t) const
  {
    std::array<double, dim + 1> value;
    double                      sum = 0.;
    Vector3                     translation;
    for (unsigned int c = 0; c <= dim; ++c)
    {
      sum += value[c] = function_->value(dealii::Point<1>(t), c);
      if (c < dim)
        translation[c] = value[c];
    }
    if (!std::isfinite(sum))
    {
      std::ostringstream message;
      message << label_ << ": translation (" << translation << ") and rotation " << value[dim] << " at t = " << t
              << " are not numbers; correct the expressions";
      throw InputError(message.str());
    }
    return value;
  }

  Vector3 PrescribedMotion::translation(const double t) const
  {
    const auto value = values(t);
    return Vector3({value[0], value[1], value[2]});
  }

  Vector3 PrescribedMotion::rotation(const double t) const
  {
    return values(t)[dim] * dealii::numbers::PI / 180. * axis_;
  }

  Placement PrescribedMotion::at(const double t) const
  {
    Placement placement;
    placement.R = rotation_by(rotation(t));
    placement.s = centre_ - placement.R * centre_ + translation(t);
    return placement;
  }

  dealii::Tensor<2, dim> rotation_by(const Vector3 &vector)
  {
    const double           angle = vector.norm(), sine = std::sin(angle);
    const double           rest = 2. * std::sin(0.5 * angle) * std::sin(0.5 * angle); // 1 - cos
    const Vector3          axis = angle > 0. ? vector / angle : Vector3();
    dealii::Tensor<2, dim> R    = rest * dealii::outer_product(axis, axis);
    for (unsigned int c = 0; c < dim; ++c)
    {
      const unsigned int i = (c + 1) % dim, j = (c + 2) % dim;
      R[c][c] += 1. - rest;
      R[j][i] += sine * axis[c];
      R[i][j] -= sine * axis[c];
    }
    return R;
  }
} // namespace Nodus
