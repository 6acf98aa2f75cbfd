#ifndef nodus_parallel_wait_for_all_h
#define nodus_parallel_wait_for_all_h

#include <mpi.h>

namespace Nodus
{
  /// A barrier in which ranks that come early sleep, to be used where few ranks have the work, those at the contact,
  /// before the exchange of what they have found. It is there for ranks that share cores with other work, where those
  /// that poll hardly get a turn; on idle cores it costs and saves no time (contrib/doc/scaling.md). Late by 0.1 ms or
  /// a sixteenth of the wait. Collective.
  void wait_for_all(MPI_Comm communicator);
} // namespace Nodus

#endif
