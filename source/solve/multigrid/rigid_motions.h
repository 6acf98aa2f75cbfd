#ifndef nodus_solve_multigrid_rigid_motions_h
#define nodus_solve_multigrid_rigid_motions_h

#include <nodus/base/types.h>

#include <mpi.h>

#include <vector>

namespace Nodus
{
  /// Rigid motions of all bodies together: three translations, and three rotations about the middle of the box around
  /// them that move its corners by about 1/2.
  class RigidMotions
  {
  public:
    /// @p positions of the owned nodes. Collective.
    RigidMotions(const std::vector<Point> &positions, MPI_Comm communicator);

    /// Mode m of a node at @p x goes to values[m * stride] and the two after it; what is zero is left as it is.
    void set(const Point &x, double *values, std::size_t stride) const;

  private:
    Vector3 centre_;
    double  length_;
  };
} // namespace Nodus

#endif
