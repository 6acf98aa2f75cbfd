#include "contact/intrusion.h"
#include "contact/master_request.h"
#include "contact/other_side.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <utility>

namespace Nodus
{
  namespace
  {
    using Box = dealii::BoundingBox<dim>;

    /// Nodes that touch begin their way this part of the tolerated depth outside, lest they begin behind.
    constexpr double lift = 0.1;
    /// Where a step would take nodes through the other surface they end this part of a face behind it.
    constexpr double landing_depth = 0.25;
    /// Parts of a way that are looked at, which is halved where it may dip into a rigid body.
    constexpr unsigned int most_parts = 10000, most_halves = 60;

    /// What is found of one pair.
    class Search
    {
    public:
      /// All outlive it.
      Search(const ContactSurfaces    &surfaces,
             const std::vector<Point> &before,
             const std::vector<Point> &now,
             const double              tolerated,
             const bool                self = false)
          : surfaces_(surfaces)
          , before_(before)
          , now_(now)
          , tolerated_(tolerated)
          , self_(self)
          , communicator_(surfaces.layout().communicator)
          , rank_(dealii::Utilities::MPI::this_mpi_process(communicator_))
      {
      }

      /// Both sides of a pair against each other. Collective.
      void find(const std::vector<SurfaceFace> &slaves, const std::vector<SurfaceFace> &masters)
      {
        const Triangles slave = triangles(slaves, now_), master = triangles(masters, now_);
        see_half_through(master);
        find(slave_side, slave, master, slaves, masters);
        if (!self_)
          find(master_side, master, slave, masters, slaves);
      }
      /// The same of a surface that touches itself: @p rigid are those of the master faces that are not slave.
      void find_self(const std::vector<SurfaceFace> &slaves,
                     const std::vector<SurfaceFace> &masters,
                     const std::vector<SurfaceFace> &rigid)
      {
        find(slaves, masters);
        find(master_side, triangles(rigid, now_), triangles(slaves, now_), rigid, slaves);
      }

      /// Nodes of @p side, which has the faces @p own, against the faces @p other. Collective.
      void find(const SurfaceSide               side,
                const Triangles                &mine,
                const Triangles                &theirs,
                const std::vector<SurfaceFace> &own,
                const std::vector<SurfaceFace> &other)
      {
        const OtherSide           faces(theirs, before_, now_, communicator_);
        std::vector<NodeQuestion> questions;
        for (const unsigned int n : mine.nodes())
          questions.push_back(question(faces, mine, n, tolerated_));
        std::vector<NodeAnswer>   answers = faces.answers(questions);
        std::vector<unsigned int> deep;
        for (unsigned int i = 0; i < answers.size(); ++i)
        {
          const unsigned int n     = mine.nodes()[i];
          const double       depth = answers[i].depth(mine.normal(n));
          note(n, side, depth > tolerated_ ? 0. : depth, answers[i].passed(tolerated_));
          if (depth > tolerated_)
            deep.push_back(i);
        }
        if (dealii::Utilities::MPI::max(static_cast<unsigned int>(deep.size()), communicator_) > 0)
          compare(side, triangles(own, before_), triangles(other, before_), mine.nodes(), questions, answers, deep);
      }

      /// Nodes of @p side in the box @p around that are deep. Collective.
      std::vector<DeepNode> deep_nodes(const unsigned int              pair,
                                       const SurfaceSide               side,
                                       const std::vector<SurfaceFace> &own,
                                       const std::vector<SurfaceFace> &other,
                                       const Box                      &around) const
      {
        const Triangles           mine = triangles(own, now_), theirs = triangles(other, now_);
        const OtherSide           faces(theirs, now_, now_, communicator_);
        const auto                ends  = around.get_boundary_points();
        const double              reach = ends.first.distance(ends.second);
        std::vector<NodeQuestion> questions;
        std::vector<unsigned int> nodes;
        for (const unsigned int n : mine.nodes())
          if (around.point_inside(now_[n]))
          {
            questions.push_back({now_[n], now_[n], reach});
            nodes.push_back(n);
          }
        std::vector<DeepNode>         found;
        const std::vector<NodeAnswer> answers = faces.answers(questions);
        for (unsigned int i = 0; i < nodes.size(); ++i)
          if (const double depth = answers[i].depth(mine.normal(nodes[i])); depth > tolerated_)
            found.push_back(
                {now_[nodes[i]], now_[nodes[i]] + lift * tolerated_ * mine.normal(nodes[i]), depth, pair, side});
        return found;
      }

      /// See visible_part(), of the nodes of the faces @p own, which end @p landing behind the others. On this rank,
      /// but collective.
      double
      part_before_passage(const std::vector<SurfaceFace> &own, const std::vector<SurfaceFace> &other, double landing)
      {
        const Triangles mine = triangles(own, now_), theirs = triangles(other, now_);
        see_half_through(theirs);
        landing = std::min(landing, 0.5 * tolerated_);
        const OtherSide           faces(theirs, before_, now_, communicator_);
        std::vector<NodeQuestion> questions;
        for (const unsigned int n : mine.nodes())
          questions.push_back(question(faces, mine, n, landing));
        double part = 1.;
        for (NodeAnswer &answer : faces.answers(questions))
          if (answer.passed(tolerated_))
            for (const Crossing &crossing : answer.crossings) // in ascending order by now
              if (crossing.inward)
              {
                part = std::min(part, crossing.time + landing / crossing.speed);
                break;
              }
        return part;
      }

      /// Slave nodes against a rigid master without faces. What moves relative to it does so in the frame that turns
      /// with it, and in the one that only moves with its point: a node that passes does so in both, one that a tool
      /// slides along or rolls over in one at most.
      void find(const std::vector<SurfaceFace> &own, RigidSurface &master, const double begin, const double end)
      {
        const Triangles     mine = triangles(own, now_);
        std::vector<double> were;
        master.set_increment(begin, begin);
        master.follow_carrier(before_);
        const Placement place = master.placement();
        const Point     point = master.point();
        for (const unsigned int n : mine.nodes())
          were.push_back(depth_in(master, before_[n], mine.normal(n)));
        master.set_increment(begin, end);
        master.follow_carrier(now_);
        for (unsigned int i = 0; i < were.size(); ++i)
        {
          const unsigned int n     = mine.nodes()[i];
          const double       depth = depth_in(master, now_[n], mine.normal(n));
          const bool         clear = depth <= tolerated_ && were[i] <= tolerated_;
          note(n,
               slave_side,
               depth > tolerated_ && were[i] > tolerated_ ? 0. : depth,
               clear && dips(master, master.placement().to(place.from(before_[n])), now_[n]) &&
                   dips(master, before_[n] + (master.point() - point), now_[n]));
        }
      }

      /// Of all ranks. Collective.
      Intrusion result() const
      {
        Intrusion result;
        for (const Intrusion &found : all_gather(communicator_, found_))
        {
          for (const SurfaceSide side : {slave_side, master_side})
            if (found.depth[side] > result.depth[side])
            {
              result.depth[side]   = found.depth[side];
              result.deepest[side] = found.deepest[side];
            }
          if (found.passed > 0 && result.passed == 0)
            result.first_passed = found.first_passed;
          result.passed += found.passed;
        }
        return result;
      }

    private:
      /// Behind its own surface nothing is seen beyond the middle of the thinnest wall. Collective.
      void see_half_through(const Triangles &surface)
      {
        if (self_)
          tolerated_ = std::min(tolerated_, dealii::Utilities::MPI::min(surface.least_visible(), communicator_));
      }

      /// What to ask about a node, which begins its way outside where it only touches, for what is @p lifted.
      NodeQuestion
      question(const OtherSide &faces, const Triangles &mine, const unsigned int n, const double lifted) const
      {
        NodeQuestion question = faces.question(before_[n] - lift * lifted * mine.normal(n), now_[n], tolerated_);
        question.own          = mine.own_node(n);
        return question;
      }

      Triangles triangles(const std::vector<SurfaceFace> &faces, const std::vector<Point> &x) const
      {
        return Triangles(faces, rank_, surfaces_.degree(), x, self_ ? &surfaces_.nodes() : nullptr);
      }

      /// Nodes that are deep count unless they were before: then the surfaces are made like that.
      void compare(const SurfaceSide                side,
                   const Triangles                 &mine,
                   const Triangles                 &theirs,
                   const std::vector<unsigned int> &nodes,
                   const std::vector<NodeQuestion> &questions,
                   const std::vector<NodeAnswer>   &answers,
                   const std::vector<unsigned int> &deep)
      {
        const OtherSide           faces(theirs, before_, before_, communicator_);
        std::vector<NodeQuestion> earlier;
        for (const unsigned int i : deep)
          earlier.push_back({before_[nodes[i]], before_[nodes[i]], questions[i].reach, questions[i].own});
        const std::vector<NodeAnswer> were = faces.answers(earlier);
        for (unsigned int j = 0; j < deep.size(); ++j)
        {
          const unsigned int n = nodes[deep[j]];
          if (were[j].depth(mine.normal(n)) <= tolerated_)
            note(n, side, answers[deep[j]].distance, false);
        }
      }

      double depth_in(const RigidSurface &master, const Point &x, const Vector3 &outward) const
      {
        const RigidPoint point = master.closest(x);
        return !point.found || point.normal * outward < NodeAnswer::far_side_cosine ? std::max(-master.height(x), 0.)
                                                                                    : 0.;
      }

      /// Whether the straight way between two points outside goes deeper into a rigid body than is tolerated. Heights
      /// change by no more than the way: a part whose ends are high enough for its length does not.
      bool dips(const RigidSurface &master, const Point &from, const Point &to) const
      {
        struct Part
        {
          double begin, end, height_begin, height_end;
        };
        const auto   height = [&](const double s) { return master.height(Point(from + s * (to - from))); };
        const double way    = from.distance(to);
        std::array<Part, most_halves> parts; // those yet to be looked at
        parts[0]       = {0., 1., height(0.), height(1.)};
        unsigned int n = 1;
        for (unsigned int i = 0; i < most_parts && n > 0; ++i)
        {
          const Part   part   = parts[--n];
          const double length = (part.end - part.begin) * way;
          if (0.5 * (part.height_begin + part.height_end - length) > -tolerated_ || length < 0.1 * tolerated_ ||
              n + 2 > most_halves)
            continue;
          const double middle = 0.5 * (part.begin + part.end), height_middle = height(middle);
          if (height_middle < -tolerated_)
            return true;
          parts[n++] = {middle, part.end, height_middle, part.height_end};
          parts[n++] = {part.begin, middle, part.height_begin, height_middle};
        }
        return false;
      }

      void note(const unsigned int node, const SurfaceSide side, const double depth, const bool passed)
      {
        if (depth > found_.depth[side])
        {
          found_.depth[side]   = depth;
          found_.deepest[side] = surfaces_.nodes()[node].X;
        }
        if (passed && found_.passed++ == 0)
          found_.first_passed = {surfaces_.nodes()[node].X, side};
      }

      const ContactSurfaces    &surfaces_;
      const std::vector<Point> &before_, &now_;
      double                    tolerated_;
      bool                      self_; ///< both sides are one surface
      MPI_Comm                  communicator_;
      unsigned int              rank_;
      Intrusion                 found_;
    };
  } // namespace

  std::vector<DeepNode>
  find_deep_nodes(const ContactSurfaces                                                    &surfaces,
                  const std::vector<Point>                                                 &x,
                  const std::vector<double>                                                &tolerated,
                  const std::function<dealii::BoundingBox<dim>(unsigned int, SurfaceSide)> &around)
  {
    std::vector<DeepNode> found;
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      if (surfaces.rigid_master(p) != nullptr || !surfaces.acts(p) || surfaces.touches_itself(p))
        continue;
      const Search search(surfaces, x, x, tolerated[p]);
      const auto  &slaves = surfaces.slave_faces(p), &masters = surfaces.master_faces(p);
      for (const SurfaceSide side : {slave_side, master_side})
        for (const DeepNode &node : search.deep_nodes(p,
                                                      side,
                                                      side == slave_side ? slaves : masters,
                                                      side == slave_side ? masters : slaves,
                                                      around(p, side)))
          found.push_back(node);
    }
    return found;
  }

  std::vector<Intrusion> find_intrusions(ContactSurfaces           &surfaces,
                                         const std::vector<Point>  &before,
                                         const std::vector<Point>  &now,
                                         const double               begin,
                                         const double               end,
                                         const std::vector<double> &tolerated)
  {
    std::vector<Intrusion> result;
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      Search search(surfaces, before, now, tolerated[p], surfaces.touches_itself(p));
      if (RigidSurface *const master = surfaces.rigid_master(p); !surfaces.acts(p))
        ;
      else if (master != nullptr)
        search.find(surfaces.slave_faces(p), *master, begin, end);
      else if (surfaces.touches_itself(p) && surfaces.n_faces(p, master_side) > surfaces.n_faces(p, slave_side))
        search.find_self(surfaces.slave_faces(p), surfaces.master_faces(p), surfaces.faces_that_are_master_alone(p));
      else
        search.find(surfaces.slave_faces(p), surfaces.master_faces(p));
      result.push_back(search.result());
    }
    return result;
  }

  double visible_part(const std::vector<ContactPairParameters> &pairs,
                      const ContactSurfaces                    &surfaces,
                      const std::vector<Point>                 &before,
                      const std::vector<Point>                 &now)
  {
    const std::vector<double> reach = search_reach(pairs, surfaces, before);
    double                    part  = 1.;
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      if (surfaces.rigid_master(p) != nullptr || !surfaces.acts(p))
        continue;
      Search       search(surfaces, before, now, 0.5 * reach[p], pairs[p].self_contact);
      const double landing = landing_depth * surfaces.face_size(p);
      const auto  &slaves = surfaces.slave_faces(p), &masters = surfaces.master_faces(p);
      part = std::min(part, search.part_before_passage(slaves, masters, landing));
      part = std::min(part,
                      pairs[p].self_contact
                          ? search.part_before_passage(surfaces.faces_that_are_master_alone(p), slaves, landing)
                          : search.part_before_passage(masters, slaves, landing));
    }
    return dealii::Utilities::MPI::min(part, surfaces.layout().communicator);
  }
} // namespace Nodus
