#include "solve/multigrid/corner_transfer.h"
#include "solve/multigrid/rigid_motions.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Nodus
{
  CornerTransfer::CornerTransfer(const ConstrainedMatrix   &A,
                                 const std::vector<double> &modes,
                                 const DisplacementNodes   &nodes)
      : Transfer(A.map())
  {
    const CellCorners &corners    = nodes.corners;
    Aggregates        &aggregates = P_.aggregates;
    const unsigned int rank       = dealii::Utilities::MPI::this_mpi_process(communicator_);
    aggregates.starts             = corners.pairs;
    aggregates.first              = corners.pairs[rank];
    aggregates.n_owned            = corners.pairs[rank + 1] - corners.pairs[rank];
    for (const DoFIndex corner : corners.corners)
      if (!aggregates.owned(corner / 2))
        aggregates.ghosts.push_back(corner / 2);
    std::sort(aggregates.ghosts.begin(), aggregates.ghosts.end());
    aggregates.ghosts.erase(std::unique(aggregates.ghosts.begin(), aggregates.ghosts.end()), aggregates.ghosts.end());

    const unsigned int n = dim * n_nodes_;
    P_.start.assign(1, 0);
    // more than enough: pages that are not touched take no memory, growing would take twice as much
    P_.column.reserve(corners.corners.size());
    P_.blocks.reserve(block_size * corners.corners.size() + 2);
    for (unsigned int i = 0; i < n_nodes_; ++i)
    {
      const std::uint32_t begin = corners.start[i], end = corners.start[i + 1], row = P_.column.size();
      for (std::uint32_t k = begin; k < end; ++k)
      {
        const unsigned int a = aggregates.local(corners.corners[k] / 2), slot = corners.corners[k] % 2;
        const auto         find = std::find(P_.column.begin() + row, P_.column.end(), a);
        const std::size_t  at   = block_size * (find - P_.column.begin());
        if (find == P_.column.end())
        {
          P_.column.push_back(a);
          P_.blocks.resize(P_.blocks.size() + block_size, 0.F);
        }
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int m = 0; m < dim; ++m) // what a translation is here
            P_.blocks[at + n_modes * c + dim * slot + m] = modes[m * n + dim * i + c] / (end - begin);
      }
      if (std::all_of(P_.blocks.begin() + block_size * row, P_.blocks.end(), [](const float x) { return x == 0.F; }))
      {
        P_.column.resize(row);
        P_.blocks.resize(block_size * row);
      }
      P_.start.push_back(P_.column.size());
    }
    P_.blocks.resize(P_.blocks.size() + 2, 0.F); // for load()

    const RigidMotions motions(nodes.positions, communicator_);
    const unsigned int n_coarse = n_modes * aggregates.n_owned;
    coarse_modes_.assign(std::max(1U, n_modes * n_coarse), 0.);
    for (unsigned int k = 0; k < corners.nodes.size(); ++k)
      motions.set(nodes.positions[corners.nodes[k]], coarse_modes_.data() + dim * k, n_coarse);
    prepare_exchange();
  }
} // namespace Nodus
