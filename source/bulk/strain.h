#ifndef nodus_bulk_strain_h
#define nodus_bulk_strain_h

#include "bulk/principal_axes.h"

#include <cmath>

namespace Nodus
{
  /// E = (F^T F - I)/2 [-], in the axes of the undeformed configuration.
  inline dealii::SymmetricTensor<2, dim> green_lagrange_strain(const dealii::Tensor<2, dim> &F)
  {
    return 0.5 * (dealii::symmetrize(dealii::transpose(F) * F) - dealii::unit_symmetric_tensor<dim>());
  }

  /// Hencky's strain ln V = ln(F F^T)/2 [-], in the axes of the deformed configuration, as the Cauchy stress.
  inline dealii::SymmetricTensor<2, dim> logarithmic_strain(const dealii::Tensor<2, dim> &F)
  {
    dealii::SymmetricTensor<2, dim> strain;
    for (const PrincipalAxis &axis : principal_axes(dealii::symmetrize(F * dealii::transpose(F)))) // stretches squared
      strain += 0.5 * std::log(axis.value) * dealii::symmetrize(dealii::outer_product(axis.direction, axis.direction));
    return strain;
  }
} // namespace Nodus

#endif
