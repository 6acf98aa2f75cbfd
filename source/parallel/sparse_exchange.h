#ifndef nodus_parallel_sparse_exchange_h
#define nodus_parallel_sparse_exchange_h

#include "parallel/wait_for_all.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <map>

namespace Nodus
{
  /// What deal.II's function does: sends objects to the ranks that they stand under, and returns what came, by sender.
  /// Ranks that come here early sleep. Collective.
  template <typename T>
  std::map<unsigned int, T> sparse_exchange(const MPI_Comm communicator, const std::map<unsigned int, T> &objects)
  {
    wait_for_all(communicator);
    return dealii::Utilities::MPI::some_to_some(communicator, objects);
  }
} // namespace Nodus

#endif
