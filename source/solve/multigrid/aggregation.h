#ifndef nodus_solve_multigrid_aggregation_h
#define nodus_solve_multigrid_aggregation_h

#include "solve/constrained_matrix.h"

#include <Eigen/Core>

#include <array>
#include <memory>
#include <vector>

namespace Nodus
{
  /// From a level of smoothed aggregation (Vanek, Mandel, Brezina 1996) to the next coarser one, in node blocks: six
  /// unknowns for each aggregate of nodes, which combine the six modes there. On the coarse level they are two nodes.
  ///
  ///     P = (1 - omega D^-1 A) P_0,   A_coarse = P^T A P
  ///
  /// P_0 holds the modes of each aggregate, orthonormal. Blocks need a ninth of the indices of a general sparse matrix,
  /// and their products fill vector registers.
  class Aggregation
  {
  public:
    /// Keeps a reference to @p A, not to @p K of which it was made. @param modes of the owned displacements, six one
    /// after the other @param D_inverse of the owned nodes, row by row. Collective.
    Aggregation(const BlockCsrMatrix                     &K,
                const ConstrainedMatrix                  &A,
                std::vector<double>                       modes,
                const std::vector<std::array<double, 9>> &D_inverse,
                double                                    omega);

    /// P^T A P for the arguments of the constructor. Collective.
    std::unique_ptr<BlockCsrMatrix> make_coarse_matrix(const BlockCsrMatrix &K) const;
    /// The modes in the owned unknowns of the coarse level, six one after the other; to be taken.
    std::vector<double> &modes()
    {
      return coarse_modes_;
    }
    /// coarse = P^T fine. Collective.
    void restrict_to(double *coarse, const double *fine) const;
    /// fine += P coarse. Collective.
    void add_prolongation(double *fine, const double *coarse) const;

    static constexpr unsigned int n_modes = 6;

  private:
    static constexpr unsigned int block_size = dim * n_modes;

    void aggregate(const BlockCsrMatrix &K, const std::vector<double> &modes);
    void make_tentative(std::vector<double> modes);
    void smooth(const BlockCsrMatrix &K, const std::vector<std::array<double, 9>> &D_inverse, double omega);

    /// Calls f(row) for those without columns of other ranks.
    template <typename Function>
    void for_interior_rows(const Function &f) const;
    bool owned(const DoFIndex aggregate) const
    {
      return aggregate >= first_ && aggregate < first_ + n_aggregates_;
    }
    DoFIndex global_aggregate(const unsigned int a) const
    {
      return a < n_aggregates_ ? first_ + a : ghosts_[a - n_aggregates_];
    }

    const ConstrainedMatrix  &A_;
    const NodeMap            &nodes_;
    unsigned int              n_aggregates_ = 0; ///< owned
    std::vector<DoFIndex>     starts_;           ///< of the aggregates of each rank, and the number of all
    DoFIndex                  first_ = 0;
    std::vector<DoFIndex>     ghosts_;    ///< aggregates of other ranks, ascending
    std::vector<unsigned int> aggregate_; ///< of the owned nodes, or invalid
    std::vector<double>       tentative_; ///< like modes; while P is made
    std::vector<double>       coarse_modes_;
    // P: per entry a local aggregate and three displacements by six modes, row by row. Single precision halves what a
    // cycle reads; P^T A P belongs to the rounded P.
    std::vector<std::uint32_t>  start_, column_;
    std::vector<float>          blocks_;
    std::vector<std::uint32_t>  interface_; ///< rows with columns of other ranks
    GhostExchange               exchange_;
    mutable std::vector<double> ghost_values_; ///< six per ghost
  };
} // namespace Nodus

#endif
