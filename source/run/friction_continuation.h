#ifndef nodus_run_friction_continuation_h
#define nodus_run_friction_continuation_h

#include "run/increment_loops.h"

namespace Nodus
{
  /// Comes to the friction of the increment from without (theory section 21.4): first all slides freely, which is close
  /// to where a body that is dragged ends up, then the limits grow. Newton starts each time from the solution before.
  /// @throws SolverFailure where the smallest growth fails; the friction limits are all in force again in any case.
  void continue_in_friction(Model &model, Journal &journal, States &states, IncrementLoops &loops);
} // namespace Nodus

#endif
