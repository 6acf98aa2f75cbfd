#include "solve/linear_solver.h"
#include "solve/block_solver.h"
#include "solve/condensed_solver.h"
#include "solve/direct_solver.h"

namespace Nodus
{
  namespace
  {
    /// Displacements up to which a direct solution costs 2.5 times the CPU of an iterative one at most (3 to 7 times
    /// for 50000: contrib/studies/scaling/size.md), which slender bodies repay.
    constexpr DoFIndex largest_small = 20000;
  } // namespace

  void BlockLayout::reinit(BlockVector &v) const
  {
    v.reinit(owned.size());
    for (unsigned int b = 0; b < owned.size(); ++b)
      v.block(b).reinit(owned[b], communicator);
    v.collect_sizes();
  }

  LinearSolverParameters::Type chosen_solver(const Parameters &parameters, const DoFIndex n_displacements)
  {
    using Type = LinearSolverParameters::Type;
    if (parameters.linear_solver.type != Type::automatic)
      return parameters.linear_solver.type;
    if (n_displacements <= largest_small)
      return Type::direct;
    for (const auto &pair : parameters.contact_pairs)
      if (pair.scheme == ContactPairParameters::Scheme::integration_point ||
          pair.weights == ContactPairParameters::Weights::consistent)
        return Type::block;
    return Type::condensed;
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
