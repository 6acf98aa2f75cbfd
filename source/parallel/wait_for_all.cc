#include "parallel/wait_for_all.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace Nodus
{
  void wait_for_all(const MPI_Comm communicator)
  {
    MPI_Request request;
    MPI_Ibarrier(communicator, &request);
    const auto begin = std::chrono::steady_clock::now();
    for (int all_here = 0; !all_here;)
    {
      MPI_Test(&request, &all_here, MPI_STATUS_IGNORE);
      // no sleep is shorter than some 0.05 ms, and each one costs some 0.01 ms of CPU
      const std::chrono::steady_clock::duration waited = std::chrono::steady_clock::now() - begin;
      if (!all_here && waited > std::chrono::microseconds(20))
        std::this_thread::sleep_for(
            std::max<std::chrono::steady_clock::duration>(std::chrono::microseconds(40), waited / 16));
    }
  }
} // namespace Nodus
