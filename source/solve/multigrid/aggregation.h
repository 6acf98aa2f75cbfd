#ifndef nodus_solve_multigrid_aggregation_h
#define nodus_solve_multigrid_aggregation_h

#include "solve/constrained_matrix.h"
#include "solve/multigrid/prolongation.h"

#include <array>
#include <memory>
#include <vector>

namespace Nodus
{
  /// From a level of smoothed aggregation (Vanek, Mandel, Brezina 1996) to the next coarser one (eq. M4), in node
  /// blocks: six unknowns for each aggregate of nodes, which combine the six modes there. On the coarse level they are
  /// two nodes.
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

    static constexpr unsigned int n_modes = Prolongation::n_modes;

  private:
    static constexpr unsigned int block_size = Prolongation::block_size;

    void aggregate(const BlockCsrMatrix &K, const std::vector<double> &modes);
    void make_tentative(std::vector<double> modes);
    void smooth(const BlockCsrMatrix &K, const std::vector<std::array<double, 9>> &D_inverse, double omega);

    /// Calls f(row) for those without columns of other ranks.
    template <typename Function>
    void for_interior_rows(const Function &f) const;

    const ConstrainedMatrix    &A_;
    const NodeMap              &nodes_;
    Prolongation                P_;
    std::vector<unsigned int>   aggregate_; ///< of the owned nodes, or invalid
    std::vector<double>         tentative_; ///< like modes; while P is made
    std::vector<double>         coarse_modes_;
    std::vector<std::uint32_t>  interface_; ///< rows with columns of other ranks
    GhostExchange               exchange_;
    mutable std::vector<double> ghost_values_; ///< six per ghost
  };
} // namespace Nodus

#endif
