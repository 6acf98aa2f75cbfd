#ifndef nodus_solve_multigrid_corner_transfer_h
#define nodus_solve_multigrid_corner_transfer_h

#include "solve/displacement_nodes.h"
#include "solve/multigrid/transfer.h"

namespace Nodus
{
  /// From displacements of degree 2 to those of degree 1 on the same cells (eq. M5). A pair of corners has the place of
  /// an aggregate. Hanging and prescribed corners count like others: what they give to nodes that are neither stays.
  class CornerTransfer : public Transfer
  {
  public:
    /// @param modes as of rigid_body_modes(), in the unknowns of @p A, of which the translations tell what these are.
    /// Collective.
    CornerTransfer(const ConstrainedMatrix &A, const std::vector<double> &modes, const DisplacementNodes &nodes);
  };
} // namespace Nodus

#endif
