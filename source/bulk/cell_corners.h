#ifndef nodus_bulk_cell_corners_h
#define nodus_bulk_cell_corners_h

#include "solve/displacement_nodes.h"

#include <deal.II/dofs/dof_handler.h>

namespace Nodus
{
  /// Empty but for displacements of degree 2. A node that is a corner of one cell and between corners of a coarser one
  /// counts as a corner. Collective.
  CellCorners cell_corners(const dealii::DoFHandler<dim> &dof_handler);
} // namespace Nodus

#endif
