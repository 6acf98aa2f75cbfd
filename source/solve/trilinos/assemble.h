#ifndef nodus_solve_trilinos_assemble_h
#define nodus_solve_trilinos_assemble_h

#include "solve/constrained_matrix.h"
#include "solve/trilinos/outside_multigrid.h"

namespace Nodus
{
  /// T^T K T + R^T D R + d, entry by entry. Rows and columns of prescribed displacements have their diagonal alone.
  /// Collective.
  AssembledMatrix assemble(const BlockCsrMatrix &K, const Constraints &constraints);
} // namespace Nodus

#endif
