#ifndef nodus_mesh_memory_h
#define nodus_mesh_memory_h

#include <mpi.h>

namespace Nodus
{
  /// Refuses a mesh of @p n_cells cells with elements of @p degree whose solution would not fit into the memory of all
  /// machines that take part, at 2 kB for each displacement (contrib/doc/scaling.md has what was measured). To be asked
  /// before the mesh is made. Collective. @throws InputError on every rank.
  void refuse_beyond_memory(double n_cells, unsigned int degree, MPI_Comm communicator);
} // namespace Nodus

#endif
