#ifndef nodus_bulk_st_venant_kirchhoff_h
#define nodus_bulk_st_venant_kirchhoff_h

#include "bulk/material.h"

namespace Nodus
{
  /// S = lambda tr(E) I + 2 mu E. Softens without bound in compression: for large rotations with moderate strains.
  class StVenantKirchhoff : public Material
  {
  public:
    explicit StVenantKirchhoff(const MaterialParameters &parameters);

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
    double E_, lambda_, mu_;
  };
} // namespace Nodus

#endif
