#ifndef nodus_bulk_mooney_rivlin_h
#define nodus_bulk_mooney_rivlin_h

#include "bulk/material.h"

namespace Nodus
{
  /// Mooney-Rivlin in the isochoric invariants with the quadratic volumetric term,
  /// W = c10 (I1 J^-2/3 - 3) + c01 (I2 J^-4/3 - 3) + kappa/2 (J - 1)^2, so that the shear and the bulk response
  /// are independent; 2 (c10 + c01) = mu and kappa = E / (3 (1 - 2 nu)) at F = I (eqs. B6 and B7).
  class MooneyRivlin : public Material
  {
  public:
    explicit MooneyRivlin(const MaterialParameters &parameters);

    void   evaluate(const dealii::Tensor<2, dim>    &F,
                    dealii::SymmetricTensor<2, dim> &S,
                    dealii::SymmetricTensor<4, dim> *C) const override;
    void   evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const override;
    double energy(const dealii::Tensor<2, dim> &F) const override;
    double youngs_modulus() const override
    {
      return E_;
    }

  private:
    double E_, c10_, c01_, kappa_;
  };
} // namespace Nodus

#endif
