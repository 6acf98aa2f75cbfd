#ifndef nodus_solve_node_matrix_h
#define nodus_solve_node_matrix_h

#include <nodus/types.h>

#include <deal.II/base/index_set.h>

#include <Epetra_Import.h>
#include <Epetra_Map.h>
#include <Epetra_MultiVector.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace Nodus
{
  /// Local numbers of the displacement nodes that a rank works with: the owned ones in the order of their degrees of
  /// freedom, then ghosts in ascending order. Degrees of freedom 3i, 3i+1, 3i+2 are the components of node i.
  class NodeMap
  {
  public:
    /// @param owned degrees of freedom, one contiguous range per rank @param ghosts global numbers of nodes, any order
    NodeMap(const dealii::IndexSet &owned, std::vector<DoFIndex> ghosts, MPI_Comm communicator);

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
    /// Maps of degrees of freedom: owned, and owned with ghosts.
    const Epetra_Map &row_map() const
    {
      return *row_map_;
    }
    const Epetra_Map &column_map() const
    {
      return *column_map_;
    }
    /// Values at owned nodes and ghosts of a vector over row_map(), three each; valid until the next call. Collective.
    const double *with_ghosts(const double *owned) const;

    MPI_Comm communicator() const
    {
      return communicator_;
    }

  private:
    MPI_Comm                                    communicator_;
    DoFIndex                                    first_;
    unsigned int                                n_owned_;
    std::vector<DoFIndex>                       ghosts_;
    std::unique_ptr<Epetra_Map>                 row_map_, column_map_;
    std::unique_ptr<Epetra_Import>              import_; ///< null when no rank has ghosts
    mutable std::unique_ptr<Epetra_MultiVector> values_;
  };

  /// Symmetric matrix of 3x3 blocks between displacement nodes.
  ///
  /// Blocks of two owned nodes are stored once, in the row of the lower one; blocks with ghosts by both owners. Half
  /// the values and a ninth of the indices of a general sparse matrix: products are bound by memory.
  class NodeMatrix
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

    /// Couples all nodes of each cell. @param cell_nodes local numbers of @p map, @p n per cell.
    void reinit(std::shared_ptr<const NodeMap> map, const std::vector<unsigned int> &cell_nodes, unsigned int n);

    const NodeMap &map() const
    {
      return *map_;
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
      for (std::uint32_t k = lower_start_[i]; k < lower_start_[i + 1]; ++k)
        f(lower_[k].row, values_.data() + 9 * std::size_t(lower_[k].block), true);
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
        f(column_[k], values_.data() + 9 * std::size_t(k), false);
    }
    unsigned int row_length(const unsigned int i) const
    {
      return lower_start_[i + 1] - lower_start_[i] + start_[i + 1] - start_[i];
    }
    /// The diagonal block of an owned node.
    const double *diagonal(const unsigned int i) const
    {
      return values_.data() + 9 * std::size_t(start_[i]);
    }
    /// True when the row of an owned degree of freedom holds nothing but the diagonal: a constrained one.
    bool decoupled(unsigned int dof) const;

    /// y = A x, over the owned degrees of freedom. Collective.
    void vmult(double *y, const double *x) const;

    /// Diagonal of the owned degrees of freedom.
    std::vector<double> diagonal() const;
    /// Largest absolute value on the diagonal, over all ranks. Collective.
    double largest_diagonal() const;

    /// Sum of the squares of all entries, over all ranks. Collective.
    double norm_squared() const;

    std::size_t memory_consumption() const;

  private:
    struct Lower
    {
      std::uint32_t row, block; ///< the block is stored in that row
    };
    std::shared_ptr<const NodeMap> map_;
    std::vector<std::uint32_t>     start_;  ///< of the rows: the diagonal, higher owned nodes, then ghosts
    std::vector<std::uint32_t>     ghosts_; ///< where the ghosts of a row start
    std::vector<std::uint32_t>     column_;
    std::vector<std::uint32_t>     lower_start_;
    std::vector<Lower>             lower_;  ///< blocks of lower rows
    std::vector<double>            values_; ///< 9 per block, row by row
  };
} // namespace Nodus

#endif
