#ifndef nodus_solve_trilinos_open_multigrid_h
#define nodus_solve_trilinos_open_multigrid_h

#include "solve/trilinos/outside_multigrid.h"
#include <nodus/parameters/parameters.h>

#include <memory>

namespace Nodus
{
  /// Opens the shared library with the multigrid @p choice, which is none of nodus's own, where the linker finds it: in
  /// the folders that the program was linked with, and in LD_LIBRARY_PATH. @throws InputError that names what to
  /// install
  std::unique_ptr<OutsideMultigrid> open_multigrid(LinearSolverParameters::Preconditioner choice);
} // namespace Nodus

#endif
