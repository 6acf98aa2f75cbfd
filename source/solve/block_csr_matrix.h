#ifndef nodus_solve_block_csr_matrix_h
#define nodus_solve_block_csr_matrix_h

#include "parallel/ghost_exchange.h"

#include <deal.II/base/index_set.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

namespace Nodus
{
  inline void make_unique_ascending(std::vector<DoFIndex> &indices)
  {
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  }

  /// Values at the nodes of a NodeMap, three each, the owned ones and the ghosts in arrays of their own.
  struct NodeValues
  {
    const double *owned, *ghosts;
    unsigned int  n_owned;

    const double *operator[](const unsigned int node) const
    {
      return node < n_owned ? owned + dim * node : ghosts + dim * (node - n_owned);
    }
  };

  /// Local numbers of the displacement nodes that a rank works with: the owned ones in the order of their degrees of
  /// freedom, then ghosts in ascending order. Degrees of freedom 3i, 3i+1, 3i+2 are the components of node i.
  class NodeMap
  {
  public:
    /// @param owned degrees of freedom, one contiguous range per rank @param ghosts global numbers of nodes, any order
    NodeMap(const dealii::IndexSet &owned, std::vector<DoFIndex> ghosts, MPI_Comm communicator);
    /// The nodes of @p base under the same local numbers, and more ghosts behind them. Collective.
    NodeMap(const NodeMap &base, std::vector<DoFIndex> ghosts);

    unsigned int n_owned() const
    {
      return n_owned_;
    }
    unsigned int size() const
    {
      return n_owned_ + ghosts_.size();
    }
    /// Local number of a global node, or invalid_unsigned_int.
    unsigned int local(DoFIndex node) const;
    DoFIndex     global(const unsigned int i) const
    {
      return i < n_owned_ ? first_ + i : ghosts_[i - n_owned_];
    }
    DoFIndex n_global() const
    {
      return start_.back();
    }
    unsigned int owner(const DoFIndex node) const
    {
      return std::upper_bound(start_.begin(), start_.end(), node) - start_.begin() - 1;
    }
    /// Fetches the values at ghosts, to stay until the next call. Collective.
    NodeValues with_ghosts(const double *owned) const
    {
      start_fetch(owned);
      return {owned, finish_fetch(), n_owned_};
    }
    /// with_ghosts() in two steps, for work in between; the second returns the values at ghosts. Collective.
    void start_fetch(const double *const owned) const
    {
      exchange_.start_fetch(owned, dim);
    }
    const double *finish_fetch() const
    {
      exchange_.finish_fetch(ghost_values_.data(), dim);
      return ghost_values_.data();
    }
    /// Adds the values at ghosts, @p n_components each, to those of their owners. Collective.
    void add_from_ghosts(const double *ghosts, double *owned, const unsigned int n_components) const
    {
      exchange_.add(ghosts, owned, n_components);
    }
    /// Exchange for the ghosts @p nodes alone, local numbers. Collective.
    GhostExchange exchange_for(const std::vector<unsigned int> &nodes) const;
    /// Numbers for each ghost, in the order of the local numbers: @p append adds those of an owned node to the end.
    /// Collective.
    std::vector<std::vector<double>>
    lists_at_ghosts(const std::function<void(unsigned int owned, std::vector<double> &)> &append) const
    {
      return exchange_.fetch_lists(append);
    }
    /// Asks the owners of @p nodes (global) for numbers about them; @p answer gets a local number. Collective.
    std::map<DoFIndex, std::vector<double>> ask(const std::vector<DoFIndex>                            &nodes,
                                                const std::function<std::vector<double>(unsigned int)> &answer) const;

    MPI_Comm communicator() const
    {
      return communicator_;
    }

  private:
    void make_exchange();

    MPI_Comm                    communicator_;
    std::vector<DoFIndex>       start_; ///< of each rank's nodes, and the number of all
    DoFIndex                    first_;
    unsigned int                n_owned_;
    std::vector<DoFIndex>       ghosts_; ///< of the base, then the others, ascending in each part
    std::vector<unsigned int>   end_of_part_;
    GhostExchange               exchange_;
    mutable std::vector<double> ghost_values_;
  };

  /// Where the blocks of a BlockCsrMatrix are.
  struct NodePattern
  {
    struct Lower
    {
      std::uint32_t row, block; ///< the block is stored in that row
    };
    std::vector<std::uint32_t> start;  ///< of the rows: the diagonal, higher owned nodes, then ghosts
    std::vector<std::uint32_t> ghosts; ///< where the ghosts of a row start
    std::vector<std::uint32_t> column;
    std::vector<std::uint32_t> lower_start; ///< of the columns, those of ghosts included
    std::vector<Lower>         lower;       ///< blocks of a column in lower rows
    std::vector<std::uint32_t> interface;   ///< rows with ghosts

    /// y = A x for @p values of 9 per block, row by row, and 3 more; x and y of the owned nodes. Collective.
    template <typename Number>
    void vmult(const Number *values, double *y, const double *x, const NodeMap &nodes) const;

  private:
    template <typename Number>
    void multiply_owned(const Number *values, double *y, const double *x) const;
    template <typename Number>
    void add_ghosts(const Number *values, double *y, const double *x_ghosts) const;
  };

  /// Symmetric matrix of 3x3 blocks between displacement nodes.
  ///
  /// Blocks of two owned nodes are stored once, in the row of the lower one; blocks with ghosts by both owners. Half
  /// the values and a ninth of the indices of a general sparse matrix: products are bound by memory.
  class BlockCsrMatrix
  {
  public:
    /// A block and whether it is to be transposed; an index into the storage.
    class Position
    {
    public:
      Position() = default;
      Position(const std::uint32_t block, const bool transposed)
          : code_(2 * block + (transposed ? 1 : 0))
      {
      }
      bool stored() const
      {
        return code_ != invalid;
      }
      std::size_t block() const
      {
        return code_ / 2;
      }
      bool transposed() const
      {
        return code_ % 2 == 1;
      }

    private:
      static constexpr std::uint32_t invalid = -1;
      std::uint32_t                  code_   = invalid;
    };

    /// Couples all nodes of each group, those of a cell for example. @param group_nodes local numbers of @p map, group
    /// after group. @param group_end where each group ends.
    void reinit(std::shared_ptr<const NodeMap>   map,
                const std::vector<unsigned int> &group_nodes,
                const std::vector<std::size_t>  &group_end);
    /// @param add_columns called as add_columns(i, columns) in the order of the owned nodes: appends to @p columns the
    /// local nodes j > i that node i is coupled with, in any order, also more than once.
    void reinit(std::shared_ptr<const NodeMap>                                                 map,
                const std::function<void(std::uint32_t, std::vector<std::uint32_t> &columns)> &add_columns);

    const NodeMap &map() const
    {
      return *map_;
    }
    const std::shared_ptr<const NodeMap> &shared_map() const
    {
      return map_;
    }
    void set_zero();

    /// Where block (i, j) of local nodes is; not stored when neither is owned. i, j must be coupled.
    Position position(unsigned int i, unsigned int j) const;
    double  *block(const std::size_t position)
    {
      return values_.data() + 9 * position;
    }

    /// Calls f(column node, 3x3 block, transposed) for all blocks of the full row of an owned node.
    template <typename Function>
    void for_row(const unsigned int i, const Function &f) const
    {
      const NodePattern &p = *pattern_;
      for (std::uint32_t k = p.lower_start[i]; k < p.lower_start[i + 1]; ++k)
        f(p.lower[k].row, values_.data() + 9 * std::size_t(p.lower[k].block), true);
      for (std::uint32_t k = p.start[i]; k < p.start[i + 1]; ++k)
        f(p.column[k], values_.data() + 9 * std::size_t(k), false);
    }
    /// The diagonal block of an owned node.
    const double *diagonal(const unsigned int i) const
    {
      return values_.data() + 9 * std::size_t(pattern_->start[i]);
    }
    void add_to_diagonal(const unsigned int dof, const double value)
    {
      values_[9 * std::size_t(pattern_->start[dof / dim]) + 4 * (dof % dim)] += value;
    }
    /// Leaves nothing but the diagonal in the rows and columns of @p chosen, not zero, among the owned degrees of
    /// freedom. Collective.
    void decouple(const std::vector<double> &chosen);
    /// True when the row of an owned degree of freedom holds nothing but the diagonal: a constrained one.
    bool decoupled(unsigned int dof) const;

    /// y = A x, over the owned degrees of freedom. Collective.
    void vmult(double *y, const double *x) const
    {
      pattern_->vmult(values_.data(), y, x, *map_);
    }
    /// Diagonal of the owned degrees of freedom.
    std::vector<double> diagonal() const;
    /// Largest absolute value on the diagonal, over all ranks. Collective.
    double largest_diagonal() const;

    /// Sum of the squares of all entries, over all ranks. Collective.
    double norm_squared() const;

    std::size_t memory_consumption() const;

    const std::shared_ptr<const NodePattern> &pattern() const
    {
      return pattern_;
    }
    const std::vector<double> &values() const
    {
      return values_;
    }

  private:
    std::shared_ptr<const NodeMap>     map_;
    std::shared_ptr<const NodePattern> pattern_;
    std::vector<double>                values_; ///< as NodePattern::vmult() takes them
  };
} // namespace Nodus

#endif
