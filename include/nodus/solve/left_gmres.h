#ifndef nodus_solve_left_gmres_h
#define nodus_solve_left_gmres_h

#include <nodus/solve/saddle_point_operator.h>

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/vector_memory.h>

#include <algorithm>

namespace Nodus
{
  struct KrylovReport
  {
    unsigned int iterations;
    double       residual; ///< |b - A x| / |b|
  };

  /// GMRES on A x = b from x = 0 until the residual b - A x and, where x is reached, the preconditioned residual have
  /// fallen by @p tolerance. Preconditioned from the left the residual measures displacements: in a slender body a
  /// small force hides a large one, and statuses are read from displacements. The caller compares the residual: it is
  /// larger than @p tolerance after @p maximum_iterations, or where round-off does not allow more. Collective.
  template <typename Preconditioner>
  KrylovReport left_gmres(const SaddlePointOperator &A,
                          const Preconditioner      &preconditioner,
                          const BlockVector         &b,
                          const double               tolerance,
                          const unsigned int         maximum_iterations,
                          BlockVector               &x)
  {
    BlockVector r(b), z(b);
    preconditioner.vmult(z, b);
    const double                               norm_b = b.l2_norm(), norm_z = z.l2_norm();
    KrylovReport                               report{0, 1.};
    double                                     target = .9 * tolerance;
    dealii::PrimitiveVectorMemory<BlockVector> memory; // gives the basis back; deal.II's default keeps it
    x = 0.;
    // The first start ends with the preconditioned residual; the next ones are for the residual itself.
    for (unsigned int start = 0; start < 4 && !(report.residual <= tolerance) && report.iterations < maximum_iterations;
         ++start)
    {
      dealii::SolverControl control(maximum_iterations - report.iterations, target * norm_z, false, false);
      try
      {
        dealii::SolverGMRES<BlockVector>(control, memory, dealii::SolverGMRES<BlockVector>::AdditionalData(62))
            .solve(A, x, b, preconditioner);
      }
      catch (const dealii::SolverControl::NoConvergence &)
      {
      }
      report.iterations += control.last_step();
      A.vmult(r, x);
      r.sadd(-1., 1., b);
      report.residual = r.l2_norm() / norm_b;
      target *= std::min(1., .5 * tolerance / report.residual);
    }
    return report;
  }
} // namespace Nodus

#endif
