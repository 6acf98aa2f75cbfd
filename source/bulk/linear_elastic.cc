#include <nodus/bulk/linear_elastic.h>

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

  double LinearElastic::energy(const Tensor<2, dim> &F) const
  {
    const auto strain = symmetrize(F) - unit_symmetric_tensor<dim>();
    return lambda_ / 2. * std::pow(trace(strain), 2) + mu_ * (strain * strain);
  }
} // namespace Nodus
