#include "base/deal_ii_versions.h"
#include "contact/curvature_jump.h"
#include "contact/face_directory.h"
#include "parallel/sparse_exchange.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

// Averaged normals where the curvature jumps: owners of nodes tell the ranks that have faces there.

namespace Nodus
{
  namespace
  {
    using FaceKey = std::array<unsigned int, 3>; ///< pair, side, number

    FaceKey key(const FaceRecord &face)
    {
      return {{face.pair, face.side, face.number}};
    }

    /// What the owner of a corner of a face knows of it.
    struct Corner
    {
      FaceKey      face;
      unsigned int n;           ///< which of its corners
      double       normal[dim]; ///< averaged
      double       share;       ///< of the face in that; 0 where the owner has not told anything
      bool         inside;      ///< not on the rim of the surface

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &face &n &normal &share &inside;
      }
    };

    Vector3 normal(const Corner &corner)
    {
      return Vector3({corner.normal[0], corner.normal[1], corner.normal[2]});
    }

    Point corner(const FaceRecord &face, const unsigned int n)
    {
      return {face.X[n][0], face.X[n][1], face.X[n][2]};
    }

    Vector3 middle_normal(const FaceRecord &face)
    {
      const Vector3 area = face.orientation * dealii::cross_product_3d(corner(face, 3) - corner(face, 0),
                                                                       corner(face, 2) - corner(face, 1));
      return area / area.norm();
    }

    /// The face at its corner n; the normal that it sees there is not known yet.
    FaceAtNode face_at_node(const FaceRecord &face, const unsigned int n)
    {
      const Vector3 a = corner(face, n | 1) - corner(face, n & 2), b = corner(face, n | 2) - corner(face, n & 1);
      const Vector3 area = face.orientation * dealii::cross_product_3d(a, b);
      return {area / area.norm(), area.norm() / (a.norm_square() * b.norm_square()), Vector3(), 0., false};
    }

    /// What @p face sees at its corner n, from what is known of the corners.
    void see(const std::array<Corner, 4> &corners, const unsigned int n, const Vector3 &middle, FaceAtNode &face)
    {
      face.inside = corners[3 - n].inside;
      if (std::any_of(corners.begin(), corners.end(), [](const Corner &corner) { return corner.share == 0.; }))
        return;
      face.seen = 2. * middle +
                  0.5 * (normal(corners[n]) - normal(corners[n ^ 1]) - normal(corners[n ^ 2]) - normal(corners[3 - n]));
      face.turn = (face.seen - middle).norm();
    }

    /// Direction of the rim at a node, from one node beside it to the other; zero inside of the surface.
    /// @p beside: nodes beside it along the edges of its faces, and where they are.
    Vector3 rim_direction(const std::vector<std::pair<DoFIndex, Point>> &beside)
    {
      std::vector<Point> ends; // of edges with one face
      for (const auto &[dof, X] : beside)
        if (std::count_if(beside.begin(), beside.end(), [&, d = dof](const auto &other) { return other.first == d; }) ==
            1)
          ends.push_back(X);
      return ends.size() < 2 ? Vector3() : ends[1] - ends[0];
    }
  } // namespace

  std::vector<std::pair<unsigned int, unsigned int>> FaceDirectory::corners_at(const NodeKey &node) const
  {
    std::vector<std::pair<unsigned int, unsigned int>> corners;
    for (const unsigned int f : incident_.at(node))
      for (unsigned int n = 0; n < 4; ++n)
        if (at_own_nodes_[f].dofs[n][0] == node.second && !at_own_nodes_[f].hangs(n))
          corners.emplace_back(f, n);
    return corners;
  }

  void FaceDirectory::share_normals()
  {
    std::map<unsigned int, std::vector<Corner>> outgoing;
    std::map<NodeKey, std::vector<FaceAtNode>>  around;
    std::map<NodeKey, Vector3>                  rims;
    for (const auto &[node, faces] : incident_)
    {
      const auto                              corners = corners_at(node);
      std::vector<std::pair<DoFIndex, Point>> beside;
      for (const auto &[f, n] : corners)
      {
        const FaceRecord &face = at_own_nodes_[f];
        around[node].push_back(face_at_node(face, n));
        for (const unsigned int m : {n ^ 1, n ^ 2})
          beside.emplace_back(face.dofs[m][0], corner(face, m));
      }
      rims[node] = rim_direction(beside);
      for (unsigned int i = 0; i < corners.size(); ++i)
      {
        const Vector3 mean = averaged_normal(around[node], around[node][i].normal);
        for (const unsigned int r : holders(at_own_nodes_[corners[i].first]))
          outgoing[r].push_back({key(at_own_nodes_[corners[i].first]),
                                 corners[i].second,
                                 {mean[0], mean[1], mean[2]},
                                 1.,
                                 rims[node] == Vector3()});
      }
    }

    std::map<FaceKey, std::array<Corner, 4>> known;
    for (const auto &[rank, received] : sparse_exchange(communicator_of(dof_handler_), outgoing))
      for (const Corner &c : received)
        known[c.face][c.n] = c;
    outgoing.clear();
    for (auto &[node, faces] : around)
    {
      const auto corners = corners_at(node);
      for (unsigned int i = 0; i < corners.size(); ++i)
        see(known[key(at_own_nodes_[corners[i].first])],
            corners[i].second,
            middle_normal(at_own_nodes_[corners[i].first]),
            faces[i]);
      const std::vector<double> shares = normal_shares(faces, rims[node]);
      for (unsigned int i = 0; i < corners.size(); ++i)
        if (shares[i] != 1.)
          for (const unsigned int r : holders(at_own_nodes_[corners[i].first]))
            outgoing[r].push_back({key(at_own_nodes_[corners[i].first]), corners[i].second, {}, shares[i], false});
    }

    std::map<FaceKey, std::vector<FaceRecord *>> copies;
    for (auto &faces : own_)
      for (FaceRecord &face : faces)
        copies[key(face)].push_back(&face);
    for (FaceRecord &face : at_own_nodes_)
      copies[key(face)].push_back(&face);
    for (const auto &[rank, received] : sparse_exchange(communicator_of(dof_handler_), outgoing))
      for (const Corner &c : received)
        for (FaceRecord *const face : copies[c.face])
          face->normal_share[c.n] = c.share;
  }

  std::set<unsigned int> FaceDirectory::holders(const FaceRecord &face) const
  {
    std::set<unsigned int> ranks = {face.rank};
    for (const DoFIndex dof : support(face))
      ranks.insert(owner(dof));
    return ranks;
  }
} // namespace Nodus
