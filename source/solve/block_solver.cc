#include <nodus/solve/block_preconditioner.h>
#include <nodus/solve/block_solver.h>
#include <nodus/solve/left_gmres.h>
#include <nodus/solve/saddle_point_operator.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  BlockSolver::BlockSolver(const LinearSolverParameters &parameters, const std::vector<Point> &node_positions)
      : parameters_(parameters)
      , node_positions_(node_positions)
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
    solutions.resize(rhs.size());
    Report report;
    for (unsigned int n = 0; n < rhs.size(); ++n)
    {
      const BlockVector b = matrix.scaled(*rhs[n]);
      BlockVector       x, r;
      x.reinit(b);
      r.reinit(b);
      const double norm_b = b.l2_norm();
      if (!std::isfinite(norm_b))
        throw SolverFailure("Block solver: the right-hand side holds a value that is not finite.",
                            SolverFailure::Kind::not_finite);
      if (norm_b > 0.)
      {
        if (!preconditioner)
        {
          const auto timer = time_set_up();
          preconditioner =
              std::make_unique<const BlockPreconditioner>(matrix, parameters_.augmentation_factor, node_positions_);
        }
        const KrylovReport krylov =
            left_gmres(matrix, *preconditioner, b, tolerance, parameters_.maximum_iterations, x);
        report.iterations += krylov.iterations;
        if (!(krylov.residual <= tolerance))
        {
          std::ostringstream message;
          message << "Block solver: relative residual " << krylov.residual << " after " << krylov.iterations
                  << " iterations (wanted: " << tolerance
                  << "); use 'Type = direct' or change 'Augmentation factor' (good values lie between 1 and 10).";
          throw SolverFailure(message.str(), SolverFailure::Kind::linear_solver);
        }
        matrix.vmult(r, x);
        r.sadd(-1., 1., b);
        if (n == 0)
          report.relative_residual = matrix.unscaled_norm(r) / matrix.unscaled_norm(b);
      }
      matrix.to_solution(x, solutions[n]);
    }
    return report;
  }
} // namespace Nodus
