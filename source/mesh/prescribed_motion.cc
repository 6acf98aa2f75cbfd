#include <nodus/mesh/expression.h>
#include <nodus/mesh/prescribed_motion.h>

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

  Placement PrescribedMotion::at(const double t) const
  {
    Placement    placement;
    Vector3      translation;
    const double degrees = function_->value(dealii::Point<1>(t), dim);
    double       sum     = degrees;
    for (unsigned int c = 0; c < dim; ++c)
      sum += translation[c] = function_->value(dealii::Point<1>(t), c);
    if (!std::isfinite(sum))
    {
      std::ostringstream message;
      message << label_ << ": translation (" << translation << ") and rotation " << degrees << " at t = " << t
              << " are not numbers; correct the expressions";
      throw InputError(message.str());
    }

    // Rodrigues' formula
    const double angle = degrees * dealii::numbers::PI / 180., sine = std::sin(angle);
    const double rest = 2. * std::sin(0.5 * angle) * std::sin(0.5 * angle); // 1 - cos
    placement.R       = rest * dealii::outer_product(axis_, axis_);
    for (unsigned int c = 0; c < dim; ++c)
    {
      const unsigned int i = (c + 1) % dim, j = (c + 2) % dim;
      placement.R[c][c] += 1. - rest;
      placement.R[j][i] += sine * axis_[c];
      placement.R[i][j] -= sine * axis_[c];
    }
    placement.s = centre_ - placement.R * centre_ + translation;
    return placement;
  }
} // namespace Nodus
