#ifndef nodus_solve_multigrid_aggregation_h
#define nodus_solve_multigrid_aggregation_h

#include "solve/multigrid/transfer.h"

#include <array>

namespace Nodus
{
  /// Smoothed aggregation (Vanek, Mandel, Brezina 1996; eq. M4): six unknowns for each aggregate of nodes, which
  /// combine the six modes there. On the coarse level they are two nodes.
  ///
  ///     P = (1 - omega D^-1 A) P_0
  ///
  /// P_0 holds the modes of each aggregate, orthonormal.
  class Aggregation : public Transfer
  {
  public:
    /// @param A made of @p K @param modes of the owned displacements, six one after the other @param D_inverse of the
    /// owned nodes, row by row. Collective.
    Aggregation(const BlockCsrMatrix                     &K,
                const ConstrainedMatrix                  &A,
                std::vector<double>                       modes,
                const std::vector<std::array<double, 9>> &D_inverse,
                double                                    omega);

  private:
    void aggregate(const BlockCsrMatrix &K, const std::vector<double> &modes);
    void make_tentative(std::vector<double> modes);
    void smooth(const BlockCsrMatrix                     &K,
                const ConstrainedMatrix                  &A,
                const std::vector<std::array<double, 9>> &D_inverse,
                double                                    omega);

    std::vector<unsigned int> aggregate_; ///< of the owned nodes, or invalid
    std::vector<double>       tentative_; ///< like modes; while P is made
  };
} // namespace Nodus

#endif
