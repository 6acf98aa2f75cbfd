#include "solve/chosen_solver.h"

#include <algorithm>

namespace Nodus
{
  namespace
  {
    /// Displacements up to which the direct solver steps in.
    constexpr DoFIndex largest_direct = 150000;
    /// Iterations after which a direct solution is cheaper in models that have the choice.
    constexpr unsigned int most_iterations = 100;
    /// Systems that the iterative solver gets before its mean is compared: the first one pays for the hierarchy of
    /// several.
    constexpr unsigned int trial = 3;
    /// Weight of the last system in that mean.
    constexpr double weight = 0.3;
    /// Systems of the direct solver after which the iterative one is tried again at the latest.
    constexpr unsigned int longest_wait = 1024;
  } // namespace

  ChosenSolver::ChosenSolver(const Parameters                               &parameters,
                             const bool                                      rescue,
                             const BlockLayout                              &layout,
                             DisplacementNodes                               nodes,
                             Profile                                        &profile,
                             const std::function<void(const std::string &)> &remark)
      : choice_(solver_choice(parameters, layout.n_u))
      , parameters_(parameters.linear_solver)
      , rescue_(rescue)
      , layout_(layout)
      , nodes_(std::move(nodes))
      , remark_(remark)
  {
    profile_         = &profile;
    parameters_.type = choice_.iterative;
    if (choice_.open() && rescue)
      parameters_.maximum_iterations = std::min(parameters_.maximum_iterations, most_iterations);
  }

  LinearSolver &ChosenSolver::direct()
  {
    if (!direct_)
    {
      direct_ = make_linear_solver(LinearSolverParameters(), layout_, {});
      direct_->set_profile(profile_);
    }
    return *direct_;
  }

  LinearSolver &ChosenSolver::iterative()
  {
    if (!iterative_)
    {
      iterative_ = make_linear_solver(parameters_, layout_, std::move(nodes_));
      iterative_->set_profile(profile_);
    }
    return *iterative_;
  }

  bool ChosenSolver::takes_direct() const
  {
    if (!choice_.open())
      return choice_.direct || failed_;
    if (cut_back_ || direct_work_ == 0.)
      return true;
    return iterative_work_ > direct_work_ && (uses_direct_ ? in_a_row_ < wait_ : in_a_row_ >= trial);
  }

  void ChosenSolver::count(const double work, const bool of_direct)
  {
    in_a_row_ = of_direct == uses_direct_ ? in_a_row_ + 1 : 1;
    if (of_direct && !uses_direct_)
      wait_ = std::min(2 * wait_, longest_wait);
    else if (!of_direct)
      iterative_work_ = in_a_row_ == 1 ? work : (1. - weight) * iterative_work_ + weight * work;
    uses_direct_ = of_direct;
  }

  LinearSolver::Report ChosenSolver::solve(const LinearSystem                     &system,
                                           const std::vector<const BlockVector *> &rhs,
                                           std::vector<BlockVector>               &solutions,
                                           const double                            relative_tolerance)
  {
    const bool direct_in_use = takes_direct();
    last_is_direct_          = direct_in_use;
    if (!direct_in_use)
      try
      {
        const Report report = iterative().solve(system, rhs, solutions, relative_tolerance);
        count(report.work, false);
        return report;
      }
      catch (const SolverFailure &failure)
      {
        if (!rescue_ || layout_.n_u > largest_direct)
          throw;
        last_is_direct_ = true;
        if (!choice_.open())
        {
          failed_ = true;
          remark_(std::string(failure.what()) +
                  "; this correction comes from the direct solver, and so do those after it in this increment");
        }
      }
    const Report report = direct().solve(system, rhs, solutions, relative_tolerance);
    const bool   known  = direct_work_ > 0.;
    direct_work_        = report.work;
    if (!choice_.open() || !known || cut_back_)
      return report; // costs had no say
    count(direct_in_use ? report.work : iterative_work_ + report.work,
          direct_in_use); // that of both where one has failed
    return report;
  }

  bool ChosenSolver::solve_again(const LinearSystem &system, const BlockVector &rhs, BlockVector &solution)
  {
    if (last_is_direct_)
      return direct().solve_again(system, rhs, solution);
    if (!choice_.open())
      return false;
    constexpr double tolerance = 0.1;
    try
    {
      std::vector<BlockVector> solutions;
      iterative().solve(system, {&rhs}, solutions, tolerance);
      solution.reinit(solutions.front(), true);
      solution.swap(solutions.front());
      return true;
    }
    catch (const SolverFailure &)
    {
      return false;
    }
  }
} // namespace Nodus
