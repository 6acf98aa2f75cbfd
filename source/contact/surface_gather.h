#ifndef nodus_contact_surface_gather_h
#define nodus_contact_surface_gather_h

#include "parallel/ghost_exchange.h"
#include <nodus/base/types.h>

#include <mpi.h>

#include <vector>

namespace Nodus
{
  /// Brings displacement-like vectors, three values for each node of the mesh, to the surface nodes of this rank, and
  /// what these have back to the vectors.
  class SurfaceGather
  {
  public:
    /// @p nodes: global numbers of the surface nodes, in any order, each once; @p n_owned_nodes of the mesh: those of
    /// each rank are numbered through. Collective.
    void reinit(const std::vector<DoFIndex> &nodes, unsigned int n_owned_nodes, MPI_Comm communicator);

    /// Values of a vector (fully distributed) at all surface nodes. Collective.
    void gather(const Vector &v, std::vector<Vector3> &nodal_values) const;
    /// Adds what all ranks have for their surface nodes to such a vector. Collective.
    void add(const std::vector<Vector3> &nodal_values, Vector &v) const;

  private:
    unsigned int                n_owned_ = 0; ///< nodes of the mesh
    std::vector<unsigned int>   place_;       ///< of each surface node: owned nodes of the mesh first, then ghosts
    GhostExchange               exchange_;
    mutable std::vector<double> ghost_values_;
  };
} // namespace Nodus

#endif
