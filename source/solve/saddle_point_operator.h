#ifndef nodus_solve_saddle_point_operator_h
#define nodus_solve_saddle_point_operator_h

#include "solve/coupling_matrix.h"
#include "solve/linear_solver.h"
#include "solve/linear_system.h"

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// A LinearSystem as an operator on vectors (u, m) with two blocks: the three multipliers of a slave node follow each
  /// other in m, and they are scaled so that a unit of every multiplier acts on u like a unit of displacement does
  /// through the diagonal of the stiffness. All rows are then forces, and a residual norm hides none of them.
  ///
  ///     [ bulk + C_uu   B^T ]
  ///     [ B             -C  ]
  ///
  /// and, added to it by vmult(), the variation. The result does not depend on LinearSystem::multiplier_scale, which
  /// the scaling supersedes.
  class SaddlePointOperator
  {
  public:
    /// Keeps a reference to @p system. Collective.
    explicit SaddlePointOperator(const LinearSystem &system);

    void vmult(BlockVector &dst, const BlockVector &src) const;

    /// A right-hand side of the system, scaled.
    BlockVector scaled(const BlockVector &rhs) const;

    /// Writes @p x in the unknowns of the system.
    void to_solution(const BlockVector &x, BlockVector &solution) const;

    /// Scales each of @p rhs, has @p iterate find x from it (@returns the number of iterations) unless it is zero, and
    /// writes that in the unknowns of the system. @throws SolverFailure for @p solver if it is not finite.
    LinearSolver::Report
    solve_each(const std::vector<const BlockVector *>                                       &rhs,
               const std::string                                                            &solver,
               const std::function<unsigned int(const BlockVector &scaled, BlockVector &x)> &iterate,
               std::vector<BlockVector>                                                     &solutions) const;

    MPI_Comm communicator() const
    {
      return system_.layout->communicator;
    }
    bool symmetric() const
    {
      return system_.symmetric;
    }
    /// 2-norm of a residual in the units of the system.
    double unscaled_norm(const BlockVector &residual) const;

    const BlockCsrMatrix &bulk() const
    {
      return system_.bulk;
    }
    const CouplingMatrix &B() const
    {
      return *B_;
    }
    const CouplingMatrix &C() const
    {
      return *C_;
    }
    const Ownership &displacement_ownership() const
    {
      return u_ownership_;
    }
    const Ownership &multiplier_ownership() const
    {
      return m_ownership_;
    }
    /// Global displacement node of each owned slave node.
    const std::vector<DoFIndex> &slave_nodes() const
    {
      return system_.layout->slave_nodes;
    }
    /// f = (bulk + C_uu) u, over the owned displacements.
    void apply_stiffness(const double *u, double *f) const;
    /// f += C_uu u
    void add_coupling(const double *u, double *f) const;
    /// C_uu between the components of an owned node.
    Eigen::Matrix3d own_coupling(DoFIndex node) const;
    /// Whether other multipliers than those of slave node @p k are at its node, too.
    bool shares_node(const unsigned int k) const
    {
      return (k > 0 && slave_nodes()[k - 1] == slave_nodes()[k]) ||
             (k + 1 < slave_nodes().size() && slave_nodes()[k + 1] == slave_nodes()[k]);
    }
    /// Stiffness that each owned multiplier sees, |B_i|^2 / (B diag(K)^-1 B^T)_ii (eq. M2); 0 for those uncoupled.
    const std::vector<double> &stiffness() const
    {
      return stiffness_;
    }

  private:
    DoFIndex to_m(DoFIndex flat) const;
    void     equilibrate();
    void     make_variation();

    const LinearSystem             &system_;
    const Ownership                 u_ownership_, m_ownership_;
    const dealii::IndexSet          owned_m_;
    std::vector<MatrixEntry>        uu_entries_;   ///< C_uu: owned rows, sorted
    std::unique_ptr<CouplingMatrix> B_, C_, C_uu_; ///< the last null when it has no entries
    std::vector<double>             scale_;        ///< of owned multipliers: multiplier = scale x unknown
    std::vector<double>             stiffness_;
    struct
    {
      std::unique_ptr<CouplingMatrix> uu, um, mu, mm;
    } variation_; ///< null in a symmetric system
  };
} // namespace Nodus

#endif
