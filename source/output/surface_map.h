#ifndef nodus_output_surface_map_h
#define nodus_output_surface_map_h

#include "mesh/bodies.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>

#include <functional>
#include <optional>
#include <string>

namespace Nodus
{
  /// The point of the rigid master of a pair (the first is 0) that is closest to a position, if there is one.
  using RigidMasters = std::function<std::optional<Point>(unsigned int, const Point &)>;

  /// Writes all outer faces of the undeformed bodies to a VTU file at @p path, and what the case makes of them: body,
  /// boundary_id, and for each role that a face may have - side of a contact pair, boundary condition - values of cells
  /// that are 1 for its faces. Displacement conditions have those faces all of whose nodes they hold, and the nodes as
  /// values of points; body forces have those of their cells. Rigid masters that are no mesh have faces where they are
  /// closest to those of the slave; their body is the one that carries them or 0, their boundary_id -1. Collective.
  /// @throws InputError where the file cannot be written.
  void write_surfaces(const std::string             &path,
                      const Parameters              &parameters,
                      const Bodies                  &bodies,
                      const dealii::DoFHandler<dim> &dof_handler,
                      const dealii::Mapping<dim>    &mapping,
                      const RigidMasters            &rigid);
} // namespace Nodus

#endif
