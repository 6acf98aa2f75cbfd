#ifndef nodus_parallel_throw_everywhere_h
#define nodus_parallel_throw_everywhere_h

#include <deal.II/base/mpi.h>

#include <string>

namespace Nodus
{
  /// Throws Error(message, more...) on every rank when some rank has a message: that of the lowest such rank.
  /// Collective.
  template <typename Error, typename... More>
  void throw_everywhere(const std::string &message, const MPI_Comm &communicator, const More &...more)
  {
    const unsigned int n     = dealii::Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int mine  = message.empty() ? n : dealii::Utilities::MPI::this_mpi_process(communicator);
    const unsigned int first = dealii::Utilities::MPI::min(mine, communicator);
    if (first < n)
      throw Error(dealii::Utilities::MPI::broadcast(communicator, message, first), more...);
  }
} // namespace Nodus

#endif
