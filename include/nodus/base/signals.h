#ifndef nodus_base_signals_h
#define nodus_base_signals_h

#include <mpi.h>

#include <stdexcept>
#include <string>

namespace Nodus
{
  /// The run ends because it was told to. Thrown on every rank alike; exit code 128 + signal.
  class Interrupted : public std::runtime_error
  {
  public:
    Interrupted(const int signal, const std::string &message)
        : std::runtime_error(message)
        , signal(signal)
    {
    }
    const int signal;
  };

  /// Signals that ask a run for a checkpoint: SIGUSR1, and to end after it: SIGTERM and SIGINT.
  namespace Signals
  {
    /// Catches them from now on (after MPI and its libraries have set up their own handlers). Files that become too
    /// large (SIGXFSZ) end in an error of writing instead of the process.
    void install();

    struct Request
    {
      bool checkpoint = false;
      int  end        = 0; ///< the signal, 0: go on
    };
    /// What any rank was asked for since the last call. Collective.
    Request received(MPI_Comm communicator);
  } // namespace Signals
} // namespace Nodus

#endif
