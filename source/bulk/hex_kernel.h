#ifndef nodus_bulk_hex_kernel_h
#define nodus_bulk_hex_kernel_h

#include "bulk/element_kernel.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>

namespace Nodus
{
  /// What kernels of hexahedra share: gradients of the shape functions, and the products with the moduli. All lengths
  /// are known at compile time, so that gcc keeps the sums of a node pair in registers.
  template <unsigned int degree>
  class HexKernel : public ElementKernel
  {
  public:
    static constexpr unsigned int n_nodes = (degree + 1) * (degree + 1) * (degree + 1);
    static constexpr unsigned int n_q     = n_nodes;

    explicit HexKernel(const dealii::FiniteElement<dim> &fe)
    {
      const dealii::QGauss<dim> quadrature(degree + 1);
      for (unsigned int q = 0; q < n_q; ++q)
      {
        weight_[q] = quadrature.weight(q);
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int e = 0; e < dim; ++e)
            unit_gradient_[q][a][e] = fe.base_element(0).shape_grad(a, quadrature.point(q))[e];
      }
    }

    const QuadraturePoint *points(const Lanes *X) override
    {
      for (unsigned int q = 0; q < n_q; ++q)
      {
        Lanes J[dim][dim] = {}; // dX_i/d(unit coordinate e) in [i][e]
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int e = 0; e < dim; ++e)
              J[i][e] += X[dim * a + i] * unit_gradient_[q][a][e];
        Lanes det;
        determinant(J, det);
        const Lanes inverse = 1. / det;
        for (unsigned int e = 0; e < dim; ++e)
          for (unsigned int i = 0; i < dim; ++i)
          {
            const unsigned int i1 = (i + 1) % dim, i2 = (i + 2) % dim, e1 = (e + 1) % dim, e2 = (e + 2) % dim;
            points_[q].inverse_jacobian[e][i] = inverse * (J[i1][e1] * J[i2][e2] - J[i1][e2] * J[i2][e1]);
          }
        points_[q].JxW = weight_[q] * det;
      }
      return points_;
    }

  protected:
    using Moduli = Lanes[dim * dim][dim * dim]; ///< JxW dP_iJ/dF_kL in [3i+J][3k+L]

    /// Also leaves the gradients of the shape functions in gradient_[q].
    void deformation_gradient(const QuadraturePoint &point, const Lanes *u, const unsigned int q, Lanes (&F)[dim][dim])
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int J = 0; J < dim; ++J)
          F[i][J] = Lanes{} + (i == J ? 1. : 0.);
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int J = 0; J < dim; ++J)
        {
          const Lanes g = point.inverse_jacobian[0][J] * unit_gradient_[q][a][0] +
                          point.inverse_jacobian[1][J] * unit_gradient_[q][a][1] +
                          point.inverse_jacobian[2][J] * unit_gradient_[q][a][2];
          for (unsigned int i = 0; i < dim; ++i)
            F[i][J] += u[dim * a + i] * g;
          gradient_[q][a][J] = g;
        }
    }

    /// Lowers @p smallest to @p J where that is less or no number. @returns whether all are positive
    static bool note_smallest(const Lanes &J, Lanes &smallest)
    {
      bool positive = true;
      for (unsigned int v = 0; v < n_lanes; ++v)
      {
        positive    = positive && J[v] > 0.; // false for NaN, too
        smallest[v] = J[v] < smallest[v] || !(J[v] > 0.) ? J[v] : smallest[v];
      }
      return positive;
    }

    /// The blocks of node @p a with itself and the later ones. @returns the place behind them
    Lanes *set_row(const unsigned int a, Lanes *stiffness) const
    {
      Lanes T[n_q][dim][dim * dim];
      for (unsigned int q = 0; q < n_q; ++q)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int kL = 0; kL < dim * dim; ++kL)
            T[q][i][kL] = gradient_[q][a][0] * moduli_[q][dim * i][kL] +
                          gradient_[q][a][1] * moduli_[q][dim * i + 1][kL] +
                          gradient_[q][a][2] * moduli_[q][dim * i + 2][kL];

      for (unsigned int b = a; b < n_nodes; ++b, stiffness += dim * dim)
      {
        Lanes K[dim][dim] = {};
        for (unsigned int q = 0; q < n_q; ++q)
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int k = 0; k < dim; ++k)
              K[i][k] += T[q][i][dim * k] * gradient_[q][b][0] + T[q][i][dim * k + 1] * gradient_[q][b][1] +
                         T[q][i][dim * k + 2] * gradient_[q][b][2];
        std::copy_n(&K[0][0], dim * dim, stiffness);
      }
      return stiffness;
    }

    double          weight_[n_q], unit_gradient_[n_q][n_nodes][dim];
    QuadraturePoint points_[n_q];
    Lanes           gradient_[n_q][n_nodes][dim];
    Moduli          moduli_[n_q];
  };
} // namespace Nodus

#endif
