#ifndef nodus_bulk_constrained_cells_h
#define nodus_bulk_constrained_cells_h

#include "mesh/hanging_nodes.h"
#include "solve/block_csr_matrix.h"
#include <nodus/base/types.h>

#include <deal.II/dofs/dof_handler.h>

#include <memory>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Cells with hanging nodes: what they add to the forces and the tangent at these goes to the nodes that they follow.
  ///
  /// Such a cell is integrated by its owner alone, who sends its part to the owners of those nodes: they need not know
  /// the cell.
  class ConstrainedCells
  {
  public:
    /// Collective.
    explicit ConstrainedCells(const dealii::DoFHandler<dim> &dof_handler);

    /// Whether there are any, on all ranks.
    bool exist() const
    {
      return hanging_.exist();
    }
    bool contains(const dealii::DoFHandler<dim>::active_cell_iterator &cell) const
    {
      return exist() && constrained_[cell->active_cell_index()];
    }
    /// An owned cell that contains() is number @p cell of those integrated here. @p nodes: global numbers of its nodes;
    /// the free ones that it acts on are added to @p ghosts.
    void add(unsigned int cell, const std::vector<DoFIndex> &nodes, std::vector<DoFIndex> &ghosts);
    /// After the last add(): tells the owners of the nodes. @returns @p base with the nodes of other ranks' cells
    /// behind it. Collective.
    std::shared_ptr<const NodeMap> publish(const std::shared_ptr<const NodeMap> &base);

    /// Groups of nodes that these cells couple, for the pattern of the tangent: local numbers behind one another, and
    /// where each group ends.
    void add_groups(std::vector<unsigned int> &nodes, std::vector<std::size_t> &end) const;
    void find_positions(const BlockCsrMatrix &tangent);

    /// Index of a cell in the order of add(), or invalid_unsigned_int.
    unsigned int index(const unsigned int cell) const
    {
      return cell < index_.size() ? index_[cell] : dealii::numbers::invalid_unsigned_int;
    }

    /// Sums of the forces at the local nodes of the base, three numbers each.
    struct NodalForces
    {
      std::vector<double> &internal, &external, &rhs;
    };
    /// Adds what cell @p index has: forces at its nodes, and with @p tangent its stiffness, blocks [a][b >= a][i][k].
    /// Prescribed components are eliminated (@p is_prescribed and the values that are left, at the nodes of the base).
    void add(unsigned int               index,
             const std::vector<double> &internal,
             const std::vector<double> &external,
             const std::vector<char>   &is_prescribed,
             const std::vector<double> &prescribed,
             const std::vector<double> &stiffness,
             BlockCsrMatrix            *tangent,
             const NodalForces         &sums);
    /// After the last add() of a sweep: brings in what other ranks' cells have, unless the sweep @p failed somewhere.
    /// Collective.
    void exchange(bool failed, BlockCsrMatrix *tangent, const NodalForces &sums);

  private:
    struct Share
    {
      unsigned int node; ///< index into Cell::free
      double       weight;
    };
    struct Cell
    {
      std::vector<DoFIndex>                              global;       ///< free nodes that the cell acts on
      std::vector<unsigned int>                          free;         ///< the same, local numbers
      std::vector<Share>                                 shares;       ///< of the nodes of the cell in these
      std::vector<unsigned int>                          start;        ///< of the shares of each node
      std::vector<std::pair<unsigned int, unsigned int>> hanging;      ///< node of the cell, local number; owned ones
      std::vector<unsigned int>                          destinations; ///< indices into neighbours_
      std::vector<BlockCsrMatrix::Position>              positions;    ///< [free A][free B >= A]

      unsigned int n_nodes() const
      {
        return start.size() - 1;
      }
      const Share *begin(const unsigned int a) const
      {
        return shares.data() + start[a];
      }
      const Share *end(const unsigned int a) const
      {
        return shares.data() + start[a + 1];
      }
    };
    /// A rank that parts are sent to or come from.
    struct Neighbour
    {
      unsigned int        rank;
      std::vector<Cell>   cells; ///< of theirs, that act on nodes of this rank
      std::vector<double> outgoing, incoming;
      std::size_t         n_outgoing = 0; ///< blocks and nodes of own cells that go there: numbers with tangent
    };

    /// The first entry of the block of free nodes A and B >= A in #blocks_.
    std::size_t block(const unsigned int A, const unsigned int B) const
    {
      return std::size_t(dim * dim) * (A * n_free_ - A * (A + 1) / 2 + B);
    }
    double &entry(const unsigned int A, const unsigned int i, const unsigned int B, const unsigned int k)
    {
      return A <= B ? blocks_[block(A, B) + dim * i + k] : blocks_[block(B, A) + dim * k + i];
    }
    void               condense(const Cell &cell, const double *stiffness);
    void               eliminate_prescribed(const Cell                &cell,
                                            const std::vector<char>   &is_prescribed,
                                            const std::vector<double> &prescribed);
    static std::size_t n_numbers(const Cell &cell, bool with_tangent);

    MPI_Comm                  communicator_;
    HangingNodes              hanging_;
    std::vector<char>         constrained_; ///< by active cell index
    std::vector<unsigned int> index_;
    std::vector<Cell>         cells_;
    std::vector<Neighbour>    neighbours_; ///< ranks in ascending order
    unsigned int              n_owned_ = 0;
    // of the cell at hand
    unsigned int        n_free_ = 0;
    std::vector<double> blocks_;   ///< stiffness: [A][B >= A][i][k]
    std::vector<double> force_[3]; ///< internal, external, right-hand side
  };
} // namespace Nodus

#endif
