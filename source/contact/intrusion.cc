#include "contact/intrusion.h"
#include "contact/triangles.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace Nodus
{
  namespace
  {
    using Box = dealii::BoundingBox<dim>;

    /// A surface that looks the way of the node's own one (cosine above this) is the far side of a body.
    constexpr double far_side_cosine = 0.3;
    /// Nodes that touch begin their way this part of the tolerated depth outside, lest they begin behind.
    constexpr double lift = 0.1;

    bool meet(const Box &a, const Box &b)
    {
      for (unsigned int c = 0; c < dim; ++c)
        if (a.lower_bound(c) > b.upper_bound(c) || b.lower_bound(c) > a.upper_bound(c))
          return false;
      return true;
    }

    /// A node that asks where it is.
    struct Question
    {
      Point  before, now;
      double reach; ///< farther faces do not count [length]

      Box box() const
      {
        Box box({now, now});
        box.extend(reach);
        box.merge_with(Box({before, before}));
        return box;
      }
      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &before &now &reach;
      }
    };
    struct Answer
    {
      double                distance;
      bool                  over, behind;
      Vector3               normal;
      std::vector<Crossing> crossings;

      /// That of another rank about the same node.
      void merge(const Answer &other)
      {
        crossings.insert(crossings.end(), other.crossings.begin(), other.crossings.end());
        if (other.distance >= distance)
          return;
        distance = other.distance;
        over     = other.over;
        behind   = other.behind;
        normal   = other.normal;
      }
      /// How deep a node whose own surface has the normal @p outward is.
      double depth(const Vector3 &outward) const
      {
        return behind && over && normal * outward < far_side_cosine ? distance : 0.;
      }
      /// Whether the node has gone through the surface deeper than @p tolerated.
      bool passed(const double tolerated)
      {
        std::sort(
            crossings.begin(), crossings.end(), [](const Crossing &a, const Crossing &b) { return a.time < b.time; });
        bool            inside = false, deep = false;
        const Crossing *entry = nullptr;
        for (const Crossing &crossing : crossings)
        {
          if (crossing.inward && !inside)
            entry = &crossing;
          if (!crossing.inward && inside) // a curved way beside a curved surface is straight here, and grazes it
            deep = deep || (crossing.time - entry->time) * 0.5 * (entry->speed + crossing.speed) > tolerated;
          inside = crossing.inward;
        }
        // neither has a node that dips a little below the surface and leaves it over the rim
        return deep || (inside && distance > tolerated && (1. - entry->time) * entry->speed > tolerated);
      }
      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &distance &over &behind &normal &crossings;
      }
    };

    /// The faces of all ranks on one side of a pair, which answer questions about nodes of the other side.
    class OtherSide
    {
    public:
      /// @p own: the faces of this rank at the positions @p now. Collective.
      OtherSide(const Triangles          &own,
                const std::vector<Point> &before,
                const std::vector<Point> &now,
                const MPI_Comm            communicator)
          : own_(own)
          , before_(before)
          , communicator_(communicator)
          , rank_(dealii::Utilities::MPI::this_mpi_process(communicator))
      {
        // how the surface moves as a whole, which is no way through anything
        std::vector<double> sum(dim + 1, 0.);
        for (const unsigned int n : own.nodes())
        {
          sum[dim] += 1.;
          for (unsigned int c = 0; c < dim; ++c)
            sum[c] += now[n][c] - before[n][c];
        }
        dealii::Utilities::MPI::sum(sum, communicator, sum);
        for (unsigned int c = 0; c < dim; ++c)
          motion_[c] = sum[c] / sum[dim];
        Box all = own.box();
        for (const unsigned int n : own.nodes())
        {
          before_[n] += motion_;
          moves_ = std::max(moves_, (now[n] - before_[n]).norm());
          all.merge_with(Box({before_[n], before_[n]}));
        }
        moves_ = dealii::Utilities::MPI::max(moves_, communicator);
        std::array<double, 2 * dim> corners{};
        for (unsigned int c = 0; c < dim; ++c)
        {
          corners[c]       = all.lower_bound(c);
          corners[dim + c] = all.upper_bound(c);
        }
        of_rank_ =
            dealii::Utilities::MPI::all_gather(communicator, std::make_pair(own.nodes().empty() ? 0u : 1u, corners));
      }

      /// What to ask about a node. What was not deeper than @p depth can be no deeper now than the way of both
      /// surfaces.
      Question question(const Point &before, const Point &now, const double depth) const
      {
        Question question{before + motion_, now, depth};
        question.reach += moves_ + (now - question.before).norm();
        return question;
      }

      /// What all ranks know of each node. Collective.
      std::vector<Answer> answers(const std::vector<Question> &questions) const
      {
        std::vector<Answer>                               merged = answer(questions);
        std::map<unsigned int, std::vector<Question>>     outgoing;
        std::map<unsigned int, std::vector<unsigned int>> asked;
        for (unsigned int r = 0; r < of_rank_.size(); ++r)
        {
          const auto &[any, c] = of_rank_[r];
          if (r == rank_ || any == 0)
            continue;
          const Box box({Point(c[0], c[1], c[2]), Point(c[3], c[4], c[5])});
          for (unsigned int i = 0; i < questions.size(); ++i)
            if (meet(questions[i].box(), box))
            {
              outgoing[r].push_back(questions[i]);
              asked[r].push_back(i);
            }
        }
        if (of_rank_.size() == 1)
          return merged;
        std::map<unsigned int, std::vector<Answer>> back;
        for (const auto &[other, list] : sparse_exchange(communicator_, outgoing))
          back[other] = answer(list);
        for (const auto &[other, list] : sparse_exchange(communicator_, back))
          for (unsigned int i = 0; i < list.size(); ++i)
            merged[asked[other][i]].merge(list[i]);
        return merged;
      }

    private:
      std::vector<Answer> answer(const std::vector<Question> &questions) const
      {
        std::vector<Way> ways;
        for (const Question &question : questions)
          ways.push_back({{question.before, question.now}});
        std::vector<std::vector<Crossing>> crossings = own_.crossings(ways, before_);
        std::vector<Answer>                result;
        for (unsigned int i = 0; i < questions.size(); ++i)
        {
          const Height height = own_.height(questions[i].now, questions[i].reach);
          result.push_back({height.distance, height.over, height.behind, height.normal, std::move(crossings[i])});
        }
        return result;
      }

      const Triangles                                                  &own_;
      std::vector<Point>                                                before_; ///< moved as the surface moves
      MPI_Comm                                                          communicator_;
      unsigned int                                                      rank_;
      Vector3                                                           motion_;     ///< of the surface as a whole
      double                                                            moves_ = 0.; ///< largest besides that
      std::vector<std::pair<unsigned int, std::array<double, 2 * dim>>> of_rank_;    ///< whether it has faces, box
    };
    /// What is found of one pair.
    class Search
    {
    public:
      /// All outlive it.
      Search(const ContactSurfaces    &surfaces,
             const std::vector<Point> &before,
             const std::vector<Point> &now,
             const double              tolerated)
          : surfaces_(surfaces)
          , before_(before)
          , now_(now)
          , tolerated_(tolerated)
          , communicator_(surfaces.layout().communicator)
          , rank_(dealii::Utilities::MPI::this_mpi_process(communicator_))
      {
      }

      /// Nodes of @p side, which has the faces @p own, against the faces @p other. Collective.
      void find(const SurfaceSide side, const std::vector<SurfaceFace> &own, const std::vector<SurfaceFace> &other)
      {
        const Triangles       mine = triangles(own, now_), theirs = triangles(other, now_);
        const OtherSide       faces(theirs, before_, now_, communicator_);
        std::vector<Question> questions;
        for (const unsigned int n : mine.nodes())
          questions.push_back(faces.question(before_[n] - lift * tolerated_ * mine.normal(n), now_[n], tolerated_));
        std::vector<Answer>       answers = faces.answers(questions);
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
        std::vector<Question>     questions;
        std::vector<unsigned int> nodes;
        for (const unsigned int n : mine.nodes())
          if (around.point_inside(now_[n]))
          {
            questions.push_back({now_[n], now_[n], reach});
            nodes.push_back(n);
          }
        std::vector<DeepNode>     found;
        const std::vector<Answer> answers = faces.answers(questions);
        for (unsigned int i = 0; i < nodes.size(); ++i)
          if (const double depth = answers[i].depth(mine.normal(nodes[i])); depth > tolerated_)
            found.push_back(
                {now_[nodes[i]], now_[nodes[i]] + lift * tolerated_ * mine.normal(nodes[i]), depth, pair, side});
        return found;
      }

      /// See part_before_passage(), of nodes of @p side. On this rank, but collective.
      double part_before_passage(const std::vector<SurfaceFace> &own,
                                 const std::vector<SurfaceFace> &other,
                                 const double                    landing) const
      {
        const Triangles       mine = triangles(own, now_), theirs = triangles(other, now_);
        const OtherSide       faces(theirs, before_, now_, communicator_);
        std::vector<Question> questions;
        for (const unsigned int n : mine.nodes())
          questions.push_back(faces.question(before_[n] - lift * landing * mine.normal(n), now_[n], tolerated_));
        double part = 1.;
        for (Answer &answer : faces.answers(questions))
          if (answer.passed(tolerated_))
            for (const Crossing &crossing : answer.crossings) // in ascending order by now
              if (crossing.inward)
              {
                part = std::min(part, crossing.time + landing / crossing.speed);
                break;
              }
        return part;
      }

      /// Slave nodes against a rigid master in closed form.
      void find(const std::vector<SurfaceFace> &own, RigidSurface &master, const double begin, const double end)
      {
        const Triangles     mine = triangles(own, now_);
        std::vector<double> were;
        master.set_increment(begin, begin);
        master.follow_carrier(before_);
        for (const unsigned int n : mine.nodes())
          were.push_back(depth_in(master, before_[n], mine.normal(n)));
        master.set_increment(begin, end);
        master.follow_carrier(now_);
        for (unsigned int i = 0; i < were.size(); ++i)
        {
          const unsigned int n     = mine.nodes()[i];
          const double       depth = depth_in(master, now_[n], mine.normal(n));
          note(n, slave_side, depth > tolerated_ && were[i] > tolerated_ ? 0. : depth, false);
        }
      }

      /// Of all ranks. Collective.
      Intrusion result() const
      {
        const auto node = [](const Intrusion::Node &n) {
          return std::array<double, dim + 1>{{n.X[0], n.X[1], n.X[2], n.side == slave_side ? 0. : 1.}};
        };
        const auto take = [](const std::array<double, dim + 1> &n) {
          return Intrusion::Node{Point(n[0], n[1], n[2]), n[dim] == 0. ? slave_side : master_side};
        };
        const auto all = dealii::Utilities::MPI::all_gather(
            communicator_,
            std::make_pair(std::make_pair(found_.depth, node(found_.deepest)),
                           std::make_pair(found_.passed, node(found_.first_passed))));
        Intrusion result;
        for (const auto &[deepest, passed] : all)
        {
          if (deepest.first > result.depth)
          {
            result.depth   = deepest.first;
            result.deepest = take(deepest.second);
          }
          if (passed.first > 0 && result.passed == 0)
            result.first_passed = take(passed.second);
          result.passed += passed.first;
        }
        return result;
      }

    private:
      Triangles triangles(const std::vector<SurfaceFace> &faces, const std::vector<Point> &x) const
      {
        return Triangles(faces, rank_, surfaces_.degree(), x);
      }

      /// Nodes that are deep count unless they were before: then the surfaces are made like that.
      void compare(const SurfaceSide                side,
                   const Triangles                 &mine,
                   const Triangles                 &theirs,
                   const std::vector<unsigned int> &nodes,
                   const std::vector<Question>     &questions,
                   const std::vector<Answer>       &answers,
                   const std::vector<unsigned int> &deep)
      {
        const OtherSide       faces(theirs, before_, before_, communicator_);
        std::vector<Question> earlier;
        for (const unsigned int i : deep)
          earlier.push_back({before_[nodes[i]], before_[nodes[i]], questions[i].reach});
        const std::vector<Answer> were = faces.answers(earlier);
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
        return point.found && point.normal * outward < far_side_cosine ? std::max(-point.height, 0.) : 0.;
      }

      void note(const unsigned int node, const SurfaceSide side, const double depth, const bool passed)
      {
        if (depth > found_.depth)
        {
          found_.depth   = depth;
          found_.deepest = {surfaces_.nodes()[node].X, side};
        }
        if (passed && found_.passed++ == 0)
          found_.first_passed = {surfaces_.nodes()[node].X, side};
      }

      const ContactSurfaces    &surfaces_;
      const std::vector<Point> &before_, &now_;
      double                    tolerated_;
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
      if (surfaces.rigid_master(p) != nullptr)
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
      Search search(surfaces, before, now, tolerated[p]);
      if (RigidSurface *const master = surfaces.rigid_master(p))
        search.find(surfaces.slave_faces(p), *master, begin, end);
      else
      {
        search.find(slave_side, surfaces.slave_faces(p), surfaces.master_faces(p));
        search.find(master_side, surfaces.master_faces(p), surfaces.slave_faces(p));
      }
      result.push_back(search.result());
    }
    return result;
  }

  double part_before_passage(const ContactSurfaces     &surfaces,
                             const std::vector<Point>  &before,
                             const std::vector<Point>  &now,
                             const std::vector<double> &tolerated,
                             const std::vector<double> &landing)
  {
    double part = 1.;
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      if (surfaces.rigid_master(p) != nullptr)
        continue;
      const Search search(surfaces, before, now, tolerated[p]);
      const auto  &slaves = surfaces.slave_faces(p), &masters = surfaces.master_faces(p);
      part = std::min({part,
                       search.part_before_passage(slaves, masters, landing[p]),
                       search.part_before_passage(masters, slaves, landing[p])});
    }
    return dealii::Utilities::MPI::min(part, surfaces.layout().communicator);
  }
} // namespace Nodus
