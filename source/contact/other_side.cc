#include "contact/other_side.h"
#include "parallel/all_gather.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/utility.hpp>

#include <algorithm>
#include <map>

namespace Nodus
{
  namespace
  {
    using Box = dealii::BoundingBox<dim>;

    bool meet(const Box &a, const Box &b)
    {
      for (unsigned int c = 0; c < dim; ++c)
        if (a.lower_bound(c) > b.upper_bound(c) || b.lower_bound(c) > a.upper_bound(c))
          return false;
      return true;
    }
  } // namespace

  dealii::BoundingBox<dim> NodeQuestion::box() const
  {
    Box box({now, now});
    box.extend(reach);
    box.merge_with(Box({before, before}));
    return box;
  }

  void NodeAnswer::merge(const NodeAnswer &other)
  {
    crossings.insert(crossings.end(), other.crossings.begin(), other.crossings.end());
    if (other.distance >= distance)
      return;
    distance = other.distance;
    over     = other.over;
    behind   = other.behind;
    normal   = other.normal;
  }

  bool NodeAnswer::passed(const double tolerated)
  {
    std::sort(crossings.begin(), crossings.end(), [](const Crossing &a, const Crossing &b) { return a.time < b.time; });
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

  OtherSide::OtherSide(const Triangles          &own,
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
    TreeBox all = own.box();
    for (const unsigned int n : own.nodes())
    {
      before_[n] += motion_;
      moves_ = std::max(moves_, (now[n] - before_[n]).norm());
      all.add(before_[n]);
    }
    moves_ = dealii::Utilities::MPI::max(moves_, communicator);
    std::array<double, 2 * dim> corners{};
    for (unsigned int c = 0; c < dim; ++c)
    {
      corners[c]       = all.lower[c];
      corners[dim + c] = all.upper[c];
    }
    of_rank_ = all_gather(communicator, std::make_pair(own.nodes().empty() ? 0u : 1u, corners));
  }

  NodeQuestion OtherSide::question(const Point &before, const Point &now, const double depth) const
  {
    NodeQuestion question{before + motion_, now, depth};
    question.reach += moves_ + (now - question.before).norm();
    return question;
  }

  std::vector<NodeAnswer> OtherSide::answers(const std::vector<NodeQuestion> &questions) const
  {
    std::vector<NodeAnswer>                           merged = answer(questions);
    std::map<unsigned int, std::vector<NodeQuestion>> outgoing;
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
    std::map<unsigned int, std::vector<NodeAnswer>> back;
    for (const auto &[other, list] : sparse_exchange(communicator_, outgoing))
      back[other] = answer(list);
    for (const auto &[other, list] : sparse_exchange(communicator_, back))
      for (unsigned int i = 0; i < list.size(); ++i)
        merged[asked[other][i]].merge(list[i]);
    return merged;
  }

  std::vector<NodeAnswer> OtherSide::answer(const std::vector<NodeQuestion> &questions) const
  {
    std::vector<Way>     ways;
    std::vector<OwnNode> own;
    for (const NodeQuestion &question : questions)
    {
      ways.push_back({{question.before, question.now}});
      own.push_back(question.own);
    }
    std::vector<std::vector<Crossing>> crossings = own_.crossings(ways, before_, own);
    std::vector<NodeAnswer>            result;
    for (unsigned int i = 0; i < questions.size(); ++i)
    {
      const Height height = own_.height(questions[i].now, questions[i].reach, questions[i].own);
      result.push_back({height.distance, height.over, height.behind, height.normal, std::move(crossings[i])});
    }
    return result;
  }
} // namespace Nodus
