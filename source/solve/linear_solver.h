#ifndef nodus_solve_linear_solver_h
#define nodus_solve_linear_solver_h

#include "base/profile.h"
#include "solve/displacement_nodes.h"
#include "solve/linear_system.h"
#include <nodus/parameters/parameters.h>

#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// Solves the saddle-point systems of the contact Newton. Knows no physics.
  class LinearSolver
  {
  public:
    struct Report
    {
      unsigned int iterations        = 0;  ///< Krylov iterations; 0 for direct
      double       relative_residual = 0.; ///< of the true system, 2-norm
      /// What it cost, on all ranks [CPU microseconds of the machine of contrib/studies/scaling]: an estimate from
      /// counts, the same in every run
      double work = 0.;
      /// direct only: negative pivots (a stable system has one for each multiplier) and the flat indices of null pivots
      long                  negative_pivots = -1;
      std::vector<DoFIndex> null_pivots;
    };

    virtual ~LinearSolver() = default;

    /// @p solution is reinitialised to the layout of the right-hand side. The result is the same on every rank count
    /// to the tolerance. @throws SolverFailure on every rank when the system cannot be solved; a singular system is
    /// solved with null pivots reported (direct), the caller decides.
    /// An iterative solver may stop at @p relative_tolerance, or at its own tolerance where that is larger.
    Report solve(const LinearSystem &system, BlockVector &solution, const double relative_tolerance = 0.)
    {
      std::vector<BlockVector> solutions;
      const Report             report = solve(system, {&system.rhs}, solutions, relative_tolerance);
      solution.reinit(solutions.front(), true); // swap() needs as many blocks
      solution.swap(solutions.front());
      return report;
    }
    /// The same for the right-hand sides @p rhs, at least one, instead of that of @p system. The report is that of the
    /// first one, with the iterations of all.
    virtual Report solve(const LinearSystem                     &system,
                         const std::vector<const BlockVector *> &rhs,
                         std::vector<BlockVector>               &solutions,
                         double                                  relative_tolerance) = 0;

    /// Solves with the factors of the last solve() again, as far as they go without refinement. @returns false where
    /// there are none: iterative solvers. Collective.
    virtual bool solve_again(const LinearSystem &, const BlockVector & /*rhs*/, BlockVector & /*solution*/)
    {
      return false;
    }

    /// Set-up counts as Phase::solver_set_up from now on.
    void set_profile(Profile *profile)
    {
      profile_ = profile;
    }

  protected:
    /// Times the set-up of a preconditioner or factorisation, until the returned object dies.
    [[nodiscard]] Profile::Scope time_set_up() const
    {
      return Profile::Scope(profile_, Phase::solver_set_up);
    }

    Profile *profile_ = nullptr;
  };

  /// LinearSolver::Report::work of Krylov iterations with multigrid, and of setting the hierarchy up. Collective.
  double iterative_work(const LinearSystem &system, unsigned int n_set_up, unsigned int n_iterations);

  /// Displacements up to which the direct solver may be taken where it was not asked for.
  constexpr DoFIndex largest_direct = 150000;

  /// What a model may take, as the parameters ask for.
  struct LinearSolverChoice
  {
    bool                         direct;
    LinearSolverParameters::Type iterative; ///< direct: none

    /// Whichever costs less.
    bool open() const
    {
      return direct && iterative != LinearSolverParameters::Type::direct;
    }
    std::string text() const;
  };
  LinearSolverChoice solver_choice(const Parameters &parameters, DoFIndex n_displacements);

  /// @param parameters whose type is not automatic
  /// @param nodes in the order of their degrees of freedom, for multigrid
  std::unique_ptr<LinearSolver>
  make_linear_solver(const LinearSolverParameters &parameters, const BlockLayout &layout, DisplacementNodes nodes);
} // namespace Nodus

#endif
