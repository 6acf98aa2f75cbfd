#ifndef nodus_mesh_sides_h
#define nodus_mesh_sides_h

#include "mesh/bodies.h"
#include "mesh/region.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>

#include <map>
#include <string>
#include <vector>

namespace Nodus
{
  /// The faces of a body that have one boundary id, in the reference configuration.
  struct Side
  {
    unsigned int n_faces = 0;
    double       area    = 0.;
    Vector3      normal;       ///< mean outward one, of length 1 where the side is flat, 0 where it is closed
    Point        lower, upper; ///< bounding box of its vertices

    /// "9 faces, area 1, from (0 0 1) to (1 1 1), normal (0 0 1)".
    std::string text() const;
  };

  /// Components that are small beside @p size are round-off: zero.
  Point without_round_off(Point p, double size);
  /// "(x y z)", and " (name)" or nothing without a name, for messages.
  std::string coordinates(const Point &X);
  std::string in_brackets(const std::string &name);

  /// By body and boundary id. Collective.
  std::vector<std::map<dealii::types::boundary_id, Side>>
  sides_of(const Bodies &bodies, const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping);

  /// Mean outward normal of the faces that the region selects, weighted with their areas: of length 1 where they are
  /// flat. Collective.
  Vector3
  mean_normal(const Region &region, const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping);

  /// Whether all vertices of the faces that the region selects lie on the rim of that surface, or there is none: it is
  /// one face wide. Collective.
  bool is_one_face_wide(const Region                  &region,
                        const dealii::DoFHandler<dim> &dof_handler,
                        const dealii::Mapping<dim>    &mapping);
} // namespace Nodus

#endif
