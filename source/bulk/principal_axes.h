#ifndef nodus_bulk_principal_axes_h
#define nodus_bulk_principal_axes_h

#include <nodus/base/types.h>

#include <deal.II/base/symmetric_tensor.h>

#include <Eigen/Dense>

#include <array>

namespace Nodus
{
  struct PrincipalAxis
  {
    double                 value = 0.;
    dealii::Tensor<1, dim> direction; ///< of length 1
  };

  /// Of a symmetric tensor, the largest value first. Not deal.II's: its library has that under a name that Clang does
  /// not give it.
  inline std::array<PrincipalAxis, dim> principal_axes(const dealii::SymmetricTensor<2, dim> &tensor)
  {
    Eigen::Matrix3d matrix;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        matrix(i, j) = tensor[i][j];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    std::array<PrincipalAxis, dim>                       axes;
    for (unsigned int a = 0; a < dim; ++a)
    {
      axes[a].value = solver.eigenvalues()[dim - 1 - a];
      for (unsigned int i = 0; i < dim; ++i)
        axes[a].direction[i] = solver.eigenvectors()(i, dim - 1 - a);
    }
    return axes;
  }
} // namespace Nodus

#endif
