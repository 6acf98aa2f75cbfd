#include "bulk/principal_law.h"

#include <cmath>
#include <limits>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    /// Turns of axes up to this leave ones that are less than round-off: the sweep after them turns by their square,
    /// and by their third power where eigenvalues are apart.
    constexpr double smallest_turn = 1e-8;

    inline void sqrt(const Lanes &x, Lanes &result)
    {
      for (unsigned int v = 0; v < n_lanes; ++v)
        result[v] = std::sqrt(x[v]);
    }

    /// Eigenvalues and eigenvectors n[axis] of a symmetric tensor: cyclic Jacobi (Golub & Van Loan, Matrix
    /// Computations, section 8.5). Convergence is quadratic; after five sweeps, 3x3 matrices are diagonal to round-off,
    /// and after one that turns by less than the root of that.
    void find_axes(const Lanes (&tensor)[n_pairs], Lanes (&value)[dim], Lanes (&n)[dim][dim])
    {
      Lanes A[dim][dim];
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
        {
          A[i][j] = tensor[pair_index[i][j]];
          n[i][j] = Lanes{} + (i == j ? 1. : 0.);
        }
      bool turns = true;
      for (unsigned int sweep = 0; sweep < 5 && turns; ++sweep)
      {
        Lanes turned{}; // squares of the tangents
        for (unsigned int r = 0; r < dim; ++r)
        {
          const unsigned int p = (r + 1) % dim, q = (r + 2) % dim;
          const Lanes        twice = 2. * A[p][q], difference = A[q][q] - A[p][p];
          Lanes              root = {}, cosine = {};
          sqrt(difference * difference + twice * twice, root);
          // the tangent of the smaller angle; 0 for a diagonal matrix
          const Lanes denominator = (difference >= 0. ? difference + root : difference - root);
          const Lanes tangent     = twice / (denominator == 0. ? Lanes{} + 1. : denominator);
          turned += tangent * tangent;
          sqrt(1. + tangent * tangent, cosine);
          cosine           = 1. / cosine;
          const Lanes sine = tangent * cosine, moved = tangent * A[p][q];
          A[p][p] -= moved;
          A[q][q] += moved;
          A[p][q] = A[q][p]  = Lanes{};
          const Lanes with_p = A[r][p], with_q = A[r][q];
          A[r][p] = A[p][r] = cosine * with_p - sine * with_q;
          A[r][q] = A[q][r] = sine * with_p + cosine * with_q;
          for (unsigned int i = 0; i < dim; ++i)
          {
            const Lanes n_p = n[p][i], n_q = n[q][i];
            n[p][i] = cosine * n_p - sine * n_q;
            n[q][i] = sine * n_p + cosine * n_q;
          }
        }
        turns = false;
        for (unsigned int v = 0; v < n_lanes; ++v)
          turns = turns || !(turned[v] < smallest_turn * smallest_turn);
      }
      for (unsigned int a = 0; a < dim; ++a)
        value[a] = A[a][a];
    }

    /// result[axis] = F^-1 n[axis]
    void pull_back(const Lanes (&F)[dim][dim], const Lanes (&n)[dim][dim], Lanes (&result)[dim][dim])
    {
      Lanes J;
      determinant(F, J);
      const Lanes factor = 1. / J;
      for (unsigned int I = 0; I < dim; ++I)
      {
        Lanes inverse_row[dim]; // cofactors
        for (unsigned int i = 0; i < dim; ++i)
        {
          const unsigned int j = (i + 1) % dim, k = (i + 2) % dim, K = (I + 1) % dim, L = (I + 2) % dim;
          inverse_row[i] = factor * (F[j][K] * F[k][L] - F[j][L] * F[k][K]);
        }
        for (unsigned int a = 0; a < dim; ++a)
          result[a][I] = inverse_row[0] * n[a][0] + inverse_row[1] * n[a][1] + inverse_row[2] * n[a][2];
      }
    }

    /// z coth z
    double z_coth(const double z)
    {
      return std::abs(z) < 1e-4 ? 1. + z * z / 3. : z / std::tanh(z);
    }

    void copy_to_lanes(const Tensor<2, dim> &F, Lanes (&result)[dim][dim])
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int J = 0; J < dim; ++J)
          result[i][J] = Lanes{} + F[i][J];
    }
  } // namespace

  void PrincipalLaw::update_lanes(const Lanes (&F)[dim][dim],
                                  const Lanes *before,
                                  Lanes       *after,
                                  Lanes (&S)[n_pairs],
                                  Lanes (*C)[n_pairs][n_pairs],
                                  Lanes *energy) const
  {
    respond_lanes(F, before, n_state() > 0 ? after : nullptr, S, C, energy);
  }

  void PrincipalLaw::stress_and_energy_lanes(const Lanes (&F)[dim][dim],
                                             const Lanes *const state,
                                             Lanes (&S)[n_pairs],
                                             Lanes &energy) const
  {
    respond_lanes(F, state, nullptr, S, nullptr, &energy);
  }

  void PrincipalLaw::respond_lanes(const Lanes (&F)[dim][dim],
                                   const Lanes *const before,
                                   Lanes *const       after,
                                   Lanes (&S)[n_pairs],
                                   Lanes (*const C)[n_pairs][n_pairs],
                                   Lanes *const energy) const
  {
    const bool has_history = n_state() > 0;
    Lanes      b[n_pairs], stretch_squared[dim], n[dim][dim], N[dim][dim];
    push_forward(F, has_history ? before : nullptr, b);
    find_axes(b, stretch_squared, n);
    pull_back(F, n, N);

    Lanes stress[dim], on_axes[dim][dim], mixed[dim], elastic_squared[dim];
    for (unsigned int v = 0; v < n_lanes; ++v)
    {
      Principal principal;
      for (unsigned int a = 0; a < dim; ++a)
        principal.strain[a] = std::log(stretch_squared[a][v]) / 2.;
      if (has_history)
        principal.plastic_strain = before[n_pairs][v];
      respond(principal);
      if (energy)
        (*energy)[v] = energy_of(after ? principal.elastic_strain : principal.strain);
      for (unsigned int a = 0; a < dim; ++a)
      {
        stress[a][v] = principal.stress[a];
        if (after)
          elastic_squared[a][v] = std::exp(2. * principal.elastic_strain[a]);
        if (!C)
          continue;
        for (unsigned int c = 0; c < dim; ++c)
          on_axes[a][c][v] = principal.modulus[a][c] - (a == c ? 2. * principal.stress[a] : 0.);
        const unsigned int c = (a + 1) % dim, d = (a + 2) % dim;
        const double       z = principal.strain[c] - principal.strain[d];
        mixed[a][v]          = (principal.secant[a] * z_coth(z) - principal.stress[c] - principal.stress[d]) / 2.;
      }
      if (after)
        after[n_pairs][v] = principal.plastic_strain;
    }

    Lanes square[dim][n_pairs]; // N_a (x) N_a
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int r = 0; r < n_pairs; ++r)
        square[a][r] = N[a][pair_first[r]] * N[a][pair_second[r]];
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      S[r] = stress[0] * square[0][r] + stress[1] * square[1][r] + stress[2] * square[2][r];
      if (after)
        after[r] =
            elastic_squared[0] * square[0][r] + elastic_squared[1] * square[1][r] + elastic_squared[2] * square[2][r];
    }
    if (!C)
      return;
    Lanes M[dim][n_pairs]; // of the two other axes
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int r = 0; r < n_pairs; ++r)
      {
        const unsigned int c = (a + 1) % dim, d = (a + 2) % dim, i = pair_first[r], j = pair_second[r];
        M[a][r] = N[c][i] * N[d][j] + N[d][i] * N[c][j];
      }
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      Lanes row[dim];
      for (unsigned int a = 0; a < dim; ++a)
        row[a] = square[0][r] * on_axes[0][a] + square[1][r] * on_axes[1][a] + square[2][r] * on_axes[2][a];
      for (unsigned int c = r; c < n_pairs; ++c)
      {
        Lanes sum{};
        for (unsigned int a = 0; a < dim; ++a)
          sum += row[a] * square[a][c] + mixed[a] * M[a][r] * M[a][c];
        (*C)[r][c] = (*C)[c][r] = sum;
      }
    }
  }

  void PrincipalLaw::evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const
  {
    double initial[history_size] = {};
    Lanes  before[history_size];
    set_initial(initial);
    for (unsigned int s = 0; s < history_size; ++s)
      before[s] = Lanes{} + initial[s];
    respond_lanes(F, before, nullptr, S, C, nullptr);
  }

  void PrincipalLaw::update(const Tensor<2, dim>    &F,
                            const double            *before,
                            double                  *after,
                            SymmetricTensor<2, dim> &S,
                            SymmetricTensor<4, dim> *C) const
  {
    Lanes F_lanes[dim][dim], S_lanes[n_pairs], C_lanes[n_pairs][n_pairs];
    Lanes before_lanes[history_size], after_lanes[history_size];
    copy_to_lanes(F, F_lanes);
    for (unsigned int s = 0; s < n_state(); ++s)
      before_lanes[s] = Lanes{} + before[s];
    update_lanes(F_lanes, before_lanes, after_lanes, S_lanes, C ? &C_lanes : nullptr, nullptr);
    for (unsigned int s = 0; s < n_state(); ++s)
      after[s] = after_lanes[s][0];
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      S.access_raw_entry(r) = S_lanes[r][0];
      for (unsigned int c = 0; C && c < n_pairs; ++c)
        C->access_raw_entry(n_pairs * r + c) = C_lanes[r][c][0];
    }
  }

  void PrincipalLaw::evaluate(const Tensor<2, dim> &F, SymmetricTensor<2, dim> &S, SymmetricTensor<4, dim> *C) const
  {
    double before[history_size], after[history_size];
    set_initial(before);
    update(F, before, after, S, C);
  }

  double PrincipalLaw::stored_energy(const Tensor<2, dim> &F, const double *const state) const
  {
    Lanes F_lanes[dim][dim], plastic[n_pairs], b[n_pairs], stretch_squared[dim], n[dim][dim];
    copy_to_lanes(F, F_lanes);
    if (n_state() > 0)
      for (unsigned int r = 0; r < n_pairs; ++r)
        plastic[r] = Lanes{} + state[r];
    push_forward(F_lanes, n_state() > 0 ? plastic : nullptr, b);
    find_axes(b, stretch_squared, n);
    double strain[dim];
    for (unsigned int a = 0; a < dim; ++a)
      strain[a] = std::log(stretch_squared[a][0]) / 2.;
    return energy_of(strain);
  }

  double PrincipalLaw::energy(const Tensor<2, dim> &F) const
  {
    double                  before[history_size], after[history_size];
    SymmetricTensor<2, dim> S;
    set_initial(before);
    update(F, before, after, S, nullptr);
    return stored_energy(F, after);
  }

  /// Plastic flow keeps the volume, and the equivalent plastic strain is not negative.
  void PrincipalLaw::correct_state(double *const state) const
  {
    if (n_state() == 0)
      return;
    SymmetricTensor<2, dim> C_p_inverse;
    for (unsigned int r = 0; r < n_pairs; ++r)
      C_p_inverse[pair_first[r]][pair_second[r]] = state[r];
    const double scale = 1. / std::cbrt(determinant(C_p_inverse));
    for (unsigned int r = 0; r < n_pairs; ++r)
      state[r] *= scale;
    state[n_pairs] = std::max(state[n_pairs], 0.);
  }
} // namespace Nodus
