#include <nodus/solve/block_solver.h>
#include <nodus/solve/condensed_solver.h>
#include <nodus/solve/direct_solver.h>
#include <nodus/solve/linear_solver.h>

namespace Nodus
{
  void BlockLayout::reinit(BlockVector &v) const
  {
    v.reinit(std::vector<dealii::IndexSet>(owned.begin(), owned.end()), communicator);
  }

  std::unique_ptr<LinearSolver> make_linear_solver(const LinearSolverParameters &parameters,
                                                   const BlockLayout            &layout,
                                                   const std::vector<Point>     &node_positions)
  {
    if (parameters.type == LinearSolverParameters::Type::direct)
      return std::make_unique<DirectSolver>(layout);
    if (parameters.type == LinearSolverParameters::Type::condensed)
      return std::make_unique<CondensedSolver>(parameters, node_positions);
    return std::make_unique<BlockSolver>(parameters, node_positions);
  }
} // namespace Nodus
