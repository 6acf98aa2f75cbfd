#ifndef nodus_run_validation_h
#define nodus_run_validation_h

#include "output/console.h"
#include "run/load_stepping.h"
#include "run/model.h"

namespace Nodus
{
  /// What --validate says about a case: bodies, what each condition takes hold of, gaps of the first pairing, motions
  /// that nothing holds in the @p first increment, loops, load path. Collective. @throws InputError where the bodies
  /// overlap too much.
  void validate(Model &model, States &states, const Increment &first, Console &console);
} // namespace Nodus

#endif
