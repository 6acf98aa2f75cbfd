#ifndef nodus_parallel_all_gather_h
#define nodus_parallel_all_gather_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <limits>
#include <numeric>
#include <vector>

namespace Nodus
{
  /// The objects of all ranks, by rank, for any type that can be serialised. deal.II's function compresses them, which
  /// takes longer than to send them, and does so on one rank, too. Collective.
  /// @throws dealii::ExcMessage where all of them together are 2 GiB or more
  template <typename T>
  std::vector<T> all_gather(const MPI_Comm communicator, const T &object)
  {
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
    if (n_ranks == 1)
      return {object};
    const std::vector<char> own  = dealii::Utilities::pack(object, false);
    const double            size = own.size();
    std::vector<double>     all_sizes(n_ranks);
    MPI_Allgather(&size, 1, MPI_DOUBLE, all_sizes.data(), 1, MPI_DOUBLE, communicator);
    const double total = std::accumulate(all_sizes.begin(), all_sizes.end(), 0.);
    AssertThrow(total < std::numeric_limits<int>::max(),
                dealii::ExcMessage("More than 2 GiB cannot be gathered in one message."));
    const std::vector<int> sizes(all_sizes.begin(), all_sizes.end());
    std::vector<int>       starts(n_ranks, 0);
    std::partial_sum(sizes.begin(), sizes.end() - 1, starts.begin() + 1);
    std::vector<char> all(static_cast<std::size_t>(total));
    MPI_Allgatherv(own.data(),
                   sizes[dealii::Utilities::MPI::this_mpi_process(communicator)],
                   MPI_CHAR,
                   all.data(),
                   sizes.data(),
                   starts.data(),
                   MPI_CHAR,
                   communicator);
    std::vector<T> objects;
    objects.reserve(n_ranks);
    for (unsigned int rank = 0; rank < n_ranks; ++rank)
      objects.push_back(
          dealii::Utilities::unpack<T>(all.cbegin() + starts[rank], all.cbegin() + starts[rank] + sizes[rank], false));
    return objects;
  }
} // namespace Nodus

#endif
