#ifndef nodus_rigid_triangle_patch_h
#define nodus_rigid_triangle_patch_h

#include "rigid/triangle_mesh.h"

#include <array>

namespace Nodus
{
  /// A point of a patch with its derivatives with respect to the barycentric coordinates of the corners 1 and 2.
  struct PatchPoint
  {
    Point                  x;
    std::array<Vector3, 2> d;  ///< first derivatives [length]
    std::array<Vector3, 3> dd; ///< second ones: 11, 12, 22 [length]

    /// Outward unit normal.
    Vector3 normal() const;
  };

  /// A triangle rounded to the normals at its corners, as quartic Gregory patch (Walton & Meek 1996): its edges are
  /// cubic curves, arcs of circles to sixth order in their angle, and across an edge the tangent planes of both patches
  /// are the same where their normals at its ends are (eqs. R5 to R8). A triangle whose normals are its own stays as it
  /// is.
  class TrianglePatch
  {
  public:
    static constexpr unsigned int n_points = 18;

    /// Of a triangle of a mesh.
    TrianglePatch(const TriangleMesh &mesh, unsigned int triangle);

    /// At barycentric coordinates 1 - s - t, s, t, which may be a little outside of the triangle.
    PatchPoint at(double s, double t) const;
    /// The edge from corner @p i to the next one at 0 <= r <= 1, with the first and second derivative.
    std::array<Vector3, 3> edge(unsigned int i, double r) const;

    /// The patch is inside of their convex hull: 12 of the edges, then two for each inner point.
    const std::array<Point, n_points> &points() const
    {
      return points_;
    }

  private:
    std::array<Point, n_points> points_;
  };
} // namespace Nodus

#endif
