#include "solve/multigrid/rigid_motions.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

namespace Nodus
{
  RigidMotions::RigidMotions(const std::vector<Point> &positions, const MPI_Comm communicator)
  {
    std::vector<double> least(2 * dim, std::numeric_limits<double>::max()); // of the coordinates and their negatives
    for (const Point &p : positions)
      for (unsigned int d = 0; d < dim; ++d)
      {
        least[d]       = std::min(least[d], p[d]);
        least[dim + d] = std::min(least[dim + d], -p[d]);
      }
    dealii::Utilities::MPI::min(least, communicator, least);
    Vector3 extent;
    for (unsigned int d = 0; d < dim; ++d)
    {
      centre_[d] = .5 * (least[d] - least[dim + d]);
      extent[d]  = -least[dim + d] - least[d];
    }
    length_ = extent.norm();
  }

  void RigidMotions::set(const Point &position, double *const values, const std::size_t stride) const
  {
    const Vector3 x = (position - Point(centre_)) / length_;
    for (unsigned int c = 0; c < dim; ++c)
    {
      values[c * stride + c] = 1.;
      // rotation about axis a: e_a x x
      values[(3 + (c + 1) % 3) * stride + c] = x[(c + 2) % 3];
      values[(3 + (c + 2) % 3) * stride + c] = -x[(c + 1) % 3];
    }
  }
} // namespace Nodus
