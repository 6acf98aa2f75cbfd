#include "solve/linear_solver.h"
#include "solve/block_solver.h"
#include "solve/condensed_solver.h"
#include "solve/direct_solver.h"

#include <deal.II/base/mpi.h>

namespace Nodus
{
  namespace
  {
    /// Displacements up to which costs do not matter: the direct solver says more about a system.
    constexpr DoFIndex largest_small = 1500;
  } // namespace

  void BlockLayout::reinit(BlockVector &v) const
  {
    v.reinit(owned.size());
    for (unsigned int b = 0; b < owned.size(); ++b)
      v.block(b).reinit(owned[b], communicator);
    v.collect_sizes();
  }

  double iterative_work(const LinearSystem &system, const unsigned int n_set_up, const unsigned int n_iterations)
  {
    // per block of the bulk: eliminating the multipliers, the hierarchy, one iteration (2000 to 52000 displacements)
    constexpr double condensation = 0.15, hierarchy = 0.9, iteration = 0.08;
    const double     n_blocks =
        dealii::Utilities::MPI::sum<double>(system.bulk.values().size() / (dim * dim), system.layout->communicator);
    return n_blocks * (condensation + hierarchy * n_set_up + iteration * n_iterations);
  }

  LinearSolverChoice solver_choice(const Parameters &parameters, const DoFIndex n_displacements)
  {
    using Type      = LinearSolverParameters::Type;
    const Type type = parameters.linear_solver.type;
    if (type != Type::automatic)
      return {type == Type::direct, type};
    if (n_displacements <= largest_small)
      return {true, Type::direct};
    Type iterative = Type::condensed;
    for (const auto &pair : parameters.contact_pairs)
      if (pair.scheme == ContactPairParameters::Scheme::integration_point ||
          pair.weights == ContactPairParameters::Weights::consistent)
        iterative = Type::block;
    return {n_displacements <= largest_direct, iterative};
  }

  std::string LinearSolverChoice::text() const
  {
    const std::string name = text_of(iterative);
    return open() ? "direct or " + name + ", whichever costs less" : name;
  }

  std::unique_ptr<LinearSolver>
  make_linear_solver(const LinearSolverParameters &parameters, const BlockLayout &layout, DisplacementNodes nodes)
  {
    AssertThrow(parameters.type != LinearSolverParameters::Type::automatic, dealii::ExcInternalError());
    if (parameters.type == LinearSolverParameters::Type::direct)
      return std::make_unique<DirectSolver>(layout);
    if (parameters.type == LinearSolverParameters::Type::condensed)
      return std::make_unique<CondensedSolver>(parameters, std::move(nodes));
    return std::make_unique<BlockSolver>(parameters, std::move(nodes));
  }
} // namespace Nodus
