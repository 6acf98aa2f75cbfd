#ifndef nodus_rigid_prescribed_motion_h
#define nodus_rigid_prescribed_motion_h

#include <nodus/parameters/parameters.h>

#include <deal.II/base/function_parser.h>

#include <array>
#include <memory>
#include <string>

namespace Nodus
{
  /// Where a rigid body is: x = R X + s.
  struct Placement
  {
    dealii::Tensor<2, dim> R;
    Vector3                s;

    Point to(const Point &X) const
    {
      return Point(R * X + s);
    }
    Point from(const Point &x) const
    {
      return Point(transpose(R) * (x - s));
    }
  };

  /// Rotation by the length of @p vector [radians] about its direction, right-handed (Rodrigues' formula).
  dealii::Tensor<2, dim> rotation_by(const Vector3 &vector);

  /// x = c + R(t) (X - c) + T(t).
  class PrescribedMotion
  {
  public:
    /// @p centre and @p axis count where the parameters name none. @p label: for messages. @throws InputError
    PrescribedMotion(const PrescribedMotionParameters &parameters,
                     const Point                      &centre,
                     const Vector3                    &axis,
                     const std::string                &label);

    /// @throws InputError, on every rank, where an expression is not a number.
    Placement at(double t) const;

    const Point &centre() const
    {
      return centre_;
    }
    /// Of the centre. @throws as at()
    Vector3 translation(double t) const;
    /// Rotation vector: angle in radians times axis. @throws as at()
    Vector3 rotation(double t) const;

  private:
    /// Translation and angle in degrees. @throws as at()
    std::array<double, dim + 1> values(double t) const;

    std::string                                      label_;
    Point                                            centre_;
    Vector3                                          axis_;     ///< unit, or zero without rotation
    std::unique_ptr<const dealii::FunctionParser<1>> function_; ///< translation, angle in degrees
  };
} // namespace Nodus

#endif
