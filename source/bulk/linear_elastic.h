#ifndef nodus_bulk_linear_elastic_h
#define nodus_bulk_linear_elastic_h

#include "bulk/material.h"

namespace Nodus
{
  /// Hooke's law of the linearised strain: S = lambda tr(e) I + 2 mu e, e = sym(F) - I.
  class LinearElastic : public Material
  {
  public:
    explicit LinearElastic(const MaterialParameters &parameters);

    bool small_strain() const override
    {
      return true;
    }
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
