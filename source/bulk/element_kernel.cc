#include <nodus/bulk/element_kernel.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>

namespace Nodus
{
  namespace
  {
    /// All lengths are known at compile time, so that gcc keeps the sums of a node pair in registers.
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
          for (unsigned int a = 0; a < n_nodes; ++a)
            for (unsigned int e = 0; e < dim; ++e)
              unit_gradient_[q][a][e] = fe.base_element(0).shape_grad(a, quadrature.point(q))[e];
      }

      void integrate(const QuadraturePoint *points,
                     const Material        &material,
                     const Lanes           *u,
                     Lanes                 *force,
                     Lanes                 *stiffness,
                     Lanes                 &det_F) override
      {
        const bool small_strain = material.small_strain();
        std::fill_n(force, dim * n_nodes, Lanes{});
        det_F = Lanes{} + 1.;
        for (unsigned int q = 0; q < n_q; ++q)
        {
          Lanes F[dim][dim], S[n_pairs], C[n_pairs][n_pairs];
          deformation_gradient(points[q], u, q, F);
          if (!small_strain)
          {
            Lanes here;
            determinant(F, here);
            bool positive = true;
            for (unsigned int v = 0; v < n_lanes; ++v)
            {
              positive = positive && here[v] > 0.; // false for NaN, too
              det_F[v] = here[v] < det_F[v] || !(here[v] > 0.) ? here[v] : det_F[v];
            }
            if (!positive)
              return;
          }
          material.evaluate_lanes(F, S, stiffness ? &C : nullptr);
          for (Lanes &s : S)
            s *= points[q].JxW;
          add_force(F, S, small_strain, q, force);
          if (stiffness)
            set_moduli(F, S, C, small_strain, points[q].JxW, moduli_[q]);
        }
        if (stiffness)
          for (unsigned int a = 0; a < n_nodes; ++a)
            stiffness = set_row(a, stiffness);
      }

    private:
      using Moduli = Lanes[dim * dim][dim * dim]; ///< JxW dP_iJ/dF_kL in [3i+J][3k+L]

      /// Also leaves the gradients of the shape functions in gradient_[q].
      void
      deformation_gradient(const QuadraturePoint &point, const Lanes *u, const unsigned int q, Lanes (&F)[dim][dim])
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

      /// @param S times JxW
      void add_force(const Lanes (&F)[dim][dim],
                     const Lanes (&S)[n_pairs],
                     const bool         small_strain,
                     const unsigned int q,
                     Lanes             *force) const
      {
        Lanes P[dim][dim];
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int J = 0; J < dim; ++J)
            P[i][J] = small_strain ? S[pair_index[i][J]]
                                   : F[i][0] * S[pair_index[0][J]] + F[i][1] * S[pair_index[1][J]] +
                                         F[i][2] * S[pair_index[2][J]];
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int i = 0; i < dim; ++i)
            force[dim * a + i] +=
                P[i][0] * gradient_[q][a][0] + P[i][1] * gradient_[q][a][1] + P[i][2] * gradient_[q][a][2];
      }

      /// JxW dP/dF from the material and, with @p S times JxW, the geometric part.
      static void set_moduli(const Lanes (&F)[dim][dim],
                             const Lanes (&S)[n_pairs],
                             const Lanes (&C)[n_pairs][n_pairs],
                             const bool   small_strain,
                             const Lanes &JxW,
                             Moduli      &A)
      {
        if (small_strain)
        {
          for (unsigned int iJ = 0; iJ < dim * dim; ++iJ)
            for (unsigned int kL = 0; kL < dim * dim; ++kL)
              A[iJ][kL] = JxW * C[pair_index[iJ / dim][iJ % dim]][pair_index[kL / dim][kL % dim]];
          return;
        }
        Lanes half[n_pairs][dim * dim];
        for (unsigned int r = 0; r < n_pairs; ++r)
        {
          Lanes row[n_pairs];
          for (unsigned int c = 0; c < n_pairs; ++c)
            row[c] = JxW * C[r][c];
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int L = 0; L < dim; ++L)
              half[r][dim * k + L] =
                  row[pair_index[0][L]] * F[k][0] + row[pair_index[1][L]] * F[k][1] + row[pair_index[2][L]] * F[k][2];
        }
        for (unsigned int iJ = 0; iJ < dim * dim; ++iJ)
          for (unsigned int kL = iJ; kL < dim * dim; ++kL)
          {
            const unsigned int i = iJ / dim, J = iJ % dim;
            Lanes              sum = F[i][0] * half[pair_index[0][J]][kL] + F[i][1] * half[pair_index[1][J]][kL] +
                        F[i][2] * half[pair_index[2][J]][kL];
            if (kL / dim == i)
              sum += S[pair_index[J][kL % dim]];
            A[iJ][kL] = A[kL][iJ] = sum;
          }
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

      double unit_gradient_[n_q][n_nodes][dim];
      Lanes  gradient_[n_q][n_nodes][dim];
      Moduli moduli_[n_q];
    };
  } // namespace

  std::unique_ptr<ElementKernel> ElementKernel::make(const dealii::FiniteElement<dim> &fe)
  {
    if (fe.degree == 1)
      return std::make_unique<HexKernel<1>>(fe);
    if (fe.degree == 2)
      return std::make_unique<HexKernel<2>>(fe);
    throw InputError("The degree of the displacement is " + std::to_string(fe.degree) + "; it must be 1 or 2");
  }
} // namespace Nodus
