#ifndef nodus_run_check_laws_h
#define nodus_run_check_laws_h

#include <nodus/parameters/parameters.h>

#include <ostream>

namespace Nodus
{
  /// Compares every law of a case, shipped or one's own, with what follows from it: stresses with energies, tangents
  /// with differences. Prints the largest relative error of each comparison and where it was found.
  /// @returns whether all are within 1e-6. @throws InputError where a law cannot be made.
  bool check_laws(const Parameters &parameters, std::ostream &log);
} // namespace Nodus

#endif
