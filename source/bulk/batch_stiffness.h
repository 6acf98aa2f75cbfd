#ifndef nodus_bulk_batch_stiffness_h
#define nodus_bulk_batch_stiffness_h

#include "bulk/constrained_cells.h"
#include "bulk/lanes.h"
#include "solve/block_csr_matrix.h"

#include <deal.II/lac/full_matrix.h>

#include <cmath>
#include <memory>
#include <vector>

namespace Nodus
{
  /// Stiffness of the cells that are integrated at once, one in each lane, and where the blocks of all cells stand in
  /// the tangent. What is called for every cell stands here, to be inlined.
  class BatchStiffness
  {
  public:
    /// @param n_nodes of a cell
    explicit BatchStiffness(const unsigned int n_nodes)
        : n_nodes_(n_nodes)
        , n_pairs_(n_nodes * (n_nodes + 1) / 2)
        , values_(n_pairs_ * dim * dim)
    {
    }

    /// Gives @p tangent the pattern of all cells, and finds the places of their blocks in it; those of @p constrained
    /// are found by these. @param cell_nodes [cell][node], numbers in @p nodes
    void make_pattern(const std::shared_ptr<const NodeMap> &nodes,
                      const std::vector<unsigned int>      &cell_nodes,
                      ConstrainedCells                     &constrained,
                      BlockCsrMatrix                       &tangent);

    /// As in ElementKernel::integrate().
    Lanes *data()
    {
      return values_.data();
    }

    /// Entry of the stiffness: node a, component i; node b, component k.
    double &entry(
        const unsigned int a, const unsigned int i, const unsigned int b, const unsigned int k, const unsigned int lane)
    {
      if (b < a)
        return entry(b, k, a, i, lane);
      const unsigned int pair = a * n_nodes_ - a * (a + 1) / 2 + b;
      return reinterpret_cast<double *>(values_.data())[((pair * dim + i) * dim + k) * n_lanes + lane];
    }

    /// The blocks of @p size cells from @p first on come from memory while the kernel computes.
    void prefetch(const unsigned int first, const unsigned int size, BlockCsrMatrix &tangent) const
    {
      const BlockCsrMatrix::Position *position = positions_.data() + first * n_pairs_;
      for (std::size_t k = 0; k < size * n_pairs_; ++k, ++position)
        if (position->stored())
          __builtin_prefetch(tangent.block(position->block()), 1);
    }

    void set_zero();
    /// Adds the tangent of the loads on the cell in @p lane.
    void add(unsigned int lane, const dealii::FullMatrix<double> &loads);
    /// Gives the blocks of the cell in @p lane, in the order of data().
    void copy_cell(unsigned int lane, std::vector<double> &blocks) const;

    /// Eliminates the components that are prescribed at the nodes @p node of the cell in @p lane: a positive diagonal
    /// is left, and @p rhs gets the force of the values. The vectors are those at the local nodes, [node][component].
    void eliminate_prescribed(const unsigned int         lane,
                              const unsigned int        *node,
                              const std::vector<char>   &is_prescribed,
                              const std::vector<double> &prescribed,
                              std::vector<double>       &rhs)
    {
      for (unsigned int a = 0; a < n_nodes_; ++a)
        for (unsigned int i = 0; i < dim; ++i)
        {
          const unsigned int dof = dim * node[a] + i;
          if (!is_prescribed[dof])
            continue;
          const double diagonal = std::abs(entry(a, i, a, i, lane));
          for (unsigned int b = 0; b < n_nodes_; ++b)
            for (unsigned int k = 0; k < dim; ++k)
            {
              double &K = entry(b, k, a, i, lane);
              rhs[dim * node[b] + k] -= K * prescribed[dof];
              K = 0.;
              if (a == b) // stored in full
                entry(a, i, a, k, lane) = 0.;
            }
          entry(a, i, a, i, lane) = diagonal;
        }
    }

    /// Adds the blocks of @p cell, which is in @p lane.
    void add_to(BlockCsrMatrix &tangent, const unsigned int cell, const unsigned int lane) const
    {
      const BlockCsrMatrix::Position *position = positions_.data() + cell * n_pairs_;
      const double                   *K        = reinterpret_cast<const double *>(values_.data()) + lane;
      for (unsigned int pair = 0; pair < n_pairs_; ++pair, ++position, K += dim * dim * n_lanes)
      {
        if (!position->stored())
          continue;
        double *const block = tangent.block(position->block());
        if (position->transposed())
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int k = 0; k < dim; ++k)
              block[dim * k + i] += K[(dim * i + k) * n_lanes];
        else
          for (unsigned int i = 0; i < dim * dim; ++i)
            block[i] += K[i * n_lanes];
      }
    }

  private:
    unsigned int                          n_nodes_;
    std::size_t                           n_pairs_;
    std::vector<Lanes>                    values_;    ///< [node a][node b >= a][component of a][component of b]
    std::vector<BlockCsrMatrix::Position> positions_; ///< [cell][node a][node b >= a]; constrained: not stored
  };
} // namespace Nodus

#endif
