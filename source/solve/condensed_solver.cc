#include <nodus/solve/condensation.h>
#include <nodus/solve/condensed_solver.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <cmath>
#include <sstream>

namespace Nodus
{
  CondensedSolver::CondensedSolver(const LinearSolverParameters &parameters, const RigidBodyData &rigid_body_data)
      : parameters_(parameters)
      , rigid_body_data_(rigid_body_data)
      , block_solver_(parameters, rigid_body_data)
  {
  }

  void CondensedSolver::make_multigrid(const LinearSystem &system, const Condensation &condensation)
  {
    multigrid_.reset(); // refers to the matrix
    matrix_ = std::make_unique<CorrectedMatrix>(system.bulk, condensation.taken_out(), condensation.correction());
    std::vector<double> modes = rigid_body_modes(system.bulk, rigid_body_data_);
    condensation.transform_modes(modes);
    multigrid_        = std::make_unique<Multigrid>(*matrix_, std::move(modes), 2);
    signature_        = condensation.signature();
    first_iterations_ = last_iterations_ = 0;
  }

  /// Few nodes may have changed, and the iterations must not have grown by more than half.
  bool CondensedSolver::hierarchy_fits(const std::vector<char> &signature, const MPI_Comm communicator) const
  {
    if (!multigrid_ || 2 * last_iterations_ > 3 * first_iterations_ + 6)
      return false;
    unsigned int changed = 0;
    for (unsigned int k = 0; k < signature.size(); ++k)
      changed += signature[k] != signature_[k];
    changed                  = dealii::Utilities::MPI::sum(changed, communicator);
    const unsigned int total = dealii::Utilities::MPI::sum(static_cast<unsigned int>(signature.size()), communicator);
    return 20 * changed <= total;
  }

  unsigned int
  CondensedSolver::iterate(const Condensation &condensation, const Vector &rhs, const double tolerance, Vector &y) const
  {
    dealii::SolverControl control(parameters_.maximum_iterations, tolerance * rhs.l2_norm(), false, false);
    try
    {
      dealii::SolverCG<Vector> cg(control);
      cg.solve(condensation, y, rhs, *multigrid_);
      return control.last_step();
    }
    catch (const dealii::SolverControl::NoConvergence &)
    {
    }
    // Conjugate gradients need a positive definite matrix; a structure that buckles has none.
    const unsigned int before = control.last_step();
    y                         = 0.;
    try
    {
      dealii::SolverFGMRES<Vector> fgmres(control, dealii::SolverFGMRES<Vector>::AdditionalData(60));
      fgmres.solve(condensation, y, rhs, *multigrid_);
    }
    catch (const dealii::SolverControl::NoConvergence &failure)
    {
      std::ostringstream message;
      message << "Condensed solver: relative residual " << failure.last_residual / rhs.l2_norm() << " after "
              << before + control.last_step() << " iterations (wanted: " << tolerance << "); use 'Type = direct'.";
      throw SolverFailure(message.str());
    }
    return before + control.last_step();
  }

  LinearSolver::Report CondensedSolver::solve(const LinearSystem &system, BlockVector &solution)
  {
    const SaddlePointOperator     matrix(system);
    std::unique_ptr<Condensation> condensation;
    try
    {
      condensation = std::make_unique<Condensation>(matrix);
    }
    catch (const NotCondensable &)
    {
      return block_solver_.solve(system, solution);
    }
    const BlockVector b = matrix.rhs();
    BlockVector       x, r;
    x.reinit(b);
    r.reinit(b);
    if (!std::isfinite(b.l2_norm()))
      throw SolverFailure("Condensed solver: the right-hand side holds a value that is not finite.");

    Report report;
    Vector rhs, y;
    condensation->condense(b, rhs);
    y.reinit(rhs);
    if (rhs.l2_norm() > 0.)
    {
      const bool reuse = hierarchy_fits(condensation->signature(), system.layout->communicator);
      if (!reuse)
        make_multigrid(system, *condensation);
      try
      {
        report.iterations = iterate(*condensation, rhs, parameters_.tolerance, y);
      }
      catch (const SolverFailure &)
      {
        if (!reuse)
          throw;
        make_multigrid(system, *condensation);
        y                 = 0.;
        report.iterations = iterate(*condensation, rhs, parameters_.tolerance, y);
      }
      last_iterations_ = report.iterations;
      if (first_iterations_ == 0)
        first_iterations_ = last_iterations_;
    }
    condensation->expand(y, b, x);
    matrix.vmult(r, x);
    r.sadd(-1., 1., b);
    const double norm_b      = matrix.unscaled_norm(b);
    report.relative_residual = norm_b > 0. ? matrix.unscaled_norm(r) / norm_b : 0.;
    matrix.to_solution(x, solution);
    return report;
  }
} // namespace Nodus
