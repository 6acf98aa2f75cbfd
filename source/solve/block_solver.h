#ifndef nodus_solve_block_solver_h
#define nodus_solve_block_solver_h

#include "solve/displacement_preconditioner.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// GMRES on the whole system, from the left, with the augmented block preconditioner of block_preconditioner.h.
  class BlockSolver : public LinearSolver
  {
  public:
    BlockSolver(const LinearSolverParameters &parameters, DisplacementNodes nodes);

    using LinearSolver::solve;
    Report solve(const LinearSystem                     &system,
                 const std::vector<const BlockVector *> &rhs,
                 std::vector<BlockVector>               &solutions,
                 double                                  relative_tolerance) override;

  private:
    const LinearSolverParameters                      parameters_;
    const DisplacementNodes                           nodes_;
    const std::unique_ptr<DisplacementPreconditioner> multigrid_;
  };
} // namespace Nodus

#endif
