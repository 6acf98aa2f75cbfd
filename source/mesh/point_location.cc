#include "mesh/point_location.h"
#include "base/deal_ii_versions.h"
#include "mesh/sides.h"
#include "parallel/all_gather.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <vector>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    using Cell = Bodies::Triangulation::cell_iterator;

    std::optional<Point> unit_point(const Mapping<dim> &mapping, const Cell &cell, const Point &X)
    {
      try
      {
        return mapping.transform_real_to_unit_cell(cell, X);
      }
      catch (const Mapping<dim>::ExcTransformationFailed &)
      {
        return {};
      }
    }

    /// Curved cells may bulge out of the box of their vertices.
    bool may_hold(const Cell &cell, const Point &X)
    {
      return cell->center().distance(X) < cell->diameter();
    }

    bool is_meant(const Bodies &bodies, const RegionParameters &region, const Cell &cell)
    {
      return region.has_body(cell->material_id() + 1) && bodies.has_mesh(cell->material_id());
    }

    /// Those of all ranks, of each body the one with the smallest CellId. Collective.
    std::vector<PointInCell>
    holders(const Bodies &bodies, const Mapping<dim> &mapping, const RegionParameters &region, const Point &X)
    {
      // body, CellId and unit coordinates as numbers, of which double has enough digits
      const std::size_t   n_words = CellId::binary_type().size(), n = 1 + n_words + dim;
      std::vector<double> own;
      for (const auto &cell : bodies.triangulation().active_cell_iterators())
        if (cell->is_locally_owned() && is_meant(bodies, region, cell))
          if (const auto unit = unit_point_in(mapping, cell, X))
          {
            own.push_back(cell->material_id());
            for (const unsigned int word : cell->id().to_binary<dim>())
              own.push_back(word);
            for (unsigned int c = 0; c < dim; ++c)
              own.push_back((*unit)[c]);
          }
      std::vector<PointInCell> found;
      for (const auto &numbers : all_gather(communicator_of(bodies.triangulation()), own))
        for (std::size_t i = 0; i < numbers.size(); i += n)
        {
          CellId::binary_type id;
          std::copy_n(numbers.begin() + i + 1, n_words, id.begin());
          Point unit;
          for (unsigned int c = 0; c < dim; ++c)
            unit[c] = numbers[i + 1 + n_words + c];
          found.push_back({static_cast<unsigned int>(numbers[i]), CellId(id), unit});
        }
      std::sort(found.begin(),
                found.end(),
                [](const PointInCell &a, const PointInCell &b)
                { return a.body != b.body ? a.body < b.body : a.cell < b.cell; });
      found.erase(std::unique(found.begin(),
                              found.end(),
                              [](const PointInCell &a, const PointInCell &b) { return a.body == b.body; }),
                  found.end());
      return found;
    }

    std::string body_text(const Bodies &bodies, const unsigned int body)
    {
      return "body " + std::to_string(body + 1) + in_brackets(bodies.name(body));
    }

    /// "the nearest vertex of its mesh is (0 0 1) of body 1 (block), at a distance of 0.5". Collective.
    std::string nearest_vertex(const Bodies &bodies, const RegionParameters &region, const Point &X)
    {
      std::vector<double> nearest; // distance, coordinates, body
      for (const auto &cell : bodies.triangulation().active_cell_iterators())
        if (cell->is_locally_owned() && is_meant(bodies, region, cell))
          for (const unsigned int v : cell->vertex_indices())
          {
            const Point              &vertex = cell->vertex(v);
            const std::vector<double> here   = {
                  vertex.distance(X), vertex[0], vertex[1], vertex[2], 1. * cell->material_id()};
            if (nearest.empty() || here < nearest)
              nearest = here;
          }
      for (const auto &of_rank : all_gather(communicator_of(bodies.triangulation()), nearest))
        if (!of_rank.empty() && (nearest.empty() || of_rank < nearest))
          nearest = of_rank;
      if (nearest.empty())
        return "none of them has a mesh";
      std::ostringstream text;
      text << "the nearest vertex is " << coordinates(Point(nearest[1], nearest[2], nearest[3])) << " of "
           << body_text(bodies, static_cast<unsigned int>(nearest[4])) << ", at a distance of " << nearest[0];
      return text.str();
    }
  } // namespace

  std::optional<Point> unit_point_in(const Mapping<dim> &mapping, const Cell &cell, const Point &X)
  {
    if (!may_hold(cell, X))
      return {};
    const auto unit = unit_point(mapping, cell, X);
    return unit && GeometryInfo<dim>::distance_to_unit_cell(*unit) < point_round_off ? unit : std::optional<Point>();
  }

  double distance_to(const Mapping<dim> &mapping, const Cell &cell, const Point &X)
  {
    double nearest = std::numeric_limits<double>::max();
    for (const unsigned int v : cell->vertex_indices())
      nearest = std::min(nearest, cell->vertex(v).distance(X));
    if (const auto p = unit_point(mapping, cell, X))
      nearest = std::min(
          nearest, mapping.transform_unit_to_real_cell(cell, GeometryInfo<dim>::project_to_unit_cell(*p)).distance(X));
    return nearest;
  }

  PointInCell locate(const Bodies           &bodies,
                     const Mapping<dim>     &mapping,
                     const RegionParameters &region,
                     const Point            &X,
                     const std::string      &label)
  {
    const std::vector<PointInCell> found = holders(bodies, mapping, region, X);
    if (found.size() == 1)
      return found.front();
    const std::string point = label + ": 'Point' = " + coordinates(X);
    if (found.empty())
      throw InputError(point + " is outside of " + (region.bodies.empty() ? "all bodies" : region.bodies_text()) +
                       "; " + nearest_vertex(bodies, region, X) +
                       "; give a point of a body, in the reference configuration and in the unit of its mesh");
    std::string text;
    for (const PointInCell &holder : found)
      text += (text.empty() ? " is in " : " and in ") + body_text(bodies, holder.body);
    throw InputError(point + text + ", which touch or overlap there; say with 'Body' which of them is meant");
  }
} // namespace Nodus
