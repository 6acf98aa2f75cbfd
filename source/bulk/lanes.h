#ifndef nodus_bulk_lanes_h
#define nodus_bulk_lanes_h

#include <nodus/base/types.h>

#include <cmath>

namespace Nodus
{
  /// One value for each of the cells that are worked on at once, in a vector register. The number does not follow the
  /// machine, because translation units are built for different ones; 8 was slower with AVX-512 on Zen 4.
  constexpr unsigned int n_lanes = 4;
  typedef double         Lanes __attribute__((vector_size(n_lanes * sizeof(double))));

  // Functions take references: how vectors are passed by value depends on the machine that is compiled for.

  inline void log(const Lanes &x, Lanes &result)
  {
    for (unsigned int v = 0; v < n_lanes; ++v)
      result[v] = std::log(x[v]);
  }

  inline void determinant(const Lanes (&F)[dim][dim], Lanes &result)
  {
    result = F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) + F[0][1] * (F[1][2] * F[2][0] - F[1][0] * F[2][2]) +
             F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
  }

  // Symmetric tensors have the components 00, 11, 22, 01, 02, 12, as in deal.II.
  constexpr unsigned int n_pairs          = 6;
  constexpr unsigned int pair_index[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  constexpr unsigned int pair_first[6]    = {0, 1, 2, 0, 0, 1};
  constexpr unsigned int pair_second[6]   = {0, 1, 2, 1, 2, 2};

  /// F G F^T; G null: the identity
  inline void push_forward(const Lanes (&F)[dim][dim], const Lanes *G, Lanes (&result)[n_pairs])
  {
    Lanes FG[dim][dim];
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int J = 0; J < dim; ++J)
        FG[i][J] =
            G ? F[i][0] * G[pair_index[0][J]] + F[i][1] * G[pair_index[1][J]] + F[i][2] * G[pair_index[2][J]] : F[i][J];
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      const unsigned int i = pair_first[r], j = pair_second[r];
      result[r] = FG[i][0] * F[j][0] + FG[i][1] * F[j][1] + FG[i][2] * F[j][2];
    }
  }

  /// F^T F
  inline void right_cauchy_green(const Lanes (&F)[dim][dim], Lanes (&result)[n_pairs])
  {
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      const unsigned int I = pair_first[r], J = pair_second[r];
      result[r] = F[0][I] * F[0][J] + F[1][I] * F[1][J] + F[2][I] * F[2][J];
    }
  }

  inline void invert(const Lanes (&A)[n_pairs], const Lanes &determinant, Lanes (&result)[n_pairs])
  {
    const Lanes factor = 1. / determinant;
    result[0]          = factor * (A[1] * A[2] - A[5] * A[5]);
    result[1]          = factor * (A[0] * A[2] - A[4] * A[4]);
    result[2]          = factor * (A[0] * A[1] - A[3] * A[3]);
    result[3]          = factor * (A[4] * A[5] - A[3] * A[2]);
    result[4]          = factor * (A[3] * A[5] - A[4] * A[1]);
    result[5]          = factor * (A[3] * A[4] - A[5] * A[0]);
  }

  /// (A_ik A_jl + A_il A_jk) in row r = (i, j), column c = (k, l)
  inline void square(const Lanes (&A)[n_pairs], const unsigned int r, const unsigned int c, Lanes &result)
  {
    const unsigned int i = pair_first[r], j = pair_second[r], k = pair_first[c], l = pair_second[c];
    result = A[pair_index[i][k]] * A[pair_index[j][l]] + A[pair_index[i][l]] * A[pair_index[j][k]];
  }
} // namespace Nodus

#endif
