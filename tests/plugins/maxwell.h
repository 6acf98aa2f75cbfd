#ifndef nodus_tests_plugins_maxwell_h
#define nodus_tests_plugins_maxwell_h

#include <nodus/plugins/material_law.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>

/// St Venant-Kirchhoff with a Maxwell element beside it, share times as stiff: its elastic strain e follows
/// de/dt = dE/dt - e/tau, exactly where E is linear in time within the steps.
class Maxwell : public Nodus::MaterialLaw
{
public:
  using Strain = dealii::SymmetricTensor<2, Nodus::dim>;

  void add_parameters(dealii::ParameterHandler &prm) override
  {
    prm.add_parameter("Share", share_, "Stiffness of the Maxwell element over that of the spring [-], >= 0.");
    prm.add_parameter("Relaxation time", tau_, "Of the Maxwell element [-], > 0, in the time t of the load path.");
  }
  void initialize() override
  {
    if (!(tau_ > 0.))
      throw Nodus::InputError("Relaxation time must be given and > 0");
  }
  bool uses_elastic_constants() const override
  {
    return true;
  }
  void set_elastic_constants(const double E, const double nu) override
  {
    E_      = E;
    lambda_ = E * nu / ((1. + nu) * (1. - 2. * nu));
    mu_     = E / (2. * (1. + nu));
  }
  double youngs_modulus() const override
  {
    return E_;
  }

  /// Viscous strain, strain, what was dissipated.
  unsigned int n_state() const override
  {
    return 13;
  }

  void respond(const dealii::Tensor<2, Nodus::dim>          &F,
               const Step                                   &step,
               dealii::SymmetricTensor<2, Nodus::dim>       &S,
               dealii::SymmetricTensor<4, Nodus::dim> *const C) const override
  {
    const Strain E = strain(F), viscous = read(step.before), E_before = read(step.before + 6);
    const double times = step.duration / tau_;
    const double left = std::exp(-times), gained = times > 0. ? -std::expm1(-times) / times : 1.;
    const Strain elastic = left * (E_before - viscous) + gained * (E - E_before);
    const Strain flow    = E - elastic - viscous;
    write(E - elastic, step.after);
    write(E, step.after + 6);
    step.after[12] = step.before[12] + 0.5 * share_ * (stress(elastic) + stress(E_before - viscous)) * flow;
    S              = stress(E) + share_ * stress(elastic);
    if (C)
    {
      const auto I = dealii::unit_symmetric_tensor<Nodus::dim>();
      *C = (1. + share_ * gained) * (lambda_ * outer_product(I, I) + 2. * mu_ * dealii::identity_tensor<Nodus::dim>());
    }
  }

  double stored_energy(const dealii::Tensor<2, Nodus::dim> &F, const double *state) const override
  {
    const Strain E = strain(F), elastic = E - read(state);
    return 0.5 * stress(E) * E + 0.5 * share_ * (stress(elastic) * elastic);
  }
  double dissipation(const double *state) const override
  {
    return state[12];
  }

  double share_ = 0., tau_ = 0.;

private:
  static Strain strain(const dealii::Tensor<2, Nodus::dim> &F)
  {
    return 0.5 * (symmetrize(transpose(F) * F) - dealii::unit_symmetric_tensor<Nodus::dim>());
  }
  static Strain read(const double *numbers)
  {
    Strain E;
    for (unsigned int c = 0; c < 6; ++c)
      E.access_raw_entry(c) = numbers[c];
    return E;
  }
  static void write(const Strain &E, double *numbers)
  {
    for (unsigned int c = 0; c < 6; ++c)
      numbers[c] = E.access_raw_entry(c);
  }
  Strain stress(const Strain &E) const
  {
    return lambda_ * trace(E) * dealii::unit_symmetric_tensor<Nodus::dim>() + 2. * mu_ * E;
  }

  double E_ = 0., lambda_ = 0., mu_ = 0.;
};

#endif
