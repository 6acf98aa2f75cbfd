#ifndef nodus_contact_triangles_h
#define nodus_contact_triangles_h

#include "contact/surface_face.h"

#include <deal.II/base/bounding_box.h>

#include <array>
#include <limits>
#include <memory>
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

  /// Of a point from a box, 0 inside.
  double squared_distance(const dealii::BoundingBox<dim> &box, const Point &p);

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

  /// Faces of a surface as triangles between their nodes, two for each face or for each quarter of one of degree 2:
  /// plain geometry that can judge what pairing, smoothing and averages make of the same faces.
  class Triangles
  {
  public:
    /// Of the faces of rank @p rank; those of others beside them tell where the rim is. @p x: positions of the nodes,
    /// which outlive it.
    Triangles(const std::vector<SurfaceFace> &faces,
              unsigned int                    rank,
              unsigned int                    degree,
              const std::vector<Point>       &x);
    ~Triangles();
    Triangles(Triangles &&) noexcept;

    /// The nodes of the faces of this rank, and a box around them.
    const std::vector<unsigned int> &nodes() const
    {
      return nodes_;
    }
    const dealii::BoundingBox<dim> &box() const
    {
      return box_;
    }
    /// Unit, outward, the mean of the faces around the node.
    const Vector3 &normal(const unsigned int node) const
    {
      return normals_[node];
    }

    /// Where @p p is; the distance is infinite where that is farther than @p reach.
    Height height(const Point &p, double reach) const;
    /// Crossings of every way with the triangles, which come from @p before; in no order, and twice where a way goes
    /// through an edge.
    std::vector<std::vector<Crossing>> crossings(const std::vector<Way> &ways, const std::vector<Point> &before) const;

  private:
    struct Triangle
    {
      std::array<unsigned int, 3> nodes; ///< counter-clockwise from outside
      std::array<bool, 3>         rim;   ///< whether the edge opposite to each is
    };
    struct Tree;
    Height height(const Triangle &triangle, const Point &p) const;

    const std::vector<Point> &x_;
    std::vector<Triangle>     triangles_;
    std::vector<unsigned int> nodes_;
    std::vector<Vector3>      normals_; ///< of all nodes, zero where there is no face
    std::vector<char>         on_rim_;  ///< likewise
    dealii::BoundingBox<dim>  box_;
    std::unique_ptr<Tree>     tree_;
  };
} // namespace Nodus

#endif
