#include "solve/flat_vectors.h"

#include <deal.II/base/mpi.h>

#include <array>

namespace Nodus
{
  // Triplets name multipliers of any rank, so every rank needs every scale.
  FlatVectors::FlatVectors(const LinearSystem &system)
      : layout_(*system.layout)
      , n_u_(layout_.n_u)
      , scale_(3 * layout_.n_slave_nodes, 0.)
  {
    const DoFIndex n        = layout_.n_slave_nodes;
    std::size_t    position = 0;
    for (const DoFIndex k : layout_.owned[1])
    {
      scale_[k]             = system.multiplier_scale.at(position++);
      scale_[n + 2 * k]     = system.multiplier_scale.at(position++);
      scale_[n + 2 * k + 1] = system.multiplier_scale.at(position++);
    }
    dealii::Utilities::MPI::sum(scale_, layout_.communicator, scale_);
  }

  /// Calls @p f with the block, the index in it and the flat index of each owned unknown.
  template <typename Function>
  void FlatVectors::for_owned(const Function &f) const
  {
    const std::array<DoFIndex, 3> offset = {{0, n_u_, n_u_ + layout_.n_slave_nodes}};
    for (unsigned int block = 0; block < 3; ++block)
      for (const DoFIndex i : layout_.owned[block])
        f(block, i, offset[block] + i);
  }

  std::vector<double> FlatVectors::flatten(const BlockVector &v) const
  {
    std::vector<double> result(layout_.size(), 0.);
    for_owned([&](const unsigned int block, const DoFIndex i, const DoFIndex flat)
              { result[flat] = scale(flat) * v.block(block)(i); });
    dealii::Utilities::MPI::sum(result, layout_.communicator, result);
    return result;
  }

  void FlatVectors::unflatten(const std::vector<double> &x, BlockVector &v) const
  {
    layout_.reinit(v);
    for_owned([&](const unsigned int block, const DoFIndex i, const DoFIndex flat)
              { v.block(block)(i) = scale(flat) * x[flat]; });
    for (unsigned int block = 0; block < 3; ++block)
      v.block(block).compress(dealii::VectorOperation::insert);
  }
} // namespace Nodus
