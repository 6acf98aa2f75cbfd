#ifndef nodus_bulk_j2_plasticity_h
#define nodus_bulk_j2_plasticity_h

#include "bulk/hardening.h"
#include "bulk/principal_law.h"

namespace Nodus
{
  /// Elastoplasticity of metals at finite strain, F = Fe Fp with det Fp = 1: Hencky's law in the elastic logarithmic
  /// strains, W = kappa/2 (ln J)^2 + mu |dev epsilon|^2; von Mises yield condition in the Kirchhoff stress,
  /// sqrt(3/2) |dev tau| <= yield stress(equivalent plastic strain); associative flow by the exponential map, which
  /// turns into the return of the small-strain theory on the principal axes of the trial b = F Cp^-1 F^T (Simo, Comput.
  /// Methods Appl. Mech. Eng. 99, 1992). Backward Euler in the steps; the tangent is that of the step.
  class J2Plasticity : public PrincipalLaw
  {
  public:
    explicit J2Plasticity(const MaterialParameters &parameters);

    unsigned int n_state() const override
    {
      return history_size;
    }
    void   set_initial(double *state) const override;
    double dissipation(const double *state) const override
    {
      return hardening_.work(equivalent_plastic_strain(state));
    }
    double equivalent_plastic_strain(const double *state) const override
    {
      return state[n_pairs];
    }
    double youngs_modulus() const override
    {
      return E_;
    }

  protected:
    void   respond(Principal &principal) const override;
    double energy_of(const double (&elastic_strain)[dim]) const override;

  private:
    double    E_, kappa_, mu_;
    Hardening hardening_;
  };
} // namespace Nodus

#endif
