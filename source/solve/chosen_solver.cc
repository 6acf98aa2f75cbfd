#include "solve/chosen_solver.h"
#include "solve/direct_solver.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Displacements up to which a direct solution costs no more than 3 to 7 iterative ones
    /// (contrib/studies/scaling/size.md).
    constexpr DoFIndex largest_moderate = 20000;
    /// Iterations after which a direct solution is cheaper there.
    constexpr unsigned int most_iterations = 100;
    /// The analysis of the direct solver may take this part of what was spent before.
    constexpr double part_of_estimate = 0.1;
    /// Systems that the iterative solver gets before its mean is compared, for the first one pays for the hierarchy of
    /// several; it gets no more where it costs so many times what the direct one does, nor does a system count for
    /// more.
    constexpr unsigned int trial    = 3;
    constexpr double       hopeless = 2.;
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
      , moderate_(choice_.open() && layout.n_u <= largest_moderate)
      , parameters_(parameters.linear_solver)
      , rescue_(rescue)
      , layout_(layout)
      , nodes_(std::move(nodes))
      , remark_(remark)
  {
    profile_         = &profile;
    parameters_.type = choice_.iterative;
    if (moderate_ && rescue)
      parameters_.maximum_iterations = std::min(parameters_.maximum_iterations, most_iterations);
  }

  ChosenSolver::~ChosenSolver() = default;

  DirectSolver &ChosenSolver::direct()
  {
    if (!direct_)
    {
      direct_ = std::make_unique<DirectSolver>(layout_);
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
    if (failed_ || !choice_.open())
      return failed_ || choice_.direct;
    if (moderate_ && cut_back_)
      return true;
    return direct_work_ > 0. && iterative_work_ > direct_work_ &&
           (uses_direct_ ? in_a_row_ < wait_ : in_a_row_ >= trial || iterative_work_ >= hopeless * direct_work_);
  }

  void ChosenSolver::count(const double work, const bool of_direct)
  {
    in_a_row_ = of_direct == uses_direct_ ? in_a_row_ + 1 : 1;
    if (of_direct && !uses_direct_)
      wait_ = std::min(2 * wait_, longest_wait);
    else if (!of_direct)
    {
      const double counted = direct_work_ > 0. ? std::min(work, hopeless * direct_work_) : work;
      iterative_work_      = in_a_row_ == 1 ? counted : (1. - weight) * iterative_work_ + weight * counted;
      spent_ += work;
    }
    uses_direct_ = of_direct;
  }

  void ChosenSolver::estimate_direct(const LinearSystem &system)
  {
    if (!choice_.open() || direct_work_ > 0.)
      return;
    const DirectSolver::LeastWork least = DirectSolver::least_work(system);
    if (least.estimate > part_of_estimate * spent_ || least.solve > iterative_work_)
      return;
    try
    {
      direct_work_ = direct().estimate(system);
    }
    catch (const SolverFailure &)
    {
      direct_work_ = HUGE_VAL;
    }
    if (direct_work_ > iterative_work_)
      direct_.reset(); // it has taken memory
  }

  LinearSolver::Report ChosenSolver::solve(const LinearSystem                     &system,
                                           const std::vector<const BlockVector *> &rhs,
                                           std::vector<BlockVector>               &solutions,
                                           const double                            relative_tolerance)
  {
    const bool direct_in_use = takes_direct();
    last_is_direct_          = direct_in_use;
    double spent             = 0.; // in vain
    if (!direct_in_use)
      try
      {
        const Report report = iterative().solve(system, rhs, solutions, relative_tolerance);
        count(report.work, false);
        estimate_direct(system);
        return report;
      }
      catch (const SolverFailure &failure)
      {
        if (!rescue_ || layout_.n_u > largest_direct)
          throw;
        last_is_direct_ = true;
        spent           = iterative_work(system, 1, parameters_.maximum_iterations);
        if (!moderate_)
        {
          failed_ = true;
          remark_(std::string(failure.what()) +
                  "; this correction comes from the direct solver, and so do those after it in this increment");
        }
      }
    const Report report = direct().solve(system, rhs, solutions, relative_tolerance);
    direct_work_        = report.work;
    if (direct_in_use ? !failed_ && !(moderate_ && cut_back_) : moderate_) // costs had a say
      count(spent + report.work, direct_in_use);
    return report;
  }

  bool ChosenSolver::solve_again(const LinearSystem &system, const BlockVector &rhs, BlockVector &solution)
  {
    if (last_is_direct_)
      return direct().solve_again(system, rhs, solution);
    if (!moderate_)
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
