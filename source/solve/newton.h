#ifndef nodus_solve_newton_h
#define nodus_solve_newton_h

#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <functional>

namespace Nodus
{
  /// What Newton needs of a nonlinear problem: it sees no physics.
  class NewtonProblem
  {
  public:
    /// Relative violations at the current iterate, all to be small.
    struct Norms
    {
      double force      = 0.; ///< nodal equilibrium
      double contact    = 0.; ///< contact and friction laws
      double prescribed = 0.; ///< prescribed displacements still to be met
      /// Discrete choices inside the problem (statuses) that this iterate contradicted and that were changed.
      unsigned int changes = 0;
    };

    virtual ~NewtonProblem() = default;
    /// Forces and their tangent at the trial iterate, every choice (pairing, thresholds, statuses) as it is. @p last:
    /// no correction is expected from here, the tangent may wait until solve() wants it.
    /// @returns the norms of the trial if @p measure, otherwise zeros. @throws SolverFailure where they do not exist,
    /// of the kind inverted_cell where half the step may help.
    virtual Norms evaluate(bool measure, bool last) = 0;
    /// The trial that was evaluated last is the iterate from here on: the choices follow it. @p iteration: corrections
    /// so far. Completes the residual. @throws SolverFailure
    virtual Norms accept(unsigned int iteration) = 0;
    /// Completes the tangent and finds the @p correction, whose linear residual is reduced by @p relative_tolerance at
    /// least. @p again: no choice has changed since the last one and the iterate has hardly moved, so that its tangent,
    /// or what of it is dear, will do. Returns the Krylov iterations.
    virtual unsigned int solve(BlockVector &correction, double relative_tolerance, bool again) = 0;
    /// The iterate is a guess at which no system has been solved: it is corrected once in any case, so that what the
    /// tangent says of it (stability) is seen.
    virtual bool is_guess() const
    {
      return false;
    }
    /// trial = iterate + factor * correction: nothing is left of the trial before.
    virtual void move(double factor, const BlockVector &correction) = 0;
  };

  class Newton
  {
  public:
    /// @p patience: iterations without progress after which it gives up, 0: never. Progress is a smaller residual or
    /// fewer changes than in all iterations before; the start does not count. @p halvings of a step.
    explicit Newton(const NewtonParameters &parameters, unsigned int patience = 0, unsigned int halvings = 5);

    struct Report
    {
      unsigned int iterations = 0, krylov_iterations = 0;
    };
    /// Called for each iterate: iteration, norms, Krylov iterations of the correction that led here.
    using Log = std::function<void(unsigned int, const NewtonProblem::Norms &, unsigned int)>;

    /// Solves from the current iterate; no correction when it already satisfies the tolerances without changes, and is
    /// no guess.
    /// Corrections are as exact as the next iterate can use: forcing terms of Eisenstat & Walker (1996), choice 2.
    /// A step into states that do not exist (det F <= 0) is halved, a few times at most; with line search, so is one
    /// that increases the largest norm (eq. N5) at the choices that the step was computed with. Without, this begins
    /// where no choice changes and the iterate is no better than one before. Every other failure goes up at once.
    /// @throws SolverFailure with the last norms.
    Report solve(NewtonProblem &problem, const Log &log) const;

    bool converged(const NewtonProblem::Norms &norms) const;

  private:
    /// Moves to a trial that exists and, with line search, decreases the largest norm. @p last: as of evaluate().
    void take_step(NewtonProblem              &problem,
                   const BlockVector          &correction,
                   const NewtonProblem::Norms &norms,
                   bool                        line_search,
                   bool                        last) const;
    /// Largest norm in units of its tolerance.
    double residual(const NewtonProblem::Norms &norms) const;

    NewtonParameters parameters_;
    unsigned int     patience_, halvings_;
  };
} // namespace Nodus

#endif
