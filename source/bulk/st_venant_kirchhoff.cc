#include "bulk/st_venant_kirchhoff.h"

#include <cmath>

namespace Nodus
{
  using namespace dealii;

  StVenantKirchhoff::StVenantKirchhoff(const MaterialParameters &parameters)
      : E_(parameters.youngs_modulus)
      , lambda_(E_ * parameters.poissons_ratio /
                ((1. + parameters.poissons_ratio) * (1. - 2. * parameters.poissons_ratio)))
      , mu_(E_ / (2. * (1. + parameters.poissons_ratio)))
  {
  }

  void
  StVenantKirchhoff::evaluate(const Tensor<2, dim> &F, SymmetricTensor<2, dim> &S, SymmetricTensor<4, dim> *C) const
  {
    const auto I = unit_symmetric_tensor<dim>();
    const auto E = 0.5 * (symmetrize(transpose(F) * F) - I);
    S            = lambda_ * trace(E) * I + 2. * mu_ * E;
    if (C)
      *C = lambda_ * outer_product(I, I) + 2. * mu_ * identity_tensor<dim>();
  }

  void
  StVenantKirchhoff::evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const
  {
    Lanes strain[n_pairs]; // right Cauchy-Green
    right_cauchy_green(F, strain);
    const Lanes pressure = lambda_ / 2. * (strain[0] + strain[1] + strain[2] - 3.);
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      S[r] = mu_ * strain[r];
      if (r < dim)
        S[r] += pressure - mu_;
      if (C)
        for (unsigned int c = 0; c < n_pairs; ++c)
          (*C)[r][c] = Lanes{} + ((r < dim && c < dim ? lambda_ : 0.) + (r == c ? (r < dim ? 2. : 1.) * mu_ : 0.));
    }
  }

  double StVenantKirchhoff::energy(const Tensor<2, dim> &F) const
  {
    const auto E = 0.5 * (symmetrize(transpose(F) * F) - unit_symmetric_tensor<dim>());
    return lambda_ / 2. * std::pow(trace(E), 2) + mu_ * (E * E);
  }
} // namespace Nodus
