#include <nodus/solve/block_preconditioner.h>
#include <nodus/solve/block_solver.h>
#include <nodus/solve/saddle_point_operator.h>

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  BlockSolver::BlockSolver(const LinearSolverParameters &parameters, const RigidBodyData &rigid_body_data)
      : parameters_(parameters)
      , rigid_body_data_(rigid_body_data)
  {
  }

  LinearSolver::Report
  BlockSolver::solve(const LinearSystem &system, BlockVector &solution, const double relative_tolerance)
  {
    const double              tolerance = std::max(parameters_.tolerance, relative_tolerance);
    const SaddlePointOperator matrix(system);
    const BlockVector         b = matrix.rhs();
    BlockVector               x, r;
    x.reinit(b);
    r.reinit(b);
    const double norm_b = b.l2_norm();
    if (!std::isfinite(norm_b))
      throw SolverFailure("Block solver: the right-hand side holds a value that is not finite.");

    Report report;
    if (norm_b > 0.)
    {
      const auto fail = [&](const double residual)
      {
        std::ostringstream message;
        message << "Block solver: relative residual " << residual / norm_b << " after " << report.iterations
                << " iterations (wanted: " << tolerance
                << "); use 'Type = direct' or change 'Augmentation factor' (good values lie between 1 and 10).";
        throw SolverFailure(message.str());
      };

      const auto set_up = [&]
      {
        const auto timer = time_set_up();
        return std::make_unique<const BlockPreconditioner>(matrix, parameters_.augmentation_factor, rigid_body_data_);
      };
      const auto preconditioner = set_up();
      double     residual       = norm_b;
      // The residual that FGMRES carries along can drift from the true one: start again until that one is small.
      for (unsigned int start = 0; start < 3 && !(residual <= tolerance * norm_b); ++start)
      {
        dealii::SolverControl control(
            parameters_.maximum_iterations - report.iterations, .9 * tolerance * norm_b, false, false);
        dealii::SolverFGMRES<BlockVector> fgmres(control, dealii::SolverFGMRES<BlockVector>::AdditionalData(60));
        try
        {
          fgmres.solve(matrix, x, b, *preconditioner);
        }
        catch (const dealii::SolverControl::NoConvergence &)
        {
          report.iterations += control.last_step();
          fail(control.last_value());
        }
        report.iterations += control.last_step();
        matrix.vmult(r, x);
        r.sadd(-1., 1., b);
        residual = r.l2_norm();
      }
      if (!(residual <= tolerance * norm_b))
        fail(residual);
      report.relative_residual = matrix.unscaled_norm(r) / matrix.unscaled_norm(b);
    }
    matrix.to_solution(x, solution);
    return report;
  }
} // namespace Nodus
