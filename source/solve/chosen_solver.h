#ifndef nodus_solve_chosen_solver_h
#define nodus_solve_chosen_solver_h

#include "solve/linear_solver.h"

#include <functional>
#include <memory>
#include <string>

namespace Nodus
{
  class DirectSolver;

  /// The linear solver that the parameters ask for.
  ///
  /// With Type = automatic small models take the direct one and very large ones the iterative one. Those between begin
  /// with the iterative one, and take whichever costs less once the direct one is known by its symbolic analysis, which
  /// is made when ten times what it takes was spent and the direct one may be the cheaper of the two; the iterative
  /// one is tried again after a number of systems that doubles each time. Costs are counted
  /// (LinearSolver::Report::work), not timed, so that a run can be repeated to the last digit. In models of moderate
  /// size systems of an increment that was cut back go to the direct one, which says more about them.
  ///
  /// Where an iterative solver fails the direct one steps in, if the system is not too large for that. In models of
  /// moderate size with a choice the cost of both counts for the iterative one; otherwise the direct one stays until
  /// begin_increment(), because the next systems are no easier.
  class ChosenSolver : public LinearSolver
  {
  public:
    /// @p rescue: whether there is a direct solver to fall back on; @p remark says what happened. The layout outlives
    /// the solver.
    ChosenSolver(const Parameters                               &parameters,
                 bool                                            rescue,
                 const BlockLayout                              &layout,
                 DisplacementNodes                               nodes,
                 Profile                                        &profile,
                 const std::function<void(const std::string &)> &remark);
    ~ChosenSolver() override;

    /// @param cut_back from a longer one, which failed
    void begin_increment(const bool cut_back)
    {
      failed_   = false;
      cut_back_ = cut_back;
    }
    /// Of the last system.
    LinearSolverParameters::Type type() const
    {
      return last_is_direct_ ? LinearSolverParameters::Type::direct : choice_.iterative;
    }

    using LinearSolver::solve;
    Report solve(const LinearSystem                     &system,
                 const std::vector<const BlockVector *> &rhs,
                 std::vector<BlockVector>               &solutions,
                 double                                  relative_tolerance) override;
    /// Where the iterative solver was chosen in a model of moderate size it solves to a tenth: that is enough to tell
    /// an instability.
    bool solve_again(const LinearSystem &system, const BlockVector &rhs, BlockVector &solution) override;

  private:
    bool          takes_direct() const;
    DirectSolver &direct();
    LinearSolver &iterative();
    void          count(double work, bool of_direct);
    /// Looks at what the direct solver would take, where that is worth its cost.
    void estimate_direct(const LinearSystem &system);

    const LinearSolverChoice choice_;
    const bool               moderate_;   ///< size: a direct solution is never dear, and there is a choice
    LinearSolverParameters   parameters_; ///< of the iterative solver
    bool                     rescue_;
    const BlockLayout       &layout_;
    DisplacementNodes        nodes_; ///< until the iterative solver takes them
    std::function<void(const std::string &)> remark_;
    std::unique_ptr<DirectSolver>            direct_; ///< once they were needed
    std::unique_ptr<LinearSolver>            iterative_;
    bool                                     failed_   = false; ///< the iterative one has, in this increment
    bool                                     cut_back_ = false;
    bool         uses_direct_ = false, last_is_direct_ = false; ///< of those to choose from; for the last system
    double       direct_work_ = 0., iterative_work_ = 0.;       ///< of a system; 0: unknown
    double       spent_    = 0.;                                ///< by the iterative one so far
    unsigned int in_a_row_ = 0;                                 ///< systems that the one in use has solved
    unsigned int wait_     = 8;                                 ///< systems until the iterative one is tried again
  };
} // namespace Nodus

#endif
