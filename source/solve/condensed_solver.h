#ifndef nodus_solve_condensed_solver_h
#define nodus_solve_condensed_solver_h

#include "solve/displacement_preconditioner.h"

#include <memory>
#include <vector>

namespace Nodus
{
  class Condensation;
  class SaddlePointOperator;

  /// Conjugate gradients with multigrid on the displacements that are left when condensation.h has eliminated the
  /// multipliers; a system with a variation, or one that is not positive definite, needs GMRES on all unknowns, with
  /// condensation and multigrid as preconditioner. The hierarchy is kept over several systems while it pays. Systems
  /// that cannot be condensed go to the block solver.
  class CondensedSolver : public LinearSolver
  {
  public:
    CondensedSolver(const LinearSolverParameters &parameters, DisplacementNodes nodes);

    using LinearSolver::solve;
    Report solve(const LinearSystem                     &system,
                 const std::vector<const BlockVector *> &rhs,
                 std::vector<BlockVector>               &solutions,
                 double                                  relative_tolerance) override;

  private:
    void make_multigrid(const LinearSystem &system, const Condensation &condensation);
    bool hierarchy_fits(const std::vector<char> &signature, MPI_Comm communicator) const;
    /// All return the iterations; @p x starts from zero.
    unsigned int iterate(const SaddlePointOperator &matrix,
                         Condensation              &condensation,
                         const BlockVector         &b,
                         double                     tolerance,
                         BlockVector               &x) const;
    /// @returns whether they converged: they need a positive definite matrix.
    bool         conjugate_gradients(const Condensation &condensation,
                                     const Vector       &rhs,
                                     double              tolerance,
                                     Vector             &y,
                                     unsigned int       &iterations) const;
    unsigned int gmres(const SaddlePointOperator &matrix,
                       Condensation              &condensation,
                       const BlockVector         &b,
                       double                     tolerance,
                       BlockVector               &x) const;

    const LinearSolverParameters                      parameters_;
    const DisplacementNodes                           nodes_;
    const std::unique_ptr<DisplacementPreconditioner> multigrid_;
    bool                                              set_up_ = false; ///< multigrid_ is
    std::vector<char>                                 signature_; ///< of the system that the hierarchy was made for
    double                        first_iterations_ = 0., last_iterations_ = 0.; ///< with this hierarchy, per digit
    std::unique_ptr<LinearSolver> block_solver_;                                 ///< once it was needed
  };
} // namespace Nodus

#endif
