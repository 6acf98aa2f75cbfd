#ifndef nodus_solve_multigrid_galerkin_product_h
#define nodus_solve_multigrid_galerkin_product_h

#include "solve/constrained_matrix.h"
#include "solve/multigrid/prolongation.h"

#include <memory>

namespace Nodus
{
  /// P^T A P, where @p A was made of @p K: two nodes of three unknowns for each aggregate (make_coarse_matrix()).
  /// Collective.
  std::unique_ptr<BlockCsrMatrix>
  galerkin_product(const BlockCsrMatrix &K, const ConstrainedMatrix &A, const Prolongation &P);
} // namespace Nodus

#endif
