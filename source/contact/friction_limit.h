#ifndef nodus_contact_friction_limit_h
#define nodus_contact_friction_limit_h

#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>
#include <nodus/plugins/friction_law.h>

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
  /// - tied: no bound. Lambda is the traction over the stiffness given, which is its scale and nothing else;
  /// - a law of the user's: what that says, at most the shear limit where there is one.
  ///
  /// The friction factor f is an expression of the reference position, of the slip rate and of the time.
  class FrictionLimit
  {
  public:
    /// @p stiffness: of the bodies [pressure].
    FrictionLimit(const ContactPairParameters &pair, double stiffness);
    ~FrictionLimit();
    FrictionLimit(FrictionLimit &&) noexcept;

    /// There is any friction, and whether it depends on lambda; on position, slip rate or time.
    bool exists() const;
    bool follows_pressure() const;
    bool varies() const
    {
      return factor_ != nullptr || own_law() != nullptr;
    }

    /// The time that f is taken at.
    void set_time(double t);
    /// f at reference position @p X and slip rate @p rate [length/time].
    double factor(const Point &X, double rate) const;

    /// The law of the user's, or null.
    const FrictionLaw *own_law() const
    {
      return pair_.friction_law == ContactPairParameters::FrictionLaw::own ? pair_.own_friction_law.object.get()
                                                                           : nullptr;
    }

    /// mu lambda_s <= 0: minus the limit [pressure], and its derivative with respect to @p lambda (eqs. F1 and F2).
    /// @p factor: f at the site; @p point: what a law of the user's asks for, whose pressure is set here.
    double threshold(double lambda, double factor, const FrictionPoint &point) const;
    double slope(double lambda, double factor, const FrictionPoint &point) const;

  private:
    double pressure(double lambda) const;

    const ContactPairParameters                 &pair_;
    double                                       stiffness_;
    std::unique_ptr<dealii::FunctionParser<dim>> factor_; ///< null: 1 everywhere
  };
} // namespace Nodus

#endif
