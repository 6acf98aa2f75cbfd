#ifndef nodus_tests_restart_interrupted_h
#define nodus_tests_restart_interrupted_h

#include "../cases.h"

#include <nodus/base/signals.h>

#include <filesystem>

namespace Cases
{
  /// From the start or the last checkpoint to the end, or to where a signal has come.
  inline void run_until_interrupted(ContactProblem &problem, const bool restart)
  {
    if (restart)
      problem.restart();
    try
    {
      problem.run();
    }
    catch (const Interrupted &)
    {
    }
  }

  /// With results in a folder that is not there yet. Collective.
  inline Parameters in_new_folder(Parameters p, const std::string &folder)
  {
    p.output.results_folder = folder;
    if (root())
      std::filesystem::remove_all(folder);
    MPI_Barrier(MPI_COMM_WORLD);
    return p;
  }
} // namespace Cases

#endif
