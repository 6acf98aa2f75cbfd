#include <nodus/solve/newton.h>

#include <deal.II/lac/trilinos_parallel_block_vector.h>

#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int maximum_halvings = 5;

    [[noreturn]] void fail(const std::string &reason, const NewtonProblem::Norms &norms)
    {
      std::ostringstream message;
      message << "Newton " << reason << ": relative force residual " << norms.force << ", contact residual "
              << norms.contact;
      throw SolverFailure(message.str());
    }
  } // namespace

  Newton::Newton(const NewtonParameters &parameters)
      : parameters_(parameters)
  {
  }

  bool Newton::converged(const NewtonProblem::Norms &norms) const
  {
    return norms.force <= parameters_.force_tolerance && norms.contact <= parameters_.contact_tolerance &&
           norms.prescribed <= parameters_.contact_tolerance;
  }

  Newton::Report Newton::solve(NewtonProblem &problem, const Log &log) const
  {
    Report               report;
    BlockVector          correction;
    NewtonProblem::Norms norms = problem.assemble();
    log(0, norms, 0);
    while (!converged(norms))
    {
      if (!std::isfinite(norms.force + norms.contact))
        fail("met numbers that are not finite", norms);
      if (report.iterations == parameters_.maximum_iterations)
        fail("did not converge in " + std::to_string(report.iterations) + " iterations", norms);

      const unsigned int krylov_iterations = problem.solve(correction);
      report.krylov_iterations += krylov_iterations;
      ++report.iterations;
      problem.advance(1., correction);

      // The first correction moves the prescribed displacements: its force residual says nothing about progress.
      const bool search = parameters_.line_search && norms.prescribed <= parameters_.contact_tolerance;
      double     step   = 1.;
      for (unsigned int halving = 0;; ++halving)
      {
        NewtonProblem::Norms trial;
        bool                 accept = true;
        try
        {
          trial  = problem.assemble();
          accept = !search || trial.force <= std::max(norms.force, parameters_.force_tolerance);
        }
        catch (const SolverFailure &)
        {
          if (halving == maximum_halvings)
            throw;
          accept = false;
        }
        if (accept || halving == maximum_halvings)
        {
          norms = trial;
          break;
        }
        problem.advance(-0.5 * step, correction);
        step *= 0.5;
      }
      log(report.iterations, norms, krylov_iterations);
    }
    return report;
  }
} // namespace Nodus
