#include <nodus/bulk/st_venant_kirchhoff.h>

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

  double StVenantKirchhoff::energy(const Tensor<2, dim> &F) const
  {
    const auto E = 0.5 * (symmetrize(transpose(F) * F) - unit_symmetric_tensor<dim>());
    return lambda_ / 2. * std::pow(trace(E), 2) + mu_ * (E * E);
  }
} // namespace Nodus
