#include "contact/initial_overlap.h"
#include "base/text.h"
#include "contact/intrusion.h"
#include "contact/loci.h"
#include "contact/other_side.h"
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

    /// The bodies (by number) that points are inside of, not those that they are on the surface of. Of several that
    /// overlap one is found. Collective.
    std::vector<std::vector<unsigned int>>
    bodies_at(const std::vector<Point> &points, const Bodies &bodies, const dealii::Mapping<dim> &mapping)
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
      std::vector<std::vector<unsigned int>> inside(points.size());
      const auto                            &first = places.get_point_ptrs();
      for (unsigned int i = 0; i < points.size(); ++i)
        for (unsigned int q = first[i]; q < first[i + 1]; ++q)
          if (found[q] > 0)
            inside[i].push_back(found[q]);
      return inside;
    }

    /// The deepest overlap that pairing does not see, and the sentence about it.
    struct HiddenOverlap
    {
      double      depth = 0.;
      std::string text;

      /// @throws InputError on every rank, if there is one on any. Collective.
      void refuse(const MPI_Comm communicator) const
      {
        const auto worst = dealii::Utilities::MPI::min_max_avg(depth, communicator);
        if (worst.max > 0.)
          throw InputError(dealii::Utilities::MPI::broadcast(communicator, text, worst.max_index));
      }
    };

    /// A surface that touches itself looks no farther behind than half of a wall (eq. O1). A node that does not see
    /// what it is in is in a cell of another body, or of its own one elsewhere, a little ahead of where it is.
    class SelfOverlap
    {
    public:
      /// All outlive it. @p x: positions of ContactSurfaces::nodes().
      SelfOverlap(const std::vector<ContactPairParameters> &pairs,
                  const unsigned int                        pair,
                  const ContactSurfaces                    &surfaces,
                  const std::vector<Point>                 &x)
          : pairs_(pairs)
          , pair_(pair)
          , surfaces_(surfaces)
          , x_(x)
          , limit_(overlap_limit(pairs[pair], surfaces, pair))
      {
      }

      /// Collective.
      void find(const Bodies &bodies, const dealii::Mapping<dim> &mapping, const double t, HiddenOverlap &deepest) const
      {
        const std::vector<Candidate> candidates = this->candidates();
        std::vector<Point>           points;
        for (const Candidate &candidate : candidates)
          points.push_back(candidate.ahead);
        const auto inside = bodies_at(points, bodies, mapping);
        for (const unsigned int body : pairs_[pair_].master.bodies)
        {
          std::vector<NodeQuestion> questions;
          std::vector<Candidate>    asked;
          for (unsigned int i = 0; i < candidates.size(); ++i)
            if (std::count(inside[i].begin(), inside[i].end(), body) > 0 && may_touch(candidates[i], body))
            {
              const auto ends = bodies.bounding_box(body - 1).get_boundary_points();
              questions.push_back(
                  {x_[candidates[i].node], x_[candidates[i].node], 2. * ends.first.distance(ends.second)});
              if (body == surfaces_.nodes()[candidates[i].node].body)
              {
                OwnNode &own = questions.back().own = candidates[i].own; // what is at the node does not count, ...
                own.least   = round_off * candidates[i].seen;            // ... but all else, however deep, ...
                own.outward = Vector3();                                 // ... whichever way it looks
              }
              asked.push_back(candidates[i]);
            }
          if (dealii::Utilities::MPI::max(unsigned(asked.size()), surfaces_.layout().communicator) == 0)
            continue;
          const std::vector<SurfaceFace> faces   = faces_of(body);
          const Triangles                surface = triangles(faces);
          const OtherSide                other(surface, x_, x_, surfaces_.layout().communicator);
          const std::vector<NodeAnswer>  answers = other.answers(questions);
          for (unsigned int i = 0; i < asked.size(); ++i)
            if (const double depth = answers[i].behind && answers[i].over ? answers[i].distance : 0.;
                depth > asked[i].seen && depth > deepest.depth)
              deepest = {depth, sentence(asked[i], depth, bodies.name(body - 1), t)};
        }
      }

    private:
      struct Candidate
      {
        unsigned int node;
        OwnNode      own;
        double       seen; ///< depth up to which it could be pressed out [length]
        Point        ahead;
      };

      /// Nodes that see nothing which they touch or are not too deep in. Collective.
      std::vector<Candidate> candidates() const
      {
        const Triangles           surface = triangles(surfaces_.master_faces(pair_));
        const OtherSide           other(surface, x_, x_, surfaces_.layout().communicator);
        std::vector<Candidate>    nodes, found;
        std::vector<NodeQuestion> questions;
        for (const unsigned int n : surface.nodes())
        {
          const OwnNode own  = surface.own_node(n);
          const double  seen = std::min(limit_, own.visible);
          nodes.push_back({n, own, seen, x_[n] + ahead * seen * own.outward});
          questions.push_back({x_[n], x_[n], own.visible, own});
        }
        const std::vector<NodeAnswer> answers = other.answers(questions);
        for (unsigned int i = 0; i < nodes.size(); ++i)
          if (answers[i].distance > (answers[i].behind ? limit_ : ahead * nodes[i].seen))
            found.push_back(nodes[i]);
        return found;
      }

      std::vector<SurfaceFace> faces_of(const unsigned int body) const
      {
        std::vector<SurfaceFace> faces;
        for (const SurfaceFace &face : surfaces_.master_faces(pair_))
          if (face.body == body)
            faces.push_back(face);
        return faces;
      }
      Triangles triangles(const std::vector<SurfaceFace> &faces) const // which outlive it
      {
        const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(surfaces_.layout().communicator);
        return Triangles(faces, rank, surfaces_.degree(), x_, &surfaces_.nodes());
      }

      /// Whether the pair has to do with where a node is in a body: one of both can give way, they are not excluded,
      /// and not left to another pair.
      bool may_touch(const Candidate &candidate, const unsigned int body) const
      {
        const ContactPairParameters &pair     = pairs_[pair_];
        const auto                   opposite = [&](const unsigned int side) -> std::vector<unsigned int>
        {
          if (side < 2 * pairs_.size())
            return (side % 2 == slave_side ? pairs_[side / 2].master : pairs_[side / 2].slave).bodies;
          const auto &[one, another] = pair.excluded_bodies[(side - 2 * pairs_.size()) / 2];
          return {side % 2 == 0 ? another : one};
        };
        const auto &elsewhere = candidate.own.elsewhere;
        return (pair.slave.has_body(body) || pair.slave.has_body(surfaces_.nodes()[candidate.node].body)) &&
               std::none_of(elsewhere.begin(),
                            elsewhere.end(),
                            [&](const unsigned int side)
                            {
                              const auto others = opposite(side);
                              return std::count(others.begin(), others.end(), body) > 0;
                            });
      }

      std::string
      sentence(const Candidate &candidate, const double depth, const std::string &body, const double t) const
      {
        std::ostringstream message;
        message << overlap_at(t) << "node " << coordinates(x_[candidate.node]) << " of " << pair_label(pairs_, pair_)
                << " is " << depth << " inside " << body << ", the limit is " << candidate.seen;
        if (candidate.seen < limit_)
          message << ", half of the wall there; move them apart, or give the two surfaces a pair of their own";
        else
          message << advice(pair_);
        return message.str();
      }

      /// Part of what a node sees that a point of the outside is before it: what only touches has that on its surface.
      static constexpr double ahead = 1e-4;

      const std::vector<ContactPairParameters> &pairs_;
      unsigned int                              pair_;
      const ContactSurfaces                    &surfaces_;
      const std::vector<Point>                 &x_;
      double                                    limit_;
    };
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
    const std::vector<Point> x = surfaces.positions(moved);
    HiddenOverlap            deepest;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      if (surfaces.touches_itself(p) && surfaces.acts(p) && pairs[p].active_from == t)
        SelfOverlap(pairs, p, surfaces, x).find(bodies, mapping, t, deepest);
    const double          motion = largest_entry(u);
    std::vector<DeepNode> nodes  = find_deep_nodes(surfaces,
                                                  x,
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
    if (dealii::Utilities::MPI::sum(static_cast<unsigned int>(nodes.size()), communicator) > 0)
    {
      std::vector<Point> points; // where a cell of its own body would be found, too, no other one is looked for
      for (const DeepNode &node : nodes)
        points.push_back(node.ahead);
      const auto inside = bodies_at(points, bodies, mapping);
      for (unsigned int i = 0; i < nodes.size(); ++i)
        for (const unsigned int body : opposite(nodes[i].pair, nodes[i].side))
          if (const DeepNode &node = nodes[i];
              std::count(inside[i].begin(), inside[i].end(), body) > 0 && node.depth > deepest.depth)
          {
            std::ostringstream message;
            message << overlap_at(t) << (node.side == slave_side ? "slave" : "master") << " node "
                    << coordinates(node.x) << " of " << pair_label(pairs, node.pair) << " is " << node.depth
                    << " inside the " << (node.side == slave_side ? "master" : "slave") << ", the limit is "
                    << limits[node.pair] << advice(node.pair);
            deepest = {node.depth, message.str()};
          }
    }
    deepest.refuse(communicator);
  }
} // namespace Nodus
