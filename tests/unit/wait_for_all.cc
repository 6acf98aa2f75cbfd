// No rank leaves before the last one has come, also when that is late by more than the waiting ranks sleep at a time.

#include "../cases.h"

#include "parallel/wait_for_all.h"

#include <deal.II/base/mpi.h>

#include <chrono>
#include <thread>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       rank = dealii::Utilities::MPI::this_mpi_process(world()),
                     n_ranks                    = dealii::Utilities::MPI::n_mpi_processes(world());
  for (unsigned int late = 0; late < n_ranks; ++late)
    for (const unsigned int milliseconds : {0, 1, 40})
    {
      if (rank == late)
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      // one clock for all ranks of a machine
      const double came = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
      Nodus::wait_for_all(world());
      const double left = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
      check("late by " + std::to_string(milliseconds) + " ms",
            dealii::Utilities::MPI::max(came, world()) <= dealii::Utilities::MPI::min(left, world()));
    }
}
