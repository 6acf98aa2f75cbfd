#ifndef nodus_solve_left_gmres_h
#define nodus_solve_left_gmres_h

#include "solve/saddle_point_operator.h"

#include <functional>

namespace Nodus
{
  struct KrylovReport
  {
    unsigned int iterations;
    double       residual; ///< |b - A x| / |b|
  };

  /// GMRES on A x = b from x = 0 until the residual b - A x and, where x is reached, the preconditioned residual have
  /// fallen by @p tolerance. Preconditioned from the left the residual measures displacements: in a slender body a
  /// small force hides a large one, and statuses are read from displacements. The caller compares the residual: it is
  /// larger than @p tolerance after @p maximum_iterations, or where round-off does not allow more, and not a number
  /// when the system is not finite. Collective.
  ///
  /// The basis is kept in single precision (Aliaga et al. 2022), which halves its memory, and each cycle reduces the
  /// residual by no more than such a basis can: the next one begins with that of x, in double precision. Two reductions
  /// an iteration, whatever the size of the basis: classical Gram-Schmidt, twice.
  ///
  /// @param preconditioner called as preconditioner(z, r): z = M^-1 r
  KrylovReport left_gmres(const SaddlePointOperator                                     &A,
                          const std::function<void(BlockVector &, const BlockVector &)> &preconditioner,
                          const BlockVector                                             &b,
                          double                                                         tolerance,
                          unsigned int                                                   maximum_iterations,
                          BlockVector                                                   &x);
} // namespace Nodus

#endif
