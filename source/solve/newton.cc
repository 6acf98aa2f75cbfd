#include "solve/newton.h"

#include <deal.II/lac/la_parallel_block_vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Nodus
{
  namespace
  {
    constexpr double forcing_factor = 0.9;

    /// Forcing terms (eq. N6): choice 2 of Eisenstat & Walker (1996). @p residual and @p before in units of the
    /// tolerance; @p last: forcing term before this one. The last correction need not overshoot the tolerance by more
    /// than a digit, and terms fall no faster than Newton converges.
    double forcing_term(const double residual, const double before, const double last, const double largest)
    {
      const double ratio = residual / before;
      const double term  = std::max(forcing_factor * ratio * ratio, forcing_factor * last * last);
      return std::min(largest, std::max(term, 0.1 / residual));
    }

    /// Residual in units of the tolerance up to which an iterate without changes goes on to converge as it did.
    constexpr double near_end = 1e4;
    /// Residual, likewise, that the tangent of the iterate before may be expected to lead to.
    constexpr double kept_residual = 0.05;

    /// Whether the correction at @p residual, where no choice has changed, will be the last one if Newton's method
    /// converges quadratically from @p before on (eq. N7).
    bool is_last(const double residual, const double before)
    {
      const double ratio = residual / before;
      return residual <= near_end && residual * ratio * ratio <= 1.;
    }

    /// Whether the tangent at the iterate of residual @p before leads from @p residual to one that is small enough:
    /// where Newton's method converges quadratically, it leaves the product of the two errors (eq. N7).
    bool keeps_tangent(const double residual, const double before)
    {
      return residual <= near_end && residual * residual <= kept_residual * before;
    }

    /// Part of the largest force that an iterate leaves out of balance which is on its way to an equilibrium.
    constexpr double near_balance = 0.5;

    [[noreturn]] void fail(const std::string &reason, const NewtonProblem::Norms &norms, const SolverFailure::Kind kind)
    {
      std::ostringstream message;
      message << "Newton " << reason << ": relative force residual " << norms.force << ", contact residual "
              << norms.contact;
      throw SolverFailure(message.str(), kind);
    }
  } // namespace

  Newton::Newton(const NewtonParameters &parameters, const unsigned int patience, const unsigned int halvings)
      : parameters_(parameters)
      , patience_(patience)
      , halvings_(halvings)
  {
  }

  /// Eq. N5.
  double Newton::residual(const NewtonProblem::Norms &norms) const
  {
    return std::max(norms.force / parameters_.force_tolerance,
                    std::max(norms.contact, norms.prescribed) / parameters_.contact_tolerance);
  }

  bool Newton::converged(const NewtonProblem::Norms &norms) const
  {
    return norms.changes == 0 && residual(norms) <= 1.;
  }

  Newton::Report Newton::solve(NewtonProblem &problem, const Log &log) const
  {
    Report      report;
    BlockVector correction;
    problem.evaluate(false, false);
    NewtonProblem::Norms norms = problem.accept(0);
    log(0, norms, 0);
    double       before = 0., forcing = parameters_.largest_forcing_term, best = std::numeric_limits<double>::max();
    double       nearest = best; // to balance
    unsigned int fewest = std::numeric_limits<unsigned int>::max(), idle = 0;
    while (problem.is_guess() || !converged(norms))
    {
      if (!std::isfinite(norms.force + norms.contact))
        fail("met numbers that are not finite", norms, SolverFailure::Kind::not_finite);
      if (report.iterations == parameters_.maximum_iterations)
        fail("did not converge in " + std::to_string(report.iterations) + " iterations",
             norms,
             SolverFailure::Kind::newton_limit);

      // What Newton starts from, often the solution of a system before, is no measure of progress: statuses follow from
      // the first correction on.
      const double now = residual(norms);
      if (report.iterations > 0)
      {
        idle    = now < best || norms.changes < fewest ? 0 : idle + 1;
        best    = std::min(best, now);
        fewest  = std::min(fewest, norms.changes);
        nearest = std::min(nearest, norms.force);
      }
      if (patience_ > 0 && idle >= patience_)
        fail("stalled: no progress in " + std::to_string(idle) + " iterations",
             norms,
             nearest > near_balance ? SolverFailure::Kind::newton_lost : SolverFailure::Kind::newton_stalled);

      if (report.iterations > 0)
        forcing = forcing_term(now, before, forcing, parameters_.largest_forcing_term);
      const bool settled                   = report.iterations > 0 && norms.changes == 0;
      const bool again                     = settled && keeps_tangent(now, before);
      const bool last                      = again || (settled && is_last(now, before));
      before                               = now;
      const unsigned int krylov_iterations = problem.solve(correction, forcing, again);
      report.krylov_iterations += krylov_iterations;
      ++report.iterations;
      // with nothing left to choose, a step that leads back up belongs to a cycle at a kink of a law
      take_step(problem, correction, norms, parameters_.line_search || (idle > 0 && norms.changes == 0), last);
      norms = problem.accept(report.iterations);
      log(report.iterations, norms, krylov_iterations);
    }
    return report;
  }

  void Newton::take_step(NewtonProblem              &problem,
                         const BlockVector          &correction,
                         const NewtonProblem::Norms &norms,
                         const bool                  line_search,
                         const bool                  last) const
  {
    // The first correction moves the prescribed displacements: its force residual says nothing about progress. Where a
    // status has just changed, forces balance still and the contact laws do not: the largest of the norms is what
    // counts.
    const bool search = line_search && norms.prescribed <= parameters_.contact_tolerance;
    double     step   = 1.;
    for (unsigned int halving = 0;; ++halving)
    {
      const bool shortest = halving == halvings_;
      problem.move(step, correction);
      try
      {
        const NewtonProblem::Norms trial = problem.evaluate(search && !shortest, last);
        if (!search || shortest || residual(trial) <= std::max(residual(norms), 1.))
          return;
      }
      catch (const SolverFailure &failure)
      {
        if (shortest || failure.kind() != SolverFailure::Kind::inverted_cell)
          throw;
      }
      step *= 0.5;
    }
  }
} // namespace Nodus
