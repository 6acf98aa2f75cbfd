// A rubber whose chains cannot be stretched without limit (Gent, Rubber Chemistry and Technology 69, 1996), with the
// volumetric part of nodus's neo-Hookean law, which it is without a limit:
//   W = -mu/2 Jm ln(1 - (tr C - 3)/Jm) - mu ln J + lambda/2 (ln J)^2

#include <nodus/plugins/hyperelastic_law.h>

#include <deal.II/base/parameter_handler.h>

class Gent : public Nodus::HyperelasticLaw<Gent>
{
public:
  template <typename Number>
  Number energy(const dealii::SymmetricTensor<2, 3, Number> &C) const
  {
    const Number log_J   = 0.5 * log(determinant(C));
    Number       stretch = trace(C) - 3.;
    if (limit_ > 0.)
      stretch = -limit_ * log(1. - stretch / limit_);
    return 0.5 * mu_ * stretch - mu_ * log_J + 0.5 * lambda_ * log_J * log_J;
  }

  // Its own keys stand in the subsection Gent below Material.
  void add_parameters(dealii::ParameterHandler &prm) override
  {
    prm.add_parameter("Limit", limit_, "Value Jm that tr C - 3 does not reach [-], >= 0; 0: none, neo-Hookean.");
  }
  void initialize() override
  {
    if (!(limit_ >= 0.))
      throw Nodus::InputError("Limit must be >= 0; 0 is no limit");
  }

  // "Young's modulus" and "Poisson's ratio" beside "Law" are for this law, too.
  bool uses_elastic_constants() const override
  {
    return true;
  }
  void set_elastic_constants(const double E, const double nu) override
  {
    E_      = E;
    mu_     = E / (2. * (1. + nu));
    lambda_ = E * nu / ((1. + nu) * (1. - 2. * nu));
  }
  double youngs_modulus() const override
  {
    return E_;
  }

private:
  double limit_ = 0., E_ = 0., mu_ = 0., lambda_ = 0.;
};

NODUS_REGISTER_MATERIAL(Gent, "Gent", "Rubber whose chains have a limit, neo-Hookean with Limit = 0.");
