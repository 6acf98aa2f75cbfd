#include "contact/surface_gather.h"
#include "parallel/ownership.h"

#include <deal.II/lac/la_parallel_vector.h>

#include <algorithm>

namespace Nodus
{
  void SurfaceGather::reinit(const std::vector<DoFIndex> &nodes,
                             const unsigned int           n_owned_nodes,
                             const MPI_Comm               communicator)
  {
    const Ownership owned(n_owned_nodes, communicator);
    n_owned_                       = n_owned_nodes;
    const auto            is_owned = [&](const DoFIndex node) { return node >= owned.begin() && node < owned.end(); };
    std::vector<DoFIndex> ghosts;
    for (const DoFIndex node : nodes)
      if (!is_owned(node))
        ghosts.push_back(node);
    std::sort(ghosts.begin(), ghosts.end());
    place_.clear();
    for (const DoFIndex node : nodes)
      place_.push_back(is_owned(node)
                           ? node - owned.begin()
                           : n_owned_ + (std::lower_bound(ghosts.begin(), ghosts.end(), node) - ghosts.begin()));
    exchange_ = GhostExchange::numbered_through(owned.start(), ghosts, communicator);
    ghost_values_.resize(dim * ghosts.size());
  }

  void SurfaceGather::gather(const Vector &v, std::vector<Vector3> &nodal_values) const
  {
    const double *const owned = v.begin();
    exchange_.fetch(owned, ghost_values_.data(), dim);
    nodal_values.resize(place_.size());
    for (unsigned int i = 0; i < place_.size(); ++i)
    {
      const double *const values =
          place_[i] < n_owned_ ? owned + dim * place_[i] : ghost_values_.data() + dim * (place_[i] - n_owned_);
      std::copy_n(values, dim, &nodal_values[i][0]);
    }
  }

  void SurfaceGather::add(const std::vector<Vector3> &nodal_values, Vector &v) const
  {
    double *const owned = v.begin();
    for (unsigned int i = 0; i < place_.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        if (place_[i] < n_owned_)
          owned[dim * place_[i] + c] += nodal_values[i][c];
        else
          ghost_values_[dim * (place_[i] - n_owned_) + c] = nodal_values[i][c];
    exchange_.add(ghost_values_.data(), owned, dim);
  }
} // namespace Nodus
