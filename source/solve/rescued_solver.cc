#include "solve/rescued_solver.h"

namespace Nodus
{
  namespace
  {
    /// Displacements up to which the direct solver steps in.
    constexpr DoFIndex largest_direct = 150000;
  } // namespace

  RescuedSolver::RescuedSolver(const LinearSolverParameters                   &parameters,
                               const bool                                      rescue,
                               const BlockLayout                              &layout,
                               const std::vector<Point>                       &node_positions,
                               Profile                                        &profile,
                               const std::function<void(const std::string &)> &remark)
      : type_(parameters.type)
      , rescue_(rescue)
      , layout_(layout)
      , remark_(remark)
      , asked_(make_linear_solver(parameters, layout, node_positions))
  {
    profile_ = &profile;
    asked_->set_profile(profile_);
  }

  LinearSolver::Report RescuedSolver::solve(const LinearSystem                     &system,
                                            const std::vector<const BlockVector *> &rhs,
                                            std::vector<BlockVector>               &solutions,
                                            const double                            relative_tolerance)
  {
    if (!direct_)
      try
      {
        return asked_->solve(system, rhs, solutions, relative_tolerance);
      }
      catch (const SolverFailure &failure)
      {
        if (!rescue_ || type_ == LinearSolverParameters::Type::direct || layout_.n_u > largest_direct)
          throw;
        remark_(std::string(failure.what()) +
                "; this correction comes from the direct solver, and so do those after it in this increment");
        direct_ = make_linear_solver(LinearSolverParameters(), layout_, {});
        direct_->set_profile(profile_);
      }
    return direct_->solve(system, rhs, solutions, relative_tolerance);
  }
} // namespace Nodus
