#ifndef nodus_bulk_neo_hookean_h
#define nodus_bulk_neo_hookean_h

#include "bulk/material.h"

namespace Nodus
{
  /// Compressible neo-Hookean: W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2, S = mu (I - C^-1) + lambda ln J C^-1.
  class NeoHookean : public Material
  {
  public:
    explicit NeoHookean(const MaterialParameters &parameters);

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
