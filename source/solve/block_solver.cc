#include "solve/block_solver.h"
#include "solve/block_preconditioner.h"
#include "solve/left_gmres.h"
#include "solve/saddle_point_operator.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  BlockSolver::BlockSolver(const LinearSolverParameters &parameters, DisplacementNodes nodes)
      : parameters_(parameters)
      , nodes_(std::move(nodes))
      // three sweeps pay off against the stiff couplings of the augmentation
      , multigrid_(make_displacement_preconditioner(parameters.preconditioner, 3))
  {
  }

  LinearSolver::Report BlockSolver::solve(const LinearSystem                     &system,
                                          const std::vector<const BlockVector *> &rhs,
                                          std::vector<BlockVector>               &solutions,
                                          const double                            relative_tolerance)
  {
    const double                               tolerance = std::max(parameters_.tolerance, relative_tolerance);
    const SaddlePointOperator                  matrix(system);
    std::unique_ptr<const BlockPreconditioner> preconditioner;
    const auto                                 iterate = [&](const BlockVector &b, BlockVector &x)
    {
      if (!preconditioner)
      {
        const auto timer = time_set_up();
        preconditioner =
            std::make_unique<const BlockPreconditioner>(matrix, parameters_.augmentation_factor, nodes_, *multigrid_);
      }
      const KrylovReport krylov = left_gmres(
          matrix,
          [&](BlockVector &z, const BlockVector &r) { preconditioner->vmult(z, r); },
          b,
          tolerance,
          parameters_.maximum_iterations,
          x);
      if (!(krylov.residual <= tolerance))
      {
        std::ostringstream message;
        message << "Block solver: relative residual " << krylov.residual << " after " << krylov.iterations
                << " iterations (wanted: " << tolerance
                << "); use 'Type = direct' or change 'Augmentation factor' (good values lie between 1 and 10)";
        throw SolverFailure(message.str(), SolverFailure::Kind::linear_solver);
      }
      return krylov.iterations;
    };
    Report report = matrix.solve_each(rhs, "Block solver", iterate, solutions);
    report.work   = iterative_work(system, 1, report.iterations);
    return report;
  }
} // namespace Nodus
