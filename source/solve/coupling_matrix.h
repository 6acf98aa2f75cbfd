#ifndef nodus_solve_coupling_matrix_h
#define nodus_solve_coupling_matrix_h

#include "parallel/ghost_exchange.h"
#include "parallel/ownership.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace Nodus
{
  /// Distributed matrix with entries in few rows and columns, as contact couples the displacements of few nodes:
  /// products pass over those alone, and the others take no memory. Vectors hold the owned values of the range or the
  /// domain.
  class CouplingMatrix
  {
  public:
    /// @param entries of owned rows, sorted by row, each place once. Collective.
    CouplingMatrix(const std::vector<MatrixEntry> &entries, const Ownership &range, const Ownership &domain);

    /// y += factor A x. Collective.
    void add_product(const double *x, double *y, double factor = 1.) const;
    /// y += factor A^T x. Collective.
    void add_transposed_product(const double *x, double *y, double factor = 1.) const;

    void scale_rows(const std::vector<double> &factor);
    /// Collective.
    void scale_columns(const std::vector<double> &factor);
    /// Sum of the squares of all entries, over all ranks. Collective.
    double norm_squared() const;

    /// Columns with entries have local numbers, which this turns into global ones.
    const std::vector<DoFIndex> &columns() const
    {
      return columns_;
    }
    /// Values of @p x at those columns; valid until the next product. Collective.
    const double *at_columns(const double *x) const;
    /// Calls f(local column, value) for the entries of a row, an index into vectors over the range.
    template <typename Function>
    void for_row(unsigned int row, const Function &f) const;

  private:
    const MPI_Comm              communicator_;
    std::vector<std::uint32_t>  rows_, start_, column_; ///< rows with entries, where those start, local columns
    std::vector<double>         value_;
    std::vector<DoFIndex>       columns_;  ///< owned, then others, ascending in each part
    std::vector<std::uint32_t>  position_; ///< of the owned columns, in vectors over the domain
    GhostExchange               exchange_;
    mutable std::vector<double> at_columns_;
  };

  template <typename Function>
  void CouplingMatrix::for_row(const unsigned int row, const Function &f) const
  {
    const auto found = std::lower_bound(rows_.begin(), rows_.end(), row);
    if (found == rows_.end() || *found != row)
      return;
    const std::size_t i = found - rows_.begin();
    for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
      f(column_[k], value_[k]);
  }
} // namespace Nodus

#endif
