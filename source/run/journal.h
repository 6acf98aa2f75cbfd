#ifndef nodus_run_journal_h
#define nodus_run_journal_h

#include "base/profile.h"
#include "output/console.h"
#include "output/diagnosis/diagnosis.h"
#include "output/status_file.h"
#include "output/tables.h"
#include "output/verdict.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/base/mpi.h>

#include <memory>

namespace Nodus
{
  /// What a run says of itself while it runs: log, times, what a diagnosis would need, tables, counters.
  struct Journal
  {
    /// @p parameters outlive it.
    Journal(const Parameters &parameters, MPI_Comm communicator, std::ostream &log)
        : console(log, dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        , diagnosis(parameters, communicator)
    {
    }

    /// Notes that @p remedy is used.
    void count(const Remedy remedy)
    {
      ++counts.remedies[remedy];
      ++used[remedy];
    }

    Console                     console;
    Profile                     profile;
    Diagnosis                   diagnosis;
    std::unique_ptr<Tables>     tables;     ///< once the run has begun
    std::unique_ptr<StatusFile> status;     ///< the same, on the first rank
    IterationCounts             pass;       ///< numbers of the geometry, threshold and status pass at hand
    IterationCounts             counts;     ///< totals of the increment at hand
    Verdict                     verdict;    ///< on the state at hand
    Verdict                     verdicts;   ///< what came closest to its tolerance in the states of the run that hold
    unsigned int                judged = 0; ///< these
    PerRemedy<unsigned int>     used;       ///< in the whole run, in increments that failed, too
  };
} // namespace Nodus

#endif
