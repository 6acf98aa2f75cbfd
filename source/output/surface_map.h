#ifndef nodus_output_surface_map_h
#define nodus_output_surface_map_h

#include "mesh/bodies.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>

#include <string>

namespace Nodus
{
  /// Writes all outer faces of the undeformed bodies to a VTU file at @p path, and what the case makes of them: body,
  /// boundary_id, and for each role that a face may have - side of a contact pair, boundary condition - values of cells
  /// that are 1 for its faces. Displacement conditions have those faces all of whose nodes they hold, and the nodes as
  /// values of points; body forces have those of their cells. Collective. @throws InputError where the file cannot be
  /// written.
  void write_surfaces(const std::string             &path,
                      const Parameters              &parameters,
                      const Bodies                  &bodies,
                      const dealii::DoFHandler<dim> &dof_handler,
                      const dealii::Mapping<dim>    &mapping);
} // namespace Nodus

#endif
