#ifndef nodus_contact_triangles_h
#define nodus_contact_triangles_h

#include "base/box_tree.h"
#include "contact/surface_face.h"

#include <array>
#include <limits>
#include <vector>

namespace Nodus
{
  /// Where a point is, seen from a surface.
  struct Height
  {
    double  distance = std::numeric_limits<double>::infinity(); ///< to the nearest point of the surface [length]
    bool    over     = false;                                   ///< which is none of its rim
    bool    behind   = false;                                   ///< on the inner side there
    Vector3 normal;                                             ///< outward there, unit
  };

  /// What a node of the surface itself is, which asks about the rest of it: faces at the node, those that do not
  /// look at it and those that are too far behind it do not count (eq. O1).
  struct OwnNode
  {
    std::vector<DoFIndex> nodes;   ///< first degrees of freedom of it and of those that it follows; empty: no such
    Vector3               outward; ///< unit; zero: faces count whichever way they look
    /// What the faces at it are in pairs that come before this one: what meets there does not count either.
    std::vector<unsigned int> elsewhere;
    /// Depth up to which faces that have come in count [length]; where @p least is given it looks for the wall behind
    /// itself instead, for faces that are farther behind it than that.
    double visible = 0., least = 0.;
    /// What is visible of the wall behind a face.
    static constexpr double visible_depth = 0.5;

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &nodes &outward &elsewhere &visible &least;
    }
  };

  using Way = std::array<Point, 2>; ///< from, to

  /// A point that moves evenly goes through a triangle whose corners do likewise.
  struct Crossing
  {
    double time;   ///< 0 to 1
    bool   inward; ///< from the side that (b - a) x (c - a) points to
    double speed;  ///< across the triangle, in the whole time [length]

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &time &inward &speed;
    }
  };
  /// In ascending order of their times, three at most (eq. V1).
  std::vector<Crossing> find_crossings(const Way &p, const Way &a, const Way &b, const Way &c);

  struct SurfaceNode;

  /// Faces of a surface as triangles between their nodes, two for each face or for each quarter of one of degree 2,
  /// from which heights are corrected for the curvature and the twist of the face: plain geometry that can judge what
  /// pairing, smoothing and averages make of the same faces.
  class Triangles
  {
  public:
    /// Of the faces of rank @p rank; those of others beside them tell where the rim is. @p x: positions of the nodes;
    /// both outlive it. @p nodes: where nodes of the surface itself may ask (OwnNode), or nullptr.
    Triangles(const std::vector<SurfaceFace> &faces,
              unsigned int                    rank,
              unsigned int                    degree,
              const std::vector<Point>       &x,
              const std::vector<SurfaceNode> *nodes = nullptr);

    /// The nodes of the faces of this rank, and a box around them.
    const std::vector<unsigned int> &nodes() const
    {
      return nodes_;
    }
    const TreeBox &box() const
    {
      return box_;
    }
    /// Unit, outward, the mean of the faces around the node.
    const Vector3 &normal(const unsigned int node) const
    {
      return normals_[node];
    }

    /// A node as one that asks about the surface that it is on.
    OwnNode own_node(unsigned int node) const;
    /// The least that OwnNode::visible is on this rank; infinite without nodes.
    double least_visible() const;

    /// Where @p p is, from the face behind the nearest triangle; the distance is infinite where that is farther than @p
    /// reach.
    Height height(const Point &p, double reach, const OwnNode &own) const;
    /// Crossings of every way with the triangles, which come from @p before; in no order, and twice where a way goes
    /// through an edge. @p own: of each way.
    std::vector<std::vector<Crossing>>
    crossings(const std::vector<Way> &ways, const std::vector<Point> &before, const std::vector<OwnNode> &own) const;

  private:
    struct Triangle
    {
      std::array<unsigned int, 3> nodes; ///< counter-clockwise from outside
      std::array<bool, 3>         rim;   ///< whether the edge opposite to each is
      const SurfaceFace          *face;
    };
    Height height(const Triangle &triangle, const Point &p) const;
    /// From a triangle to the face that it is of, which may be curved or twisted, along the normal at the point nearest
    /// to @p p.
    void follow_face(const Triangle &triangle, const Point &p, Height &height) const;
    void know_nodes(const std::vector<SurfaceFace> &faces, unsigned int degree, const std::vector<SurfaceNode> &nodes);
    bool is_at(const Triangle &triangle, const OwnNode &own) const;
    bool may_meet(const Triangle &triangle, const OwnNode &own) const;
    bool counts(const Triangle &triangle, const Height &height, const OwnNode &own) const;

    const std::vector<Point> &x_;
    std::vector<Triangle>     triangles_;
    std::vector<unsigned int> nodes_;
    std::vector<Vector3>      normals_; ///< of all nodes, zero where there is no face
    std::vector<char>         on_rim_;  ///< likewise
    std::vector<OwnNode>      own_;     ///< likewise; empty without nodes
    TreeBox                   box_;
    BoxTree                   tree_;
  };
} // namespace Nodus

#endif
