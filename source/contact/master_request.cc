#include "contact/master_request.h"
#include "parallel/all_gather.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace Nodus
{
  namespace
  {
    using Box = dealii::BoundingBox<dim>;

    /// A face this much against a slave face (cosine) is a partner for certain, whatever the normals at its nodes.
    constexpr double surely_facing = -0.5;
    /// ... and one this much along with it is none, also after some turning.
    constexpr double surely_averted = 0.7;
    /// Widening of the sweep of a slave face with the distance: normals differ over the face, and turn.
    constexpr double sweep_slope = 0.5;
    /// How far a surface looks for itself [mean faces].
    constexpr double self_reach = 2.;

    /// A slave face that looks for partners.
    struct Question
    {
      unsigned int pair;
      double       lower[dim], upper[dim], normal[dim];
      double       ball, sweep; ///< distances within which partners are wanted; negative: no sweep
      bool nearest; ///< no farther than the nearest one; where a surface touches itself that may be its own wall

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &pair &lower &upper &normal &ball &sweep &nearest;
      }
      Box box() const
      {
        return Box({Point(lower[0], lower[1], lower[2]), Point(upper[0], upper[1], upper[2])});
      }
    };
    using Questions = std::map<unsigned int, std::vector<Question>>;

    double smallest_distance(const Box &a, const Box &b)
    {
      double d2 = 0.;
      for (unsigned int c = 0; c < dim; ++c)
      {
        const double d = std::max({a.lower_bound(c) - b.upper_bound(c), 0., b.lower_bound(c) - a.upper_bound(c)});
        d2 += d * d;
      }
      return std::sqrt(d2);
    }

    double largest_distance(const Box &a, const Box &b)
    {
      double d2 = 0.;
      for (unsigned int c = 0; c < dim; ++c)
      {
        const double d = std::max(a.upper_bound(c) - b.lower_bound(c), b.upper_bound(c) - a.lower_bound(c));
        d2 += d * d;
      }
      return std::sqrt(d2);
    }

    double half_diagonal(const Box &box)
    {
      return 0.5 * box.get_boundary_points().first.distance(box.get_boundary_points().second);
    }

    Vector3 centre_normal(const SurfaceFace &face, const unsigned int degree, const std::vector<Point> &x)
    {
      const Vector3 area = face.orientation * FaceGeometry(face, FaceShape(degree, 0.5, 0.5), x).area_vector();
      return area / area.norm();
    }

    /// This rank's faces of the master surface of a pair.
    struct OwnMasters
    {
      using Leaf = std::pair<Box, unsigned int>;
      std::vector<Leaf>                                 leaves;
      std::vector<Vector3>                              normals; ///< of the leaves
      std::vector<unsigned int>                         faces;   ///< indices into master_faces
      decltype(dealii::pack_rtree(std::vector<Leaf>())) tree;

      OwnMasters(const std::vector<SurfaceFace> &master,
                 const unsigned int              rank,
                 const unsigned int              degree,
                 const std::vector<Point>       &x)
      {
        for (unsigned int f = 0; f < master.size(); ++f)
          if (master[f].owner == rank)
          {
            leaves.emplace_back(face_box(master[f], degree, x), faces.size());
            normals.push_back(centre_normal(master[f], degree, x));
            faces.push_back(f);
          }
        tree = dealii::pack_rtree(leaves);
      }

      /// Every point of the box has a facing face nearer than this.
      double nearest(const Question &question) const
      {
        namespace bgi   = boost::geometry::index;
        const Box box   = question.box();
        double    bound = question.ball;
        for (auto leaf = tree.qbegin(bgi::nearest(box, leaves.size() + 1)); leaf != tree.qend(); ++leaf)
        {
          if (smallest_distance(box, leaf->first) > bound)
            break;
          if (normals[leaf->second] * Vector3(question.normal) < surely_facing)
            bound = std::min(bound, largest_distance(box, leaf->first));
        }
        return bound;
      }

      void wanted(const Question &question, const double margin, std::set<unsigned int> &result) const
      {
        namespace bgi     = boost::geometry::index;
        const Box     box = question.box();
        const Vector3 n(question.normal);
        Box           range = box;
        range.extend(std::max(question.ball, (1. + sweep_slope) * question.sweep));
        for (auto leaf = tree.qbegin(bgi::intersects(range)); leaf != tree.qend(); ++leaf)
        {
          const Vector3 d      = leaf->first.center() - box.center();
          const double  radii  = half_diagonal(leaf->first) + half_diagonal(box);
          const double  height = std::abs(d * n);
          if (smallest_distance(box, leaf->first) <= question.ball ||
              (height <= question.sweep + radii && (d - (d * n) * n).norm() <= radii + margin + sweep_slope * height &&
               normals[leaf->second] * n < surely_averted))
            result.insert(faces[leaf->second]);
        }
      }
    };
  } // namespace

  Box face_box(const SurfaceFace &face, const unsigned int degree, const std::vector<Point> &x)
  {
    const FaceGeometry      centre(face, FaceShape(degree, 0.5, 0.5), x);
    std::pair<Point, Point> corners(centre.x, centre.x);
    for (const unsigned int n : face.nodes)
      for (unsigned int c = 0; c < dim; ++c)
      {
        corners.first[c]  = std::min(corners.first[c], x[n][c]);
        corners.second[c] = std::max(corners.second[c], x[n][c]);
      }
    Box box(corners);
    box.extend(std::sqrt(centre.area_vector().norm()) / 8);
    return box;
  }

  std::vector<double> search_reach(const std::vector<ContactPairParameters> &pairs,
                                   const ContactSurfaces                    &surfaces,
                                   const std::vector<Point>                 &x)
  {
    // minima of the lower and of minus the upper corners
    std::vector<double> corners(2 * dim * pairs.size(), std::numeric_limits<double>::max());
    for (unsigned int p = 0; p < pairs.size(); ++p)
      for (const SurfaceFace &face : surfaces.master_faces(p))
        for (const unsigned int n : face.nodes)
          for (unsigned int c = 0; c < dim; ++c)
          {
            double *const corner = corners.data() + 2 * dim * p + c;
            corner[0]            = std::min(corner[0], x[n][c]);
            corner[dim]          = std::min(corner[dim], -x[n][c]);
          }
    dealii::Utilities::MPI::min(corners, surfaces.layout().communicator, corners);
    std::vector<double> reach;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      Vector3 diagonal;
      for (unsigned int c = 0; c < dim; ++c)
        diagonal[c] = -corners[2 * dim * p + dim + c] - corners[2 * dim * p + c];
      const double automatic = surfaces.rigid_master(p) != nullptr ? std::numeric_limits<double>::max()
                               : pairs[p].self_contact             ? self_reach * surfaces.face_size(p)
                                                                   : 0.25 * diagonal.norm();
      reach.push_back(pairs[p].search_distance > 0. ? pairs[p].search_distance : automatic);
    }
    return reach;
  }

  namespace
  {
    /// Boxes around the master faces of each pair on each rank.
    class MasterBoxes
    {
    public:
      /// @p own: of each pair. Collective.
      MasterBoxes(const std::vector<OwnMasters> &own, const MPI_Comm communicator)
          : rank_(dealii::Utilities::MPI::this_mpi_process(communicator))
      {
        std::vector<double> boxes; // per pair: whether there are faces, corners
        for (const OwnMasters &masters : own)
        {
          Box all;
          if (!masters.leaves.empty())
            all = masters.leaves[0].first;
          for (const auto &leaf : masters.leaves)
            all.merge_with(leaf.first);
          boxes.push_back(masters.leaves.empty() ? 0. : 1.);
          for (unsigned int c = 0; c < dim; ++c)
            boxes.push_back(all.lower_bound(c));
          for (unsigned int c = 0; c < dim; ++c)
            boxes.push_back(all.upper_bound(c));
        }
        of_rank_ = all_gather(communicator, boxes);
      }

      unsigned int n_ranks() const
      {
        return of_rank_.size();
      }
      /// Whether another rank has master faces of the pair.
      bool others_have(const unsigned int pair) const
      {
        for (unsigned int r = 0; r < n_ranks(); ++r)
          if (r != rank_ && has_masters(r, pair))
            return true;
        return false;
      }
      /// Whether rank @p r is another one that may have partners within @p distance of the slave face.
      bool within(const unsigned int r, const Question &question, const double distance) const
      {
        const double *const b = of_rank_[r].data() + numbers * question.pair;
        return r != rank_ && has_masters(r, question.pair) &&
               smallest_distance(question.box(), Box({Point(b[1], b[2], b[3]), Point(b[4], b[5], b[6])})) <= distance;
      }

    private:
      static constexpr unsigned int numbers = 1 + 2 * dim; ///< per pair

      bool has_masters(const unsigned int r, const unsigned int pair) const
      {
        return of_rank_[r][numbers * pair] > 0.;
      }

      const unsigned int               rank_;
      std::vector<std::vector<double>> of_rank_;
    };

    /// What a slave face at @p x asks, about faces within @p reach.
    Question question_of(const SurfaceFace        &face,
                         const unsigned int        pair,
                         const ContactSurfaces    &surfaces,
                         const std::vector<Point> &x,
                         const double              reach)
    {
      Question question{};
      question.pair = pair;
      Box box       = face_box(face, surfaces.degree(), x);
      for (const unsigned int k : face.slaves) // nodes that hanging ones follow lie beyond the face
        box.merge_with(Box({x[surfaces.slave_nodes()[k].node], x[surfaces.slave_nodes()[k].node]}));
      const Vector3 n = centre_normal(face, surfaces.degree(), x);
      for (unsigned int c = 0; c < dim; ++c)
      {
        question.lower[c]  = box.lower_bound(c);
        question.upper[c]  = box.upper_bound(c);
        question.normal[c] = n[c];
      }
      question.ball = reach;
      return question;
    }

    /// Brings the balls of the questions down to how far the nearest facing master face of any rank is at most.
    /// Collective.
    void shrink_balls(std::vector<Question>         &mine,
                      const std::vector<OwnMasters> &own,
                      const MasterBoxes             &boxes,
                      const MPI_Comm                 communicator)
    {
      Questions                                         questions;
      std::map<unsigned int, std::vector<unsigned int>> asked;
      for (unsigned int r = 0; r < boxes.n_ranks(); ++r)
        for (unsigned int i = 0; i < mine.size(); ++i)
          if (mine[i].nearest && boxes.within(r, mine[i], mine[i].ball))
          {
            questions[r].push_back(mine[i]);
            asked[r].push_back(i);
          }
      std::map<unsigned int, std::vector<double>> answers;
      for (const auto &[other, list] : sparse_exchange(communicator, questions))
        for (const Question &question : list)
          answers[other].push_back(own[question.pair].nearest(question));
      for (const auto &[other, list] : sparse_exchange(communicator, answers))
        for (unsigned int i = 0; i < list.size(); ++i)
        {
          double &ball = mine[asked[other][i]].ball;
          ball         = std::min(ball, list[i]);
        }
    }
  } // namespace

  std::map<unsigned int, std::vector<std::vector<unsigned int>>>
  wanted_masters(const std::vector<ContactPairParameters> &pairs,
                 const ContactSurfaces                    &surfaces,
                 const std::vector<Point>                 &x,
                 const double                              moves)
  {
    const MPI_Comm            communicator = surfaces.layout().communicator;
    const unsigned int        rank         = dealii::Utilities::MPI::this_mpi_process(communicator);
    const std::vector<double> reach        = search_reach(pairs, surfaces, x);
    // Both sides move, the nearest face away and another one nearer; the automatic reach grows with the surface.
    const double margin = 5. * moves;

    std::vector<OwnMasters> own;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      own.emplace_back(surfaces.master_faces(p), rank, surfaces.degree(), x);
    const MasterBoxes boxes(own, communicator);

    std::vector<Question> mine; // of slave faces with sites of this rank
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (surfaces.rigid_master(p) != nullptr || !boxes.others_have(p))
        continue;
      const bool segments = pairs[p].scheme == ContactPairParameters::Scheme::averaged &&
                            pairs[p].integration == ContactPairParameters::Integration::segment;
      for (const SurfaceFace &face : surfaces.slave_faces(p))
        if (face.owner == rank || std::any_of(face.slaves.begin(),
                                              face.slaves.end(),
                                              [&](const unsigned int k) { return surfaces.is_owned(k); }))
        {
          Question question = question_of(face, p, surfaces, x, reach[p]);
          question.nearest  = !pairs[p].self_contact;
          if (question.nearest)
            question.ball = own[p].nearest(question);
          question.sweep = segments ? reach[p] + margin : -1.;
          mine.push_back(question);
        }
    }
    shrink_balls(mine, own, boxes, communicator);

    Questions questions;
    for (Question &question : mine)
      question.ball += margin;
    for (unsigned int r = 0; r < boxes.n_ranks(); ++r)
      for (const Question &question : mine)
        if (boxes.within(r, question, std::max(question.ball, (1. + sweep_slope) * question.sweep)))
          questions[r].push_back(question);
    std::map<unsigned int, std::vector<std::vector<unsigned int>>> result;
    for (const auto &[other, list] : sparse_exchange(communicator, questions))
    {
      std::vector<std::set<unsigned int>> wanted(pairs.size());
      for (const Question &question : list)
        own[question.pair].wanted(question, margin, wanted[question.pair]);
      for (const auto &faces : wanted)
        result[other].emplace_back(faces.begin(), faces.end());
    }
    return result;
  }
} // namespace Nodus
