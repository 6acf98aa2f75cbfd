#include "solve/condensed_solver.h"
#include "solve/block_solver.h"
#include "solve/condensation.h"
#include "solve/left_gmres.h"
#include "solve/multigrid/multigrid.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// A hierarchy is made anew when its iterations per digit have grown by this factor, or more slave nodes than these
    /// have other constraints than when it was made: setting it up costs as much as some ten cycles, and each such node
    /// about one iteration, in a model of any size.
    constexpr double       growth       = 1.4;
    constexpr unsigned int most_changed = 4;
    /// Iterations that end before that do not count: the first digit takes more than others.
    constexpr double one_digit = 0.1;

    /// Condensation, one multigrid cycle and expansion: exact but for multigrid and the variation.
    class CondensedCycle
    {
    public:
      CondensedCycle(Condensation &condensation, const DisplacementPreconditioner &multigrid, const BlockVector &b)
          : condensation_(condensation)
          , multigrid_(multigrid)
          , rhs_(b.block(0))
          , y_(b.block(0))
      {
      }
      void vmult(BlockVector &x, const BlockVector &b) const
      {
        condensation_.condense(b, rhs_);
        multigrid_.vmult(y_, rhs_);
        condensation_.expand(y_, b, x);
      }

    private:
      Condensation                     &condensation_;
      const DisplacementPreconditioner &multigrid_;
      mutable Vector                    rhs_, y_;
    };

    [[noreturn]] void fail(const double residual, const unsigned int iterations, const double tolerance)
    {
      std::ostringstream message;
      message << "Condensed solver: relative residual " << residual << " after " << iterations
              << " iterations (wanted: " << tolerance << "); use 'Type = direct'";
      throw SolverFailure(message.str(), SolverFailure::Kind::linear_solver);
    }
  } // namespace

  CondensedSolver::CondensedSolver(const LinearSolverParameters &parameters, DisplacementNodes nodes)
      : parameters_(parameters)
      , nodes_(std::move(nodes))
      , multigrid_(make_displacement_preconditioner(parameters.preconditioner, 2))
  {
  }

  void CondensedSolver::make_multigrid(const LinearSystem &system, const Condensation &condensation)
  {
    const auto timer = time_set_up();
    set_up_          = false;
    multigrid_->release(); // before the modes take memory
    std::vector<double> modes = rigid_body_modes(system.bulk, nodes_.positions);
    condensation.transform_modes(modes);
    multigrid_->set_up(system.bulk, condensation.constraints(), std::move(modes), nodes_);
    set_up_           = true;
    signature_        = condensation.signature();
    first_iterations_ = last_iterations_ = 0.;
  }

  bool CondensedSolver::hierarchy_fits(const std::vector<char> &signature, const MPI_Comm communicator) const
  {
    if (!set_up_ || last_iterations_ > growth * first_iterations_ + 0.6)
      return false;
    unsigned int changed = 0;
    for (unsigned int k = 0; k < signature.size(); ++k)
      changed += signature[k] != signature_[k];
    return dealii::Utilities::MPI::sum(changed, communicator) <= most_changed;
  }

  bool CondensedSolver::conjugate_gradients(const Condensation &condensation,
                                            const Vector       &rhs,
                                            const double        tolerance,
                                            Vector             &y,
                                            unsigned int       &iterations) const
  {
    iterations = 0;
    y.reinit(rhs);
    if (rhs.l2_norm() == 0.)
      return true;
    dealii::SolverControl control(parameters_.maximum_iterations, tolerance * rhs.l2_norm(), false, false);
    bool                  converged = true;
    try
    {
      dealii::SolverCG<Vector>(control).solve(condensation, y, rhs, *multigrid_);
    }
    catch (const dealii::SolverControl::NoConvergence &)
    {
      converged = false;
    }
    iterations = control.last_step();
    return converged;
  }

  unsigned int CondensedSolver::gmres(const SaddlePointOperator &matrix,
                                      Condensation              &condensation,
                                      const BlockVector         &b,
                                      const double               tolerance,
                                      BlockVector               &x) const
  {
    const CondensedCycle cycle(condensation, *multigrid_, b);
    const KrylovReport   report = left_gmres(
        matrix,
        [&](BlockVector &z, const BlockVector &r) { cycle.vmult(z, r); },
        b,
        tolerance,
        parameters_.maximum_iterations,
        x);
    if (!(report.residual <= tolerance))
      fail(report.residual, report.iterations, tolerance);
    return report.iterations;
  }

  unsigned int CondensedSolver::iterate(const SaddlePointOperator &matrix,
                                        Condensation              &condensation,
                                        const BlockVector         &b,
                                        const double               tolerance,
                                        BlockVector               &x) const
  {
    x              = 0.;
    unsigned int n = 0;
    if (matrix.symmetric())
    {
      Vector rhs(b.block(0)), y;
      condensation.condense(b, rhs);
      if (conjugate_gradients(condensation, rhs, tolerance, y, n))
      {
        condensation.expand(y, b, x);
        return n;
      }
    }
    // has a variation, or is not positive definite: a structure that buckles
    return n + gmres(matrix, condensation, b, tolerance, x);
  }

  LinearSolver::Report CondensedSolver::solve(const LinearSystem                     &system,
                                              const std::vector<const BlockVector *> &rhs,
                                              std::vector<BlockVector>               &solutions,
                                              const double                            relative_tolerance)
  {
    const double                  tolerance = std::max(parameters_.tolerance, relative_tolerance);
    const SaddlePointOperator     matrix(system);
    std::unique_ptr<Condensation> condensation;
    try
    {
      const auto timer = time_set_up();
      condensation     = std::make_unique<Condensation>(matrix);
    }
    catch (const NotCondensable &)
    {
      if (!block_solver_)
        block_solver_ = std::make_unique<BlockSolver>(parameters_, nodes_);
      block_solver_->set_profile(profile_);
      return block_solver_->solve(system, rhs, solutions, relative_tolerance);
    }
    unsigned int n_set_up = 0;
    bool         first    = true; // of the right-hand sides that are not zero
    const auto   find_x   = [&](const BlockVector &b, BlockVector &x)
    {
      const bool reuse = !first || hierarchy_fits(condensation->signature(), system.layout->communicator);
      if (!reuse)
      {
        make_multigrid(system, *condensation);
        ++n_set_up;
      }
      unsigned int iterations;
      try
      {
        iterations = iterate(matrix, *condensation, b, tolerance, x);
      }
      catch (const SolverFailure &)
      {
        if (!reuse)
          throw;
        make_multigrid(system, *condensation);
        ++n_set_up;
        iterations = iterate(matrix, *condensation, b, tolerance, x);
      }
      if (first && tolerance < one_digit)
      {
        last_iterations_ = iterations / -std::log10(tolerance);
        if (first_iterations_ == 0.)
          first_iterations_ = last_iterations_;
      }
      first = false;
      return iterations;
    };
    Report report = matrix.solve_each(rhs, "Condensed solver", find_x, solutions);
    report.work   = iterative_work(system, n_set_up, report.iterations);
    return report;
  }
} // namespace Nodus
