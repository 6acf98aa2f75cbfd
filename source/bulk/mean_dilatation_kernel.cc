#include "bulk/mean_dilatation_kernel.h"
#include "bulk/dilatation_modes.h"
#include "bulk/hex_kernel.h"

#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Everything is written with the gradients d of displacements in the current configuration (for small strain they
    /// are those in the reference one): a change of F makes d = dF F^-1 and that of Fbar d + (dtheta/theta - tr d)/3 I.
    template <unsigned int degree>
    class MeanDilatationKernel : public HexKernel<degree>
    {
    public:
      using Base = HexKernel<degree>;
      using Base::Base;
      using typename Base::History;
      using typename Base::QuadraturePoint;
      static constexpr unsigned int n_nodes = Base::n_nodes, n_q = Base::n_q;
      static constexpr unsigned int n_modes = DilatationModes<degree>::n_modes;

      void integrate(const QuadraturePoint *points,
                     const Material        &material,
                     const Lanes           *u,
                     const Lanes           *u_before,
                     const History         &history,
                     Lanes                 *force,
                     Lanes                 *stiffness,
                     Lanes                 &det_F,
                     Lanes                 *energy) override
      {
        const bool         small_strain = material.small_strain();
        const unsigned int n_state      = material.n_state();
        std::fill_n(force, dim * n_nodes, Lanes{});
        det_F                   = Lanes{} + 1.;
        const bool extrapolated = u_before && stiffness && !small_strain;
        Lanes      dilatation[n_modes];
        if (extrapolated)
          extrapolate(points, u_before, u, dilatation);
        if (!set_deformation(points, small_strain, u, det_F))
          return;

        Lanes pressure[n_modes] = {};
        if (energy)
          *energy = Lanes{};
        if (stiffness)
          for (unsigned int k = 0; k < n_modes; ++k)
          {
            std::fill_n(&volume_[k][0], dim * n_nodes, Lanes{});
            std::fill_n(&coupling_[k][0], dim * n_nodes, Lanes{});
            std::fill_n(bulk_[k], n_modes, Lanes{});
          }
        for (unsigned int q = 0; q < n_q; ++q)
        {
          Lanes S[n_pairs], C[n_pairs][n_pairs], density;
          material.update_lanes(F_[q],
                                history.before + q * n_state,
                                history.after + q * n_state,
                                S,
                                stiffness ? &C : nullptr,
                                energy ? &density : nullptr);
          if (energy)
            *energy += points[q].JxW * density;
          for (Lanes &s : S)
            s *= points[q].JxW;
          add_point(points[q].JxW, small_strain, q, S, stiffness ? &C : nullptr, pressure);
        }
        modes_.solve(pressure);
        Lanes excess[n_modes] = {}; // of the pressure over that of Newton's method
        if (extrapolated)
        {
          modes_.solve(dilatation);
          for (unsigned int k = 0; k < n_modes; ++k)
            for (unsigned int l = 0; l < n_modes; ++l)
              excess[k] += bulk_[k][l] * (dilatation_[l] - dilatation[l]);
          modes_.solve(excess);
        }
        for (unsigned int q = 0; q < n_q; ++q)
        {
          Lanes p, too_much;
          modes_.at_point(q, pressure, p);
          add_force(points[q].JxW, small_strain, p, q, force);
          if (stiffness && !small_strain)
          {
            modes_.at_point(q, excess, too_much);
            add_pressure(points[q].JxW, p - too_much, q);
          }
        }
        if (stiffness)
          set_stiffness(stiffness);
      }

      void deformation(const QuadraturePoint              *points,
                       const bool                          small_strain,
                       const Lanes                        *u,
                       ElementKernel::DeformationGradient *F) override
      {
        Lanes smallest = Lanes{} + 1.;
        set_deformation(points, small_strain, u, smallest);
        for (unsigned int q = 0; q < n_q; ++q)
          std::copy_n(&F_[q][0][0], dim * dim, &F[q].F[0][0]);
      }

      bool has_own_unknowns() const override
      {
        return true;
      }

    private:
      using Base::gradient_, Base::moduli_;

      /// Current gradients, J_, theta_ and Fbar in F_. @returns false when J or theta is not positive somewhere
      bool set_deformation(const QuadraturePoint *points, const bool small_strain, const Lanes *u, Lanes &smallest)
      {
        std::fill_n(dilatation_, n_modes, Lanes{});
        modes_.clear_mass();
        for (unsigned int q = 0; q < n_q; ++q)
        {
          this->deformation_gradient(points[q], u, q, F_[q]);
          if (small_strain)
            J_[q] = F_[q][0][0] + F_[q][1][1] + F_[q][2][2] - 2.;
          else
          {
            determinant(F_[q], J_[q]);
            if (!Base::note_smallest(J_[q], smallest))
              return false;
            move_gradients(q);
          }
          modes_.add_mass(q, points[q].JxW);
          modes_.project(q, points[q].JxW, J_[q], dilatation_);
        }
        modes_.factorise();
        modes_.solve(dilatation_);
        for (unsigned int q = 0; q < n_q; ++q)
        {
          modes_.at_point(q, dilatation_, theta_[q]);
          if (small_strain)
          {
            for (unsigned int i = 0; i < dim; ++i)
              F_[q][i][i] += (theta_[q] - J_[q]) / 3.;
            continue;
          }
          if (!Base::note_smallest(theta_[q], smallest))
            return false;
          Lanes factor;
          for (unsigned int v = 0; v < n_lanes; ++v)
            factor[v] = std::cbrt(theta_[q][v] / J_[q][v]);
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int j = 0; j < dim; ++j)
              F_[q][i][j] *= factor;
        }
        return true;
      }

      /// The dilatation where Newton's method for displacement, pressure and dilatation is after its last correction:
      /// that of @p from and its derivative times the change to @p to. Right-hand side of the projection.
      void extrapolate(const QuadraturePoint *points, const Lanes *from, const Lanes *to, Lanes (&dilatation)[n_modes])
      {
        std::fill_n(dilatation, n_modes, Lanes{});
        for (unsigned int q = 0; q < n_q; ++q)
        {
          Lanes A[dim][dim], B[dim][dim], linear;
          this->deformation_gradient(points[q], from, q, A);
          this->deformation_gradient(points[q], to, q, B);
          determinant(A, linear);
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int I = 0; I < dim; ++I)
            {
              const unsigned int j = (i + 1) % dim, k = (i + 2) % dim, J = (I + 1) % dim, K = (I + 2) % dim;
              linear += (A[j][J] * A[k][K] - A[j][K] * A[k][J]) * (B[i][I] - A[i][I]);
            }
          modes_.project(q, points[q].JxW, linear, dilatation);
        }
      }

      /// From gradients in X to gradients in x.
      void move_gradients(const unsigned int q)
      {
        const Lanes(&F)[dim][dim] = F_[q];
        const Lanes factor        = 1. / J_[q];
        Lanes       inverse[dim][dim]; // dX_J/dx_i in [J][i]
        for (unsigned int J = 0; J < dim; ++J)
          for (unsigned int i = 0; i < dim; ++i)
          {
            const unsigned int j = (i + 1) % dim, k = (i + 2) % dim, K = (J + 1) % dim, L = (J + 2) % dim;
            inverse[J][i] = factor * (F[j][K] * F[k][L] - F[j][L] * F[k][K]);
          }
        for (unsigned int a = 0; a < n_nodes; ++a)
        {
          Lanes(&g)[dim]       = gradient_[q][a];
          const Lanes moved[3] = {g[0] * inverse[0][0] + g[1] * inverse[1][0] + g[2] * inverse[2][0],
                                  g[0] * inverse[0][1] + g[1] * inverse[1][1] + g[2] * inverse[2][1],
                                  g[0] * inverse[0][2] + g[1] * inverse[1][2] + g[2] * inverse[2][2]};
          std::copy_n(moved, dim, g);
        }
      }

      /// Kirchhoff stress in stress_; everything of the stiffness that does not need the pressure.
      /// @param S times JxW @param pressure gets the right-hand side of its projection
      void add_point(const Lanes       &JxW,
                     const bool         small_strain,
                     const unsigned int q,
                     const Lanes (&S)[n_pairs],
                     const Lanes (*C)[n_pairs][n_pairs],
                     Lanes (&pressure)[n_modes])
      {
        Lanes(&tau)[n_pairs] = stress_[q];
        Lanes map[n_pairs][n_pairs]; // of symmetric tensors: Fbar A Fbar^T
        if (small_strain)
          std::copy_n(S, n_pairs, tau);
        else
        {
          set_push_forward(F_[q], map);
          for (unsigned int r = 0; r < n_pairs; ++r)
          {
            tau[r] = map[r][0] * S[0];
            for (unsigned int c = 1; c < n_pairs; ++c)
              tau[r] += map[r][c] * S[c];
          }
        }
        const Lanes trace = tau[0] + tau[1] + tau[2];
        const Lanes rate  = small_strain ? Lanes{} + 1. / 3. : 1. / (3. * theta_[q]); // of Fbar with theta
        modes_.project(q, rate, trace, pressure);
        if (!C)
          return;

        Lanes c[n_pairs][n_pairs];
        if (small_strain)
          for (unsigned int r = 0; r < n_pairs; ++r)
            for (unsigned int s = 0; s < n_pairs; ++s)
              c[r][s] = JxW * (*C)[r][s];
        else
          push_forward(map, *C, JxW, c);

        // derivatives of the energy with the change of volume: n of d and k
        Lanes n[n_pairs];
        for (unsigned int r = 0; r < n_pairs; ++r)
        {
          n[r] = c[r][0] + c[r][1] + c[r][2];
          if (!small_strain)
            n[r] += 2. * tau[r];
        }
        const Lanes k = n[0] + n[1] + n[2];
        Lanes       mixed[n_pairs]; // with theta and d
        for (unsigned int r = 0; r < n_pairs; ++r)
          mixed[r] = rate * (r < dim ? n[r] - k / 3. : n[r]);
        const Lanes second = rate * rate * (small_strain ? k : k - 3. * trace); // twice with theta

        auto &A = moduli_[q];
        for (unsigned int ij = 0; ij < dim * dim; ++ij)
          for (unsigned int kl = ij; kl < dim * dim; ++kl)
          {
            const unsigned int i = ij / dim, j = ij % dim, l = kl % dim, r = pair_index[i][j],
                               s = pair_index[kl / dim][l];
            Lanes sum            = c[r][s];
            if (!small_strain && kl / dim == i)
              sum += tau[pair_index[j][l]];
            if (!small_strain && kl / dim == j && l == i)
              sum += trace / 3.;
            if (i == j)
              sum -= n[s] / 3.;
            if (s < dim)
              sum -= n[r] / 3.;
            if (i == j && s < dim)
              sum += k / 9.;
            A[ij][kl] = A[kl][ij] = sum;
          }
        const Lanes weighted_J = small_strain ? JxW : JxW * J_[q];
        for (unsigned int m = 0; m < n_modes; ++m)
        {
          const double mode = modes_.value(q, m);
          for (unsigned int a = 0; a < n_nodes; ++a)
            for (unsigned int i = 0; i < dim; ++i)
            {
              const Lanes(&g)[dim] = gradient_[q][a];
              volume_[m][dim * a + i] += mode * weighted_J * g[i];
              coupling_[m][dim * a + i] += mode * (mixed[pair_index[i][0]] * g[0] + mixed[pair_index[i][1]] * g[1] +
                                                   mixed[pair_index[i][2]] * g[2]);
            }
          for (unsigned int l = 0; l < n_modes; ++l)
            bulk_[m][l] += mode * modes_.value(q, l) * second;
        }
      }

      void add_force(
          const Lanes &JxW, const bool small_strain, const Lanes &pressure, const unsigned int q, Lanes *force) const
      {
        const Lanes(&tau)[n_pairs] = stress_[q];
        const Lanes mean           = (tau[0] + tau[1] + tau[2]) / 3.;
        const Lanes p              = small_strain ? JxW * pressure : JxW * J_[q] * pressure;
        Lanes       stress[n_pairs];
        for (unsigned int r = 0; r < n_pairs; ++r)
          stress[r] = r < dim ? tau[r] - mean + p : tau[r];
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int i = 0; i < dim; ++i)
            force[dim * a + i] += stress[pair_index[i][0]] * gradient_[q][a][0] +
                                  stress[pair_index[i][1]] * gradient_[q][a][1] +
                                  stress[pair_index[i][2]] * gradient_[q][a][2];
      }

      /// What the pressure adds to the moduli: the second derivative of J.
      void add_pressure(const Lanes &JxW, const Lanes &pressure, const unsigned int q)
      {
        const Lanes p = JxW * J_[q] * pressure;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int k = 0; k < dim; ++k)
          {
            moduli_[q][dim * i + i][dim * k + k] += p;
            moduli_[q][dim * i + k][dim * k + i] -= p;
          }
      }

      void set_stiffness(Lanes *stiffness)
      {
        // theta follows the displacement: volume_ becomes its derivative
        for (unsigned int i = 0; i < dim * n_nodes; ++i)
        {
          Lanes column[n_modes];
          for (unsigned int m = 0; m < n_modes; ++m)
            column[m] = volume_[m][i];
          modes_.solve(column);
          for (unsigned int m = 0; m < n_modes; ++m)
            volume_[m][i] = column[m];
          for (unsigned int m = 0; m < n_modes; ++m)
            for (unsigned int l = 0; l < n_modes; ++l)
              coupling_[m][i] += 0.5 * bulk_[m][l] * column[l];
        }
        for (unsigned int a = 0; a < n_nodes; ++a)
        {
          Lanes *block = stiffness;
          stiffness    = this->set_row(a, stiffness);
          for (unsigned int b = a; b < n_nodes; ++b)
            for (unsigned int i = dim * a; i < dim * (a + 1); ++i)
              for (unsigned int k = dim * b; k < dim * (b + 1); ++k, ++block)
                for (unsigned int m = 0; m < n_modes; ++m)
                  *block += volume_[m][i] * coupling_[m][k] + coupling_[m][i] * volume_[m][k];
        }
      }

      static void set_push_forward(const Lanes (&F)[dim][dim], Lanes (&map)[n_pairs][n_pairs])
      {
        for (unsigned int r = 0; r < n_pairs; ++r)
          for (unsigned int R = 0; R < n_pairs; ++R)
          {
            const unsigned int i = pair_first[r], j = pair_second[r], I = pair_first[R], J = pair_second[R];
            map[r][R] = I == J ? F[i][I] * F[j][I] : F[i][I] * F[j][J] + F[i][J] * F[j][I];
          }
      }

      /// JxW map C map^T
      static void push_forward(const Lanes (&map)[n_pairs][n_pairs],
                               const Lanes (&C)[n_pairs][n_pairs],
                               const Lanes &JxW,
                               Lanes (&result)[n_pairs][n_pairs])
      {
        for (unsigned int r = 0; r < n_pairs; ++r)
        {
          Lanes row[n_pairs] = {};
          for (unsigned int R = 0; R < n_pairs; ++R)
          {
            const Lanes factor = JxW * map[r][R];
            for (unsigned int s = 0; s < n_pairs; ++s)
              row[s] += factor * C[R][s];
          }
          for (unsigned int c = r; c < n_pairs; ++c)
          {
            Lanes sum = row[0] * map[c][0];
            for (unsigned int s = 1; s < n_pairs; ++s)
              sum += row[s] * map[c][s];
            result[r][c] = result[c][r] = sum;
          }
        }
      }

      DilatationModes<degree> modes_;
      Lanes                   dilatation_[n_modes];                                           ///< coefficients of theta
      Lanes                   F_[n_q][dim][dim], J_[n_q], theta_[n_q], stress_[n_q][n_pairs]; ///< stress times JxW
      /// integrals over the cell, by modes: of J grad, of the second derivative of the energy with theta and d, twice
      /// theta
      Lanes volume_[n_modes][dim * n_nodes], coupling_[n_modes][dim * n_nodes], bulk_[n_modes][n_modes];
    };
  } // namespace

  std::unique_ptr<ElementKernel> make_mean_dilatation_kernel(const dealii::FiniteElement<dim> &fe)
  {
    if (fe.degree == 1)
      return std::make_unique<MeanDilatationKernel<1>>(fe);
    return std::make_unique<MeanDilatationKernel<2>>(fe);
  }
} // namespace Nodus
