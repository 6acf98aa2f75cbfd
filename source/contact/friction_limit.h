#ifndef nodus_contact_friction_limit_h
#define nodus_contact_friction_limit_h

#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <memory>

namespace dealii
{
  template <int dim>
  class FunctionParser;
}

namespace Nodus
{
  /// How large the friction traction of a pair can get (the radius of its cone, along the first tangent):
  ///
  /// - Coulomb: f mu |lambda|, at most the shear limit where there is one;
  /// - Tresca: f times the shear limit, whatever the pressure;
  /// - tied: no bound. Lambda is the traction over the stiffness given, which is its scale and nothing else.
  ///
  /// The friction factor f is an expression of the reference position and of the slip rate.
  class FrictionLimit
  {
  public:
    /// @p stiffness: of the bodies [pressure].
    FrictionLimit(const ContactPairParameters &pair, double stiffness);
    ~FrictionLimit();
    FrictionLimit(FrictionLimit &&) noexcept;

    /// There is any friction, and whether it depends on lambda; on position or slip rate.
    bool exists() const;
    bool follows_pressure() const;
    bool varies() const
    {
      return factor_ != nullptr;
    }

    /// f at reference position @p X and slip rate @p rate [length/time].
    double factor(const Point &X, double rate) const;

    /// mu lambda_s <= 0: minus the limit [pressure], and its derivative with respect to @p lambda (eqs. F1 and F2).
    double threshold(double lambda, double factor) const;
    double slope(double lambda, double factor) const;

  private:
    const ContactPairParameters                 &pair_;
    double                                       stiffness_;
    std::unique_ptr<dealii::FunctionParser<dim>> factor_; ///< null: 1 everywhere
  };
} // namespace Nodus

#endif
