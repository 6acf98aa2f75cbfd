#ifndef nodus_run_failure_report_h
#define nodus_run_failure_report_h

#include "run/equilibrium.h"
#include "run/results.h"

#include <string>

namespace Nodus
{
  /// What a failed increment is reported from, at the state that it failed in.
  struct FailedRun
  {
    Model        &model;
    Journal      &journal;
    States       &states;
    Equilibrium  &equilibrium;
    Results      &results;
    const Vector &softest_motion; ///< Strategy::softest_motion()
  };

  /// Records why the increment at hand failed: evidence for the diagnosis, and its fields. @p may_shrink: smaller
  /// increments might come further. @returns where to read more, for the message: a disk that does not take it must not
  /// hide why the run ends. Collective.
  std::string report_failure(const FailedRun &run, const SolverFailure &failure, bool may_shrink);
} // namespace Nodus

#endif
