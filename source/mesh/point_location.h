#ifndef nodus_mesh_point_location_h
#define nodus_mesh_point_location_h

#include "mesh/bodies.h"
#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <deal.II/fe/mapping.h>
#include <deal.II/grid/cell_id.h>

#include <optional>
#include <string>

namespace Nodus
{
  /// A cell that has a point in it, and where.
  struct PointInCell
  {
    unsigned int   body; ///< index
    dealii::CellId cell;
    Point          unit; ///< in the unit cell
  };

  /// How far outside of a cell, in parts of it, a point still is in it: round-off of its coordinates.
  constexpr double point_round_off = 1e-6;

  /// Place of @p X in the unit cell; none where X is not in the cell but for round-off.
  std::optional<Point>
  unit_point_in(const dealii::Mapping<dim> &mapping, const Bodies::Triangulation::cell_iterator &cell, const Point &X);
  /// Of @p X to @p cell; where the mapping has no inverse, to its nearest vertex.
  double
  distance_to(const dealii::Mapping<dim> &mapping, const Bodies::Triangulation::cell_iterator &cell, const Point &X);

  /// The cell of one of the bodies of @p region that has the reference point @p X in it, the same on every rank: of
  /// several, where X is between cells, that with the smallest CellId. @p label names the condition in messages.
  /// Collective. @throws InputError on every rank where X is in none of the bodies, or in more than one.
  PointInCell locate(const Bodies               &bodies,
                     const dealii::Mapping<dim> &mapping,
                     const RegionParameters     &region,
                     const Point                &X,
                     const std::string          &label);
} // namespace Nodus

#endif
