#include "bulk/linear_elastic.h"

#include <cmath>

namespace Nodus
{
  using namespace dealii;

  LinearElastic::LinearElastic(const MaterialParameters &parameters)
      : E_(parameters.youngs_modulus)
      , lambda_(E_ * parameters.poissons_ratio /
                ((1. + parameters.poissons_ratio) * (1. - 2. * parameters.poissons_ratio)))
      , mu_(E_ / (2. * (1. + parameters.poissons_ratio)))
  {
  }

  void LinearElastic::evaluate(const Tensor<2, dim> &F, SymmetricTensor<2, dim> &S, SymmetricTensor<4, dim> *C) const
  {
    const auto I      = unit_symmetric_tensor<dim>();
    const auto strain = symmetrize(F) - I;
    S                 = lambda_ * trace(strain) * I + 2. * mu_ * strain;
    if (C)
      *C = lambda_ * outer_product(I, I) + 2. * mu_ * identity_tensor<dim>();
  }

  void
  LinearElastic::evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const
  {
    const Lanes pressure = lambda_ * (F[0][0] + F[1][1] + F[2][2] - 3.);
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      const unsigned int i = pair_first[r], j = pair_second[r];
      S[r] = mu_ * (F[i][j] + F[j][i]);
      if (r < dim)
        S[r] += pressure - 2. * mu_;
      if (C)
        for (unsigned int c = 0; c < n_pairs; ++c)
          (*C)[r][c] = Lanes{} + ((r < dim && c < dim ? lambda_ : 0.) + (r == c ? (r < dim ? 2. : 1.) * mu_ : 0.));
    }
  }

  double LinearElastic::energy(const Tensor<2, dim> &F) const
  {
    const auto strain = symmetrize(F) - unit_symmetric_tensor<dim>();
    return lambda_ / 2. * std::pow(trace(strain), 2) + mu_ * (strain * strain);
  }
} // namespace Nodus
