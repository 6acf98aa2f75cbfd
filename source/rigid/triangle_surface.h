#ifndef nodus_rigid_triangle_surface_h
#define nodus_rigid_triangle_surface_h

#include "base/box_tree.h"
#include "rigid/rigid_surface.h"
#include "rigid/triangle_mesh.h"
#include "rigid/triangle_patch.h"

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// The surface of a rigid body made of triangles, each rounded to the normals at its corners (TrianglePatch). Closest
  /// points, normals and curvatures are those of the patches: over smooth edges the closest point and its normal are
  /// continuous. At edges that stay, the normal turns with the point that is nearest to them (eq. R9).
  class TriangleSurface
  {
  public:
    /// How a surface is made of a file.
    struct Options
    {
      Point  origin;           ///< where that of the file is
      double scale    = 1.;    ///< on its coordinates
      bool   turned   = false; ///< the other side is outside
      bool   smoothed = true;
    };
    /// Reads it, or shares what has been made of the same file in the same way and is still in use. @throws InputError
    static std::shared_ptr<const TriangleSurface> of_file(const std::string &file, const Options &options);

    /// @p corners: of triangles, counter-clockwise from outside; @p name: for messages. @throws InputError
    TriangleSurface(const std::vector<std::array<Point, 3>> &corners, bool smoothed, const std::string &name);

    /// Not found: a point that is farther beyond the rim than the triangle beside it is large.
    RigidPoint closest(const Point &p) const;
    /// Of a point above the surface, < 0 inside; its distance where the surface ends before it [length].
    double height(const Point &p) const;

    unsigned int n_triangles() const
    {
      return mesh_.triangles().size();
    }
    /// "closed surface of 12 triangles, 1 x 2 x 3 around a cavity": sizes along the axes [length].
    std::string describe() const;

  private:
    /// The closest point of a patch, at barycentric coordinates 1 - s - t, s, t.
    struct Nearest
    {
      unsigned int triangle = TriangleMesh::none;
      unsigned int edge     = TriangleMesh::none; ///< that it is on, or none
      double       s = 0., t = 0., squared = std::numeric_limits<double>::max();
    };
    Nearest nearest(const Point &p) const;
    /// Of the patch of a triangle; from @p s and @p t on.
    Nearest nearest(unsigned int triangle, const Point &p, double s, double t) const;
    /// Where @p p is straight above or below the patch, not farther outside of the triangle than the barycentric
    /// coordinate @p margin; whether there is such a point.
    bool       solve(unsigned int triangle, const Point &p, double margin, double &s, double &t) const;
    RigidPoint point(const Nearest &at, const Point &p) const;
    RigidPoint beyond_rim(const Nearest &at, const PatchPoint &x, const Point &p) const;
    RigidPoint on_sharp_edge(const Nearest &at, const PatchPoint &x, const Vector3 &mean, const Point &p) const;

    TriangleMesh               mesh_;
    std::vector<TrianglePatch> patches_;
    std::vector<double>        bulge_; ///< of a patch over its triangle, at most [length]
    std::vector<double>        size_;  ///< square root of the area [length]
    BoxTree                    tree_;
  };
} // namespace Nodus

#endif
