#ifndef nodus_bulk_element_kernel_h
#define nodus_bulk_element_kernel_h

#include <nodus/bulk/material.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace Nodus
{
  /// Force and stiffness of one hexahedron, total Lagrangian, (degree+1)^3 Gauss points.
  class ElementKernel
  {
  public:
    /// Reference geometry at a quadrature point; nothing else is stored per cell.
    struct QuadraturePoint
    {
      double inverse_jacobian[dim][dim]; ///< d(unit coordinate e)/d(X_J) in [e][J]
      double JxW;
    };

    virtual ~ElementKernel() = default;

    /// @param points one entry for each point of the (degree+1)^3 Gauss formula
    /// @param u displacement, @param force int P : Grad phi, both in the order of the element's degrees of freedom
    /// @param stiffness d(force)/du, exactly symmetric; not computed when null
    /// @return the smallest det F; when it is not positive, the results are undefined. 1 for small strain.
    virtual double integrate(const QuadraturePoint      *points,
                             const Material             &material,
                             const std::vector<double>  &u,
                             dealii::Vector<double>     &force,
                             dealii::FullMatrix<double> *stiffness) = 0;

    /// For a displacement element FESystem(FE_Q(degree), 3).
    static std::unique_ptr<ElementKernel> make(const dealii::FiniteElement<dim> &fe);
  };

  /// The loops run over nodes padded to whole vector registers and have lengths known at compile time, so that gcc
  /// turns them into vector instructions.
  template <unsigned int degree>
  class HexKernel : public ElementKernel
  {
  public:
    static constexpr unsigned int n_nodes = (degree + 1) * (degree + 1) * (degree + 1);
    static constexpr unsigned int n_q     = n_nodes;
#ifdef __AVX512F__
    static constexpr unsigned int width = 8;
#else
    static constexpr unsigned int width = 4;
#endif
    static constexpr unsigned int padded = (n_nodes + width - 1) / width * width;

    explicit HexKernel(const dealii::FiniteElement<dim> &fe)
    {
      const dealii::QGauss<dim> quadrature(degree + 1);
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          dof_[a][i] = fe.component_to_system_index(i, a);
      for (unsigned int q = 0; q < n_q; ++q)
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int e = 0; e < dim; ++e)
            unit_gradient_[q][e][a] = fe.base_element(0).shape_grad(a, quadrature.point(q))[e];
    }

    double integrate(const QuadraturePoint      *points,
                     const Material             &material,
                     const std::vector<double>  &u,
                     dealii::Vector<double>     &force,
                     dealii::FullMatrix<double> *stiffness) override
    {
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          u_[i][a] = u[dof_[a][i]];
      std::fill_n(&force_[0][0], dim * padded, 0.);

      double min_det_F = 1.;
      for (unsigned int q = 0; q < n_q; ++q)
      {
        const dealii::Tensor<2, dim> F = deformation_gradient(points[q], q);
        if (!material.small_strain())
        {
          const double det_F = determinant(F);
          if (!(det_F > 0.)) // true for NaN, too
            return det_F;
          min_det_F = std::min(min_det_F, det_F);
        }
        dealii::SymmetricTensor<2, dim> S;
        if (stiffness)
        {
          material.evaluate(F, S, &C_);
          set_moduli(F, S, material.small_strain(), points[q].JxW, moduli_[q]);
        }
        else
          material.evaluate(F, S, nullptr);
        add_force(F, S, material.small_strain(), points[q].JxW, q);
      }
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          force[dof_[a][i]] = force_[i][a];
      if (stiffness)
        for (unsigned int a = 0; a < n_nodes; ++a)
          set_rows(a, *stiffness);
      return min_det_F;
    }

  private:
    typedef double Lanes __attribute__((vector_size(width * sizeof(double))));
    using Moduli = double[dim * dim][dim * dim]; ///< dP_iJ/dF_kL in [3i+J][3k+L]

    /// Also leaves the gradients of the shape functions in gradient_[q].
    dealii::Tensor<2, dim> deformation_gradient(const QuadraturePoint &point, const unsigned int q)
    {
      for (unsigned int J = 0; J < dim; ++J)
        for (unsigned int b = 0; b < padded; ++b)
          gradient_[q][J][b] = point.inverse_jacobian[0][J] * unit_gradient_[q][0][b] +
                               point.inverse_jacobian[1][J] * unit_gradient_[q][1][b] +
                               point.inverse_jacobian[2][J] * unit_gradient_[q][2][b];
      dealii::Tensor<2, dim> F;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int J = 0; J < dim; ++J)
        {
          // one partial sum per vector lane: the compiler may not reorder a plain sum
          double partial[width] = {};
          for (unsigned int b = 0; b < padded; b += width)
            for (unsigned int v = 0; v < width; ++v)
              partial[v] += u_[i][b + v] * gradient_[q][J][b + v];
          F[i][J] = std::accumulate(partial, partial + width, i == J ? 1. : 0.);
        }
      return F;
    }

    void add_force(const dealii::Tensor<2, dim>          &F,
                   const dealii::SymmetricTensor<2, dim> &S,
                   const bool                             small_strain,
                   const double                           JxW,
                   const unsigned int                     q)
    {
      const dealii::Tensor<2, dim> stress(S);
      const dealii::Tensor<2, dim> P = (small_strain ? stress : F * stress) * JxW;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int b = 0; b < padded; ++b)
          force_[i][b] += P[i][0] * gradient_[q][0][b] + P[i][1] * gradient_[q][1][b] + P[i][2] * gradient_[q][2][b];
    }

    /// JxW dP/dF from the material and the geometric part.
    void set_moduli(const dealii::Tensor<2, dim>          &F_in,
                    const dealii::SymmetricTensor<2, dim> &S,
                    const bool                             small_strain,
                    const double                           JxW,
                    Moduli                                &A) const
    {
      // row or column of the 6x6 storage of C that holds the pair (I, J)
      constexpr unsigned int pair[dim][dim] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

      double F[dim][dim], half[6][dim * dim];
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int J = 0; J < dim; ++J)
          F[i][J] = small_strain ? (i == J ? 1. : 0.) : F_in[i][J];
      for (unsigned int r = 0; r < 6; ++r)
      {
        double row[6];
        for (unsigned int c = 0; c < 6; ++c)
          row[c] = JxW * C_.access_raw_entry(6 * r + c);
        for (unsigned int k = 0; k < dim; ++k)
          for (unsigned int L = 0; L < dim; ++L)
            half[r][dim * k + L] = row[pair[0][L]] * F[k][0] + row[pair[1][L]] * F[k][1] + row[pair[2][L]] * F[k][2];
      }
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int J = 0; J < dim; ++J)
          for (unsigned int kL = 0; kL < dim * dim; ++kL)
            A[dim * i + J][kL] =
                F[i][0] * half[pair[0][J]][kL] + F[i][1] * half[pair[1][J]][kL] + F[i][2] * half[pair[2][J]][kL];
      if (!small_strain)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int J = 0; J < dim; ++J)
            for (unsigned int L = 0; L < dim; ++L)
              A[dim * i + J][dim * i + L] += JxW * S[J][L];
    }

    /// Rows of node @p a: computed for the nodes b of its vector and the later ones, mirrored for the others.
    void set_rows(const unsigned int a, dealii::FullMatrix<double> &stiffness)
    {
      double T[n_q][dim][dim * dim];
      for (unsigned int q = 0; q < n_q; ++q)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int kL = 0; kL < dim * dim; ++kL)
            T[q][i][kL] = gradient_[q][0][a] * moduli_[q][dim * i][kL] +
                          gradient_[q][1][a] * moduli_[q][dim * i + 1][kL] +
                          gradient_[q][2][a] * moduli_[q][dim * i + 2][kL];

      for (unsigned int first = a / width * width; first < n_nodes; first += width)
      {
        // the nine sums stay in registers
        Lanes K[dim][dim] = {};
        for (unsigned int q = 0; q < n_q; ++q)
        {
          Lanes g[dim];
          for (unsigned int L = 0; L < dim; ++L)
            std::memcpy(&g[L], &gradient_[q][L][first], sizeof(Lanes));
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int k = 0; k < dim; ++k)
              K[i][k] += T[q][i][dim * k] * g[0] + T[q][i][dim * k + 1] * g[1] + T[q][i][dim * k + 2] * g[2];
        }
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int b = std::max(first, i <= k ? a : a + 1); b < std::min(first + width, n_nodes); ++b)
            {
              stiffness(dof_[a][i], dof_[b][k]) = K[i][k][b - first];
              stiffness(dof_[b][k], dof_[a][i]) = K[i][k][b - first];
            }
      }
    }

    unsigned int dof_[n_nodes][dim];
    alignas(64) double unit_gradient_[n_q][dim][padded] = {};
    alignas(64) double gradient_[n_q][dim][padded];
    alignas(64) double u_[dim][padded] = {};
    alignas(64) double force_[dim][padded];
    Moduli                          moduli_[n_q];
    dealii::SymmetricTensor<4, dim> C_;
  };

  inline std::unique_ptr<ElementKernel> ElementKernel::make(const dealii::FiniteElement<dim> &fe)
  {
    if (fe.degree == 1)
      return std::make_unique<HexKernel<1>>(fe);
    if (fe.degree == 2)
      return std::make_unique<HexKernel<2>>(fe);
    throw InputError("The degree of the displacement is " + std::to_string(fe.degree) + "; it must be 1 or 2");
  }
} // namespace Nodus

#endif
