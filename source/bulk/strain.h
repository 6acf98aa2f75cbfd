#ifndef nodus_bulk_strain_h
#define nodus_bulk_strain_h

#include <nodus/base/types.h>

#include <deal.II/base/symmetric_tensor.h>

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
    for (const auto &[stretch_squared, axis] : dealii::eigenvectors(dealii::symmetrize(F * dealii::transpose(F))))
      strain += 0.5 * std::log(stretch_squared) * dealii::symmetrize(dealii::outer_product(axis, axis));
    return strain;
  }
} // namespace Nodus

#endif
