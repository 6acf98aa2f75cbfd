#ifndef nodus_solve_multigrid_coarse_matrix_h
#define nodus_solve_multigrid_coarse_matrix_h

#include "solve/block_csr_matrix.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace Nodus
{
  /// A row of 6x6 blocks between aggregates, by global aggregate.
  class CoarseRow
  {
  public:
    static constexpr unsigned int n_modes = 6;
    /// Row by row, and two more values so that a row can be read as a vector of eight.
    using Block = std::array<double, n_modes * n_modes + 2>;

    /// The block of a column; zero when it is new.
    Block &operator[](const DoFIndex column)
    {
      const auto found = std::lower_bound(
          order_.begin(), order_.end(), column, [](const auto &o, const DoFIndex c) { return o.first < c; });
      if (found != order_.end() && found->first == column)
        return blocks_[found->second];
      if (blocks_.size() == blocks_.capacity())
        blocks_.reserve(blocks_.size() + 9); // doubling would take more memory than the matrix
      order_.emplace(found, column, static_cast<unsigned int>(blocks_.size()));
      return blocks_.emplace_back(Block{});
    }
    /// Calls f(column, block) in ascending order.
    template <typename Function>
    void for_each(const Function &f) const
    {
      for (const auto &[column, k] : order_)
        f(column, blocks_[k]);
    }

  private:
    std::vector<std::pair<DoFIndex, unsigned int>> order_;
    std::vector<Block>                             blocks_;
  };

  /// The matrix whose upper triangle is in @p rows, two nodes of three unknowns for each aggregate: first the owned
  /// aggregates, those of rank r numbered from @p starts[r], then parts of rows of the aggregates @p ghosts of other
  /// ranks. Unknowns that nothing couples get a positive diagonal. Collective.
  std::unique_ptr<BlockCsrMatrix> make_coarse_matrix(std::vector<CoarseRow>       rows,
                                                     const std::vector<DoFIndex> &starts,
                                                     const std::vector<DoFIndex> &ghosts,
                                                     MPI_Comm                     communicator);
} // namespace Nodus

#endif
