#ifndef nodus_solve_linear_system_h
#define nodus_solve_linear_system_h

#include "solve/block_csr_matrix.h"
#include <nodus/base/types.h>

#include <deal.II/base/index_set.h>
#include <deal.II/lac/la_parallel_block_vector.h>

#include <array>
#include <vector>

namespace Nodus
{
  /// Numbering of the unknowns (u, lambda, Lambda): three blocks of one block vector, and a flat index
  /// u | lambda | Lambda in which the contact couplings are written.
  ///
  /// Slave node k carries lambda_k and the two tangential components Lambda_2k, Lambda_2k+1; all three are owned by
  /// the rank that owns the node's displacement, and slave nodes are numbered so that each rank's are contiguous.
  struct BlockLayout
  {
    MPI_Comm                        communicator;
    std::array<dealii::IndexSet, 3> owned; ///< of u, lambda, Lambda
    DoFIndex                        n_u;
    DoFIndex                        n_slave_nodes;
    std::vector<DoFIndex>           slave_nodes; ///< of the owned ones: global displacement node, its dofs are 3i + c
    unsigned int                    n_rigid = 0; ///< bodies and coupled faces that forces and moments drive

    DoFIndex lambda(const DoFIndex k) const
    {
      return n_u + k;
    }
    DoFIndex Lambda(const DoFIndex k, const unsigned int direction) const
    {
      return n_u + n_slave_nodes + 2 * k + direction;
    }
    DoFIndex size() const
    {
      return n_u + 3 * n_slave_nodes;
    }
    /// The border behind the flat indices: six components of each driven rigid body, on every rank.
    DoFIndex rigid(const unsigned int body, const unsigned int component) const
    {
      return size() + 2 * dim * body + component;
    }
    /// Sets @p v to zero with this layout, fully distributed.
    void reinit(BlockVector &v) const;
  };

  /// Contact couplings of this rank as (row, column, value) in flat indices; both triangles are stored, equal
  /// positions add up, also across ranks. Rows and columns of constrained displacements do not occur.
  struct TripletMatrix
  {
    std::vector<DoFIndex> row, column;
    std::vector<double>   value;

    void clear()
    {
      row.clear();
      column.clear();
      value.clear();
    }
    void reserve(const std::size_t n)
    {
      row.reserve(n);
      column.reserve(n);
      value.reserve(n);
    }
    void add(const DoFIndex i, const DoFIndex j, const double v)
    {
      row.push_back(i);
      column.push_back(j);
      value.push_back(v);
    }
  };

  /// One Newton correction (eq. M1): (bulk + contact + variation) delta = rhs, indefinite. Without the variation it is
  ///
  ///     [ bulk + C_uu   B^T ] [du]   [ rhs_u ]
  ///     [ B             -C  ] [dm] = [ rhs_m ],   m = (lambda, Lambda), C >= 0 and coupled only
  ///                                               within a slave node unless the weights are `consistent`
  ///
  /// and symmetric. The variation is what moving thresholds and geometry add, unsymmetric: the derivative of friction
  /// tractions and laws with respect to lambda, and that of forces, gaps and friction laws with respect to pairing,
  /// areas and frames.
  ///
  /// Prescribed displacements, and those of coupled faces, are eliminated: their rows hold a positive diagonal only and
  /// no contact coupling.
  struct LinearSystem
  {
    const BlockLayout *layout;
    BlockCsrMatrix     bulk;
    TripletMatrix      contact, variation;
    /// Entries with the row or the column of a rigid body or face: translation, and spin about its centre. Not part of
    /// what a LinearSolver solves (BorderedSystem).
    TripletMatrix       border;
    std::vector<double> border_rhs; ///< six per rigid body, to be summed over the ranks
    BlockVector         rhs;
    bool                symmetric = true; ///< there is no variation; the same on every rank
    /// Per owned slave node, per multiplier: scale s > 0 for symmetric row and column equilibration
    /// (multiplier = s x scaled multiplier); friction rows carry mu lambda_s and get its inverse. Size 3 x owned slave
    /// nodes: lambda, Lambda_1, Lambda_2 of the first owned node, and so on.
    std::vector<double> multiplier_scale;
  };
  /// Adds to the border how the moment of a force, work conjugate to arm, changes with the spin of its rigid body:
  /// delta (arm x force) = (omega x arm) x force (eq. R3).
  inline void add_turn(const BlockLayout &layout,
                       const unsigned int body,
                       const Vector3     &arm,
                       const Vector3     &force,
                       TripletMatrix     &border)
  {
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        border.add(
            layout.rigid(body, dim + i), layout.rigid(body, dim + j), arm[i] * force[j] - (i == j ? arm * force : 0.));
  }
} // namespace Nodus

#endif
