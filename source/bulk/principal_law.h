#ifndef nodus_bulk_principal_law_h
#define nodus_bulk_principal_law_h

#include "bulk/material.h"

namespace Nodus
{
  /// An isotropic law in principal logarithmic stretches (eq. B8): Kirchhoff stresses tau_a = dW/d(epsilon_a) that
  /// share their axes n_a with the elastic left Cauchy-Green tensor b, whose eigenvalues are exp(2 epsilon_a). With N_a
  /// = F^-1 n_a
  ///   S = sum_a tau_a N_a (x) N_a
  ///   C = sum_ab (dtau_a/depsilon_b - 2 tau_a delta_ab) N_aa (x) N_bb + sum_a<b g_ab M_ab (x) M_ab,
  ///   M_ab = N_a (x) N_b + N_b (x) N_a, g_ab = (tau_a - tau_b)/2 coth(epsilon_a - epsilon_b) - (tau_a + tau_b)/2
  /// (Simo & Hughes, Computational Inelasticity, 1998, ch. 9; Ogden, Non-linear Elastic Deformations, 1984, ch. 6).
  ///
  /// Laws with history have the inverse of the plastic right Cauchy-Green tensor in their state, b = F Cp^-1 F^T
  /// before the step, and new elastic strains on the same axes after it; hyperelastic laws have Cp = I.
  class PrincipalLaw : public Material
  {
  public:
    void   evaluate(const dealii::Tensor<2, dim>    &F,
                    dealii::SymmetricTensor<2, dim> &S,
                    dealii::SymmetricTensor<4, dim> *C) const override;
    void   evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const override;
    void   update(const dealii::Tensor<2, dim>    &F,
                  const double                    *before,
                  double                          *after,
                  dealii::SymmetricTensor<2, dim> &S,
                  dealii::SymmetricTensor<4, dim> *C) const override;
    void   update_lanes(const Lanes (&F)[dim][dim],
                        const Lanes *before,
                        Lanes       *after,
                        Lanes (&S)[n_pairs],
                        Lanes (*C)[n_pairs][n_pairs],
                        Lanes *energy) const override;
    void   stress_and_energy_lanes(const Lanes (&F)[dim][dim],
                                   const Lanes *state,
                                   Lanes (&S)[n_pairs],
                                   Lanes &energy) const override;
    double energy(const dealii::Tensor<2, dim> &F) const override;
    double stored_energy(const dealii::Tensor<2, dim> &F, const double *state) const override;
    void   correct_state(double *state) const override;

  protected:
    /// The state of a law with history: Cp^-1, then the equivalent plastic strain.
    static constexpr unsigned int history_size = n_pairs + 1;

    struct Principal
    {
      double strain[dim];       ///< epsilon_a before plastic flow
      double stress[dim];       ///< tau_a
      double modulus[dim][dim]; ///< dtau_a/depsilon_b
      double
          secant[dim]; ///< (tau_b - tau_c)/(epsilon_b - epsilon_c) of the two other axes than a; the limit when equal
      // laws with history only
      double elastic_strain[dim]; ///< after plastic flow
      double plastic_strain;      ///< equivalent; before plastic flow, to be changed
    };
    /// Sets all that follows from the strain.
    virtual void respond(Principal &principal) const = 0;

    virtual double energy_of(const double (&elastic_strain)[dim]) const = 0;

  private:
    /// The state @p after, the tangent and the stored energy before plastic flow are not computed where they are null.
    void respond_lanes(const Lanes (&F)[dim][dim],
                       const Lanes *before,
                       Lanes       *after,
                       Lanes (&S)[n_pairs],
                       Lanes (*C)[n_pairs][n_pairs],
                       Lanes *energy) const;
  };
} // namespace Nodus

#endif
