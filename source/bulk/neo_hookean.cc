#include "bulk/neo_hookean.h"

#include <cmath>

namespace Nodus
{
  using namespace dealii;

  NeoHookean::NeoHookean(const MaterialParameters &parameters)
      : E_(parameters.youngs_modulus)
      , lambda_(E_ * parameters.poissons_ratio /
                ((1. + parameters.poissons_ratio) * (1. - 2. * parameters.poissons_ratio)))
      , mu_(E_ / (2. * (1. + parameters.poissons_ratio)))
  {
  }

  void NeoHookean::evaluate(const Tensor<2, dim> &F, SymmetricTensor<2, dim> &S, SymmetricTensor<4, dim> *C) const
  {
    const auto   A     = invert(symmetrize(transpose(F) * F));
    const double log_J = std::log(determinant(F));
    S                  = mu_ * unit_symmetric_tensor<dim>() + (lambda_ * log_J - mu_) * A;
    if (C)
      *C = lambda_ * outer_product(A, A) + 2. * (mu_ - lambda_ * log_J) * symmetric_square(A);
  }

  void NeoHookean::evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const
  {
    Lanes strain[n_pairs], A[n_pairs], J, log_J;
    right_cauchy_green(F, strain);
    determinant(F, J);
    invert(strain, J * J, A);
    log(J, log_J);
    const Lanes shear = mu_ - lambda_ * log_J;
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      S[r] = (r < dim ? mu_ : 0.) - shear * A[r];
      for (unsigned int c = r; C && c < n_pairs; ++c)
      {
        Lanes AA;
        square(A, r, c, AA);
        (*C)[r][c] = (*C)[c][r] = lambda_ * A[r] * A[c] + shear * AA;
      }
    }
  }

  double NeoHookean::energy(const Tensor<2, dim> &F) const
  {
    const double log_J = std::log(determinant(F));
    return mu_ / 2. * (F.norm_square() - 3.) - mu_ * log_J + lambda_ / 2. * log_J * log_J;
  }
} // namespace Nodus
