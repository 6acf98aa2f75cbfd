#include "bulk/hex_kernel.h"
#include "bulk/mean_dilatation_kernel.h"

namespace Nodus
{
  namespace
  {
    template <unsigned int degree>
    class StandardKernel : public HexKernel<degree>
    {
    public:
      using Base = HexKernel<degree>;
      using Base::Base;
      using typename Base::History;
      using typename Base::QuadraturePoint;

      void integrate(const QuadraturePoint *points,
                     const Material        &material,
                     const Lanes           *u,
                     const Lanes *,
                     const History &history,
                     Lanes         *force,
                     Lanes         *stiffness,
                     Lanes         &det_F,
                     Lanes         *energy) override
      {
        const bool         small_strain = material.small_strain();
        const unsigned int n_state      = material.n_state();
        std::fill_n(force, dim * n_nodes, Lanes{});
        det_F = Lanes{} + 1.;
        if (energy)
          *energy = Lanes{};
        for (unsigned int q = 0; q < n_q; ++q)
        {
          Lanes F[dim][dim], S[n_pairs], C[n_pairs][n_pairs];
          this->deformation_gradient(points[q], u, q, F);
          if (!small_strain)
          {
            Lanes here;
            determinant(F, here);
            if (!Base::note_smallest(here, det_F))
              return;
          }
          Lanes density;
          material.update_lanes(F,
                                history.before + q * n_state,
                                history.after + q * n_state,
                                S,
                                stiffness ? &C : nullptr,
                                energy ? &density : nullptr);
          if (energy)
            *energy += points[q].JxW * density;
          for (Lanes &s : S)
            s *= points[q].JxW;
          add_force(F, S, small_strain, q, force);
          if (stiffness)
            set_moduli(F, S, C, small_strain, points[q].JxW, moduli_[q]);
        }
        if (stiffness)
          for (unsigned int a = 0; a < n_nodes; ++a)
            stiffness = this->set_row(a, stiffness);
      }

      void deformation(const QuadraturePoint *points,
                       const bool,
                       const Lanes                        *u,
                       ElementKernel::DeformationGradient *F) override
      {
        for (unsigned int q = 0; q < n_q; ++q)
          this->deformation_gradient(points[q], u, q, F[q].F);
      }

    private:
      using Base::gradient_, Base::moduli_, Base::n_nodes, Base::n_q;
      using typename Base::Moduli;

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

      /// JxW dP/dF from the material and, with @p S times JxW, the geometric part (eq. B2).
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
    };
  } // namespace

  std::unique_ptr<ElementKernel> ElementKernel::make(const dealii::FiniteElement<dim>         &fe,
                                                     const BodyParameters::VolumetricTreatment treatment)
  {
    if (fe.degree != 1 && fe.degree != 2)
      throw InputError("The degree of the displacement is " + std::to_string(fe.degree) + "; it must be 1 or 2");
    if (treatment == BodyParameters::VolumetricTreatment::mean_dilatation)
      return make_mean_dilatation_kernel(fe);
    if (fe.degree == 1)
      return std::make_unique<StandardKernel<1>>(fe);
    return std::make_unique<StandardKernel<2>>(fe);
  }
} // namespace Nodus
