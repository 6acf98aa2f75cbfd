#include "contact/initial_overlap.h"
#include "base/text.h"
#include "contact/intrusion.h"
#include "contact/loci.h"
#include "contact/pairing.h"
#include "contact/surface.h"
#include "mesh/bodies.h"
#include "mesh/sides.h"
#include "parallel/largest.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi_remote_point_evaluation.h>

#include <algorithm>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Points this near the surface of a body, in cells, are on it.
    constexpr double on_surface = 1e-3;
    /// Sites that are this much deeper than another one, in limits, are no deeper: the first one is named.
    constexpr double round_off = 1e-9;

    double overlap_limit(const ContactPairParameters &pair, const ContactSurfaces &surfaces, const unsigned int p)
    {
      return pair.start.overclosure_limit > 0. ? pair.start.overclosure_limit : 0.5 * surfaces.face_size(p);
    }

    std::string overlap_at(const double t)
    {
      return "the bodies overlap at " + (t > 0. ? text("t = ", t, ", when the pair begins to act: ") : "the start: ");
    }

    std::string advice(const unsigned int pair)
    {
      return "; move the bodies apart, or raise 'Contact pair " + std::to_string(pair + 1) +
             "/Overclosure limit' if this is meant";
    }

    /// Which of the points are inside the bodies named beside them (indices), not on their surfaces. Collective.
    std::vector<char> are_inside(const std::vector<Point>        &points,
                                 const std::vector<unsigned int> &body,
                                 const Bodies                    &bodies,
                                 const dealii::Mapping<dim>      &mapping)
    {
      dealii::Utilities::MPI::RemotePointEvaluation<dim> places;
      places.reinit(points, bodies.triangulation(), mapping);
      std::vector<unsigned int> found, buffer; // bodies, by point and cell around it, from 1
      places.evaluate_and_process<unsigned int>(
          found,
          buffer,
          [&](const auto &values, const auto &data)
          {
            for (unsigned int i = 0; i < data.cells.size(); ++i)
            {
              const typename Bodies::Triangulation::active_cell_iterator cell(
                  &bodies.triangulation(), data.cells[i].first, data.cells[i].second);
              for (unsigned int q = data.reference_point_ptrs[i]; q < data.reference_point_ptrs[i + 1]; ++q)
              {
                const Point &at      = data.reference_point_values[q];
                bool         outside = false;
                for (unsigned int f = 0; f < 2 * dim; ++f)
                  outside = outside || (cell->face(f)->at_boundary() && std::abs(at[f / 2] - f % 2) < on_surface);
                values[q] = outside ? 0 : cell->material_id() + 1;
              }
            }
          });
      std::vector<char> inside(points.size(), false);
      const auto       &first = places.get_point_ptrs();
      for (unsigned int i = 0; i < points.size(); ++i)
        for (unsigned int q = first[i]; q < first[i + 1]; ++q)
          inside[i] = inside[i] || found[q] == body[i] + 1;
      return inside;
    }
  } // namespace

  void refuse_overlap(const std::vector<ContactPairParameters> &pairs,
                      const ContactSurfaces                    &surfaces,
                      const Pairing                            &pairing,
                      const std::vector<double>                &distance,
                      const double                              t)
  {
    std::vector<double>                    deepest(pairs.size(), 0.);
    std::vector<std::vector<unsigned int>> where(pairs.size());
    for (unsigned int s = 0; s < distance.size(); ++s)
    {
      const unsigned int p = surfaces.pair(s);
      if (surfaces.is_owned(s) && surfaces.has_status(s) && pairing[s].found && pairs[p].active_from == t &&
          distance[s] > deepest[p] + round_off * overlap_limit(pairs[p], surfaces, p))
      {
        deepest[p] = distance[s];
        where[p]   = {s};
      }
    }
    const MPI_Comm communicator = surfaces.layout().communicator;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      const double limit = overlap_limit(pairs[p], surfaces, p);
      const auto   worst = dealii::Utilities::MPI::min_max_avg(deepest[p], communicator);
      if (worst.max <= limit)
        continue;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) != worst.max_index)
        where[p].clear();
      std::ostringstream message;
      message << overlap_at(t) << loci(pairs, surfaces, where[p], 1).front() << " is " << worst.max
              << " inside the master, the limit is " << limit << advice(p);
      throw InputError(message.str());
    }
  }

  void refuse_hidden_overlap(const std::vector<ContactPairParameters> &pairs,
                             const ContactSurfaces                    &surfaces,
                             const Bodies                             &bodies,
                             const dealii::Mapping<dim>               &mapping,
                             const Vector                             &u,
                             const double                              t)
  {
    const auto opposite = [&](const unsigned int p, const SurfaceSide side) -> const std::vector<unsigned int> &
    { return (side == slave_side ? pairs[p].master : pairs[p].slave).bodies; };
    std::vector<double> limits;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      limits.push_back(overlap_limit(pairs[p], surfaces, p));
    std::vector<Vector3> moved;
    surfaces.gather(u, moved);
    const double          motion = largest_entry(u);
    std::vector<DeepNode> nodes  = find_deep_nodes(surfaces,
                                                  surfaces.positions(moved),
                                                  limits,
                                                  [&](const unsigned int p, const SurfaceSide side)
                                                  {
                                                    auto box = bodies.bounding_box(opposite(p, side).front() - 1);
                                                    for (const unsigned int body : opposite(p, side))
                                                      box.merge_with(bodies.bounding_box(body - 1));
                                                    box.extend(motion);
                                                    return box;
                                                  });
    nodes.erase(std::remove_if(nodes.begin(),
                               nodes.end(),
                               [&](const DeepNode &node) { return pairs[node.pair].active_from != t; }),
                nodes.end());
    const MPI_Comm communicator = surfaces.layout().communicator;
    if (dealii::Utilities::MPI::sum(static_cast<unsigned int>(nodes.size()), communicator) == 0)
      return;
    std::vector<Point>        points;
    std::vector<unsigned int> body, node_of_point;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (const unsigned int number : opposite(nodes[i].pair, nodes[i].side))
      {
        points.push_back(
            nodes[i].ahead); // where a cell of its own body would be found, too, no other one is looked for
        body.push_back(number - 1);
        node_of_point.push_back(i);
      }
    const std::vector<char> inside  = are_inside(points, body, bodies, mapping);
    double                  deepest = 0.;
    std::string             text;
    for (unsigned int i = 0; i < points.size(); ++i)
      if (const DeepNode &node = nodes[node_of_point[i]]; inside[i] && node.depth > deepest)
      {
        std::ostringstream message;
        deepest = node.depth;
        message << overlap_at(t) << (node.side == slave_side ? "slave" : "master") << " node " << coordinates(node.x)
                << " of " << pair_label(pairs, node.pair) << " is " << node.depth << " inside the "
                << (node.side == slave_side ? "master" : "slave") << ", the limit is " << limits[node.pair]
                << advice(node.pair);
        text = message.str();
      }
    const auto worst = dealii::Utilities::MPI::min_max_avg(deepest, communicator);
    if (worst.max > 0.)
      throw InputError(dealii::Utilities::MPI::broadcast(communicator, text, worst.max_index));
  }
} // namespace Nodus
