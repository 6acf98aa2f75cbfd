#include <nodus/solve/block_solver.h>
#include <nodus/solve/condensed_solver.h>
#include <nodus/solve/direct_solver.h>
#include <nodus/solve/linear_solver.h>

namespace Nodus
{
  namespace
  {
    /// Displacements up to which the direct solver is faster than the condensed one, and than the block solver
    /// (measured: contrib/studies/scaling, "Which solver").
    constexpr DoFIndex largest_direct = 20000, largest_direct_of_block = 60000;
  } // namespace

  void BlockLayout::reinit(BlockVector &v) const
  {
    v.reinit(std::vector<dealii::IndexSet>(owned.begin(), owned.end()), communicator);
  }

  LinearSolverParameters::Type chosen_solver(const Parameters &parameters, const DoFIndex n_displacements)
  {
    using Type = LinearSolverParameters::Type;
    if (parameters.linear_solver.type != Type::automatic)
      return parameters.linear_solver.type;
    bool condensable = true;
    for (const auto &pair : parameters.contact_pairs)
      condensable = condensable && pair.scheme != ContactPairParameters::Scheme::integration_point &&
                    pair.weights != ContactPairParameters::Weights::consistent;
    if (n_displacements <= (condensable ? largest_direct : largest_direct_of_block))
      return Type::direct;
    return condensable ? Type::condensed : Type::block;
  }

  std::unique_ptr<LinearSolver> make_linear_solver(const LinearSolverParameters &parameters,
                                                   const BlockLayout            &layout,
                                                   const std::vector<Point>     &node_positions)
  {
    AssertThrow(parameters.type != LinearSolverParameters::Type::automatic, dealii::ExcInternalError());
    if (parameters.type == LinearSolverParameters::Type::direct)
      return std::make_unique<DirectSolver>(layout);
    if (parameters.type == LinearSolverParameters::Type::condensed)
      return std::make_unique<CondensedSolver>(parameters, node_positions);
    return std::make_unique<BlockSolver>(parameters, node_positions);
  }
} // namespace Nodus
