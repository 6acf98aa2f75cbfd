#include <nodus/base/signals.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <csignal>
#include <vector>

namespace Nodus
{
  namespace
  {
    volatile std::sig_atomic_t asked_for_checkpoint = 0, asked_to_end = 0;

    extern "C" void nodus_take_note(const int signal)
    {
      if (signal == SIGUSR1)
        asked_for_checkpoint = 1;
      else
        asked_to_end = signal;
    }
  } // namespace

  void Signals::install()
  {
    for (const int signal : {SIGUSR1, SIGTERM, SIGINT})
      std::signal(signal, nodus_take_note);
    std::signal(SIGXFSZ, SIG_IGN);
  }

  Signals::Request Signals::received(MPI_Comm communicator)
  {
    std::vector<int> flags = {asked_for_checkpoint, asked_to_end};
    asked_for_checkpoint   = 0;
    asked_to_end           = 0;
    dealii::Utilities::MPI::max(flags, communicator, flags);
    return {flags[0] > 0 || flags[1] > 0, flags[1]};
  }
} // namespace Nodus
