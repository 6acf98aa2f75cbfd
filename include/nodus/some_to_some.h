#ifndef nodus_some_to_some_h
#define nodus_some_to_some_h

#include <nodus/wait_for_all.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <map>

namespace Nodus
{
  /// What deal.II's function does: sends objects to the ranks that they stand under, and returns what came, by sender.
  /// Ranks that come here early sleep. Collective.
  template <typename T>
  std::map<unsigned int, T> some_to_some(const MPI_Comm communicator, const std::map<unsigned int, T> &objects)
  {
    wait_for_all(communicator);
    return dealii::Utilities::MPI::some_to_some(communicator, objects);
  }
} // namespace Nodus

#endif
