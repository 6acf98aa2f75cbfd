#ifndef nodus_solve_rescued_solver_h
#define nodus_solve_rescued_solver_h

#include "solve/linear_solver.h"

#include <functional>
#include <memory>
#include <string>

namespace Nodus
{
  /// A linear solver whose systems go to the direct one where it fails, if they are not too large for that: from there
  /// on until begin_increment(), because the next systems are no easier.
  class RescuedSolver : public LinearSolver
  {
  public:
    /// @p parameters whose type is not automatic; @p rescue: whether there is a direct solver to fall back on; @p
    /// remark says what happened. The layout outlives the solver.
    RescuedSolver(const LinearSolverParameters                   &parameters,
                  bool                                            rescue,
                  const BlockLayout                              &layout,
                  const std::vector<Point>                       &node_positions,
                  Profile                                        &profile,
                  const std::function<void(const std::string &)> &remark);

    void begin_increment()
    {
      direct_.reset();
    }
    LinearSolverParameters::Type type() const
    {
      return type_;
    }

    using LinearSolver::solve;
    Report solve(const LinearSystem                     &system,
                 const std::vector<const BlockVector *> &rhs,
                 std::vector<BlockVector>               &solutions,
                 double                                  relative_tolerance) override;
    bool   solve_again(const LinearSystem &system, const BlockVector &rhs, BlockVector &solution) override
    {
      return (direct_ ? direct_ : asked_)->solve_again(system, rhs, solution);
    }

  private:
    LinearSolverParameters::Type             type_;
    bool                                     rescue_;
    const BlockLayout                       &layout_;
    std::function<void(const std::string &)> remark_;
    std::unique_ptr<LinearSolver>            asked_, direct_; ///< direct_: once the other has failed
  };
} // namespace Nodus

#endif
