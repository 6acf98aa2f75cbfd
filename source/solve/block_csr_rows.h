#ifndef nodus_solve_block_csr_rows_h
#define nodus_solve_block_csr_rows_h

#include "solve/block_csr_matrix.h"

#include <vector>

namespace Nodus
{
  /// Products with some rows of a BlockCsrMatrix, which are its columns too. Ranks exchange what those rows need, and
  /// ranks that have none of them and no neighbours of theirs do not wait for the others.
  class BlockCsrRows
  {
  public:
    /// Keeps a reference to @p matrix. @param nodes local, ghosts included, each on all ranks that have it. Collective.
    BlockCsrRows(const BlockCsrMatrix &matrix, std::vector<unsigned int> nodes);

    /// y = A x at the owned ones among the nodes; other values of y are not touched. Collective.
    void vmult(double *y, const double *x) const;
    /// y = A x where x vanishes but at the nodes. Collective.
    void vmult_columns(double *y, const double *x) const;

  private:
    NodeValues with_ghosts(const double *x) const;

    const BlockCsrMatrix           &matrix_;
    const std::vector<unsigned int> nodes_;
    std::vector<unsigned int>       ghosts_; ///< local nodes whose values are needed
    GhostExchange                   exchange_;
    mutable std::vector<double>     received_;     ///< at these
    mutable std::vector<double>     ghost_values_; ///< at all ghosts of the matrix
  };
} // namespace Nodus

#endif
