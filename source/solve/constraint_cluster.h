#ifndef nodus_solve_constraint_cluster_h
#define nodus_solve_constraint_cluster_h

#include "solve/node_block.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <mpi.h>

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Constraints of slave nodes that see each other's displacements, all of them known to every rank: with their
  /// displacements y_c along the constraints, M y_c + R y = g, R in terms of the other unknowns y.
  class ConstraintCluster
  {
  public:
    /// A slave node with constraints.
    struct Member
    {
      unsigned int           site; ///< number on its rank
      DoFIndex               node; ///< global
      unsigned int           n_constraints;
      Eigen::Matrix3d        basis; ///< of the displacement; the first columns are those along the constraints
      std::vector<NodeBlock> rows;  ///< one row for each constraint, zero beyond
    };

    /// Of the members @p mine of all ranks; null when there are none. Collective.
    static std::unique_ptr<ConstraintCluster> make(const std::vector<Member> &mine, MPI_Comm communicator);

    /// Whether the constraints give y_c: none of them follows from the others. The same on all ranks.
    bool regular() const;

    /// The displacement of a member along its constraints in terms of the other unknowns, where g vanishes: its rows of
    /// -basis M^-1 R, by global node. Entries of M^-1 that are round-off of the largest in their row are left out.
    std::map<DoFIndex, Eigen::Matrix3d> substitution(const Member &member) const;

    /// Solves M y_c = g, or with M^T where @p transposed. @p values holds g and takes y_c, by site of this rank and
    /// constraint; other values are left alone. Collective.
    void solve(std::vector<Eigen::Vector3d> &values, bool transposed) const;

  private:
    using Matrix = Eigen::SparseMatrix<double>;
    using LU     = Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>>;

    ConstraintCluster(const std::vector<Member> &mine, MPI_Comm communicator);
    void   collect(const std::vector<Member> &mine);
    Matrix assemble();

    /// Place of a member of this rank.
    struct Own
    {
      unsigned int site, first, n_constraints;
    };
    const MPI_Comm                                                    communicator_;
    std::vector<Member>                                               members_; ///< of all ranks, while M is made
    std::map<DoFIndex, unsigned int>                                  first_;   ///< row of a node's first constraint
    std::vector<Own>                                                  own_;
    std::vector<std::vector<std::pair<DoFIndex, Eigen::RowVector3d>>> R_; ///< row by row
    LU                                                                M_, M_transposed_;
    unsigned int                                                      size_    = 0; ///< number of constraints
    unsigned int                                                      n_ranks_ = 0; ///< that have members
  };
} // namespace Nodus

#endif
