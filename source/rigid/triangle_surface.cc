#include "rigid/triangle_surface.h"
#include "rigid/stl_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int none = TriangleMesh::none;

    constexpr unsigned int most_iterations = 30;
    /// Change of barycentric coordinates at which an iteration ends: Newton's method leaves its square, and round-off
    /// in long triangles is more than that.
    constexpr double converged = 1e-10;
    /// A closest point this little outside of its triangle is in it: the patch beyond has it as well.
    constexpr double inside = 1e-10;
    /// A point that is this little beside the rim, in sizes of triangles, is not beyond it.
    constexpr double on_rim = 1e-9;
    /// Normals on both sides of an edge whose sine is below this are the same.
    constexpr double same_normal = 1e-6;
    /// Radius of sharp edges and corners, in lengths of the shortest edge there, that bounds how fast normals turn
    /// there.
    constexpr double edge_radius = 1e-2;

    Vector3 unit(const Vector3 &v)
    {
      return v / v.norm();
    }
    Vector3 across(const Vector3 &n)
    {
      Vector3 t;
      t[std::abs(n[0]) < 0.6 ? 0 : 1] = 1.;
      return unit(t - (t * n) * n);
    }

    /// Distance of a point from a triangle, and the barycentric coordinates s, t of the nearest point.
    double flat_distance(const Point &a, const Point &b, const Point &c, const Point &p, double &s, double &t)
    {
      const Vector3 e = b - a, f = c - a, d = p - a;
      const double  ee = e * e, ef = e * f, ff = f * f, de = d * e, df = d * f, det = ee * ff - ef * ef;
      s = (ff * de - ef * df) / det;
      t = (ee * df - ef * de) / det;
      if (s < 0. || t < 0. || s + t > 1.)
      {
        const double at_e = std::clamp(de / ee, 0., 1.), at_f = std::clamp(df / ff, 0., 1.),
                     at_g = std::clamp(((p - b) * (c - b)) / (c - b).norm_square(), 0., 1.);
        double best       = std::numeric_limits<double>::max();
        for (const auto &[u, v] : {std::make_pair(at_e, 0.), std::make_pair(0., at_f), std::make_pair(1. - at_g, at_g)})
          if (const double squared = (d - u * e - v * f).norm_square(); squared < best)
          {
            best = squared;
            s    = u;
            t    = v;
          }
      }
      return (d - s * e - t * f).norm();
    }

    /// Barycentric coordinates s, t at r of edge i.
    std::array<double, 2> on_edge(const unsigned int i, const double r)
    {
      return i == 0   ? std::array<double, 2>{{r, 0.}}
             : i == 1 ? std::array<double, 2>{{1. - r, r}}
                      : std::array<double, 2>{{0., 1. - r}};
    }
    /// The inverse of that.
    double along_edge(const unsigned int i, const double s, const double t)
    {
      return i == 0 ? s : i == 1 ? t : 1. - t;
    }

    /// Point of an edge nearest to @p p.
    double nearest_on_edge(const TrianglePatch &patch, const unsigned int i, const Point &p)
    {
      const Vector3 a = patch.edge(i, 0.)[0], chord = patch.edge(i, 1.)[0] - a;
      double        r = std::clamp((Vector3(p) - a) * chord / chord.norm_square(), 0., 1.);
      for (unsigned int iteration = 0; iteration < most_iterations; ++iteration)
      {
        const auto [x, d, dd] = patch.edge(i, r);
        const double slope = d.norm_square(), bent = slope + (x - Vector3(p)) * dd;
        const double next   = std::clamp(r - (x - Vector3(p)) * d / (bent > 0.1 * slope ? bent : slope), 0., 1.);
        const double change = std::abs(next - r);
        r                   = next;
        if (change < converged)
          break;
      }
      return r;
    }

    /// Principal curvatures, > 0 where the normal leaves a convex body, and their directions.
    void bend(const PatchPoint &x, RigidPoint &result)
    {
      const Vector3 &n = result.normal, e = unit(x.d[0]), f = dealii::cross_product_3d(n, e);
      const double   a = x.d[0] * e, b = x.d[1] * e, c = x.d[1] * f; // d_0 = a e, d_1 = b e + c f
      const double   L = -(x.dd[0] * n), M = -(x.dd[1] * n), N = -(x.dd[2] * n);
      const double   ee = L / (a * a), ef = (M - b / a * L) / (a * c);
      const double   ff   = (N - 2. * b / a * M + b * b / (a * a) * L) / (c * c);
      const double   mean = 0.5 * (ee + ff), radius = std::hypot(0.5 * (ee - ff), ef);
      const double   angle = radius > 0. ? 0.5 * std::atan2(ef, 0.5 * (ee - ff)) : 0.;
      result.curvature     = {{mean + radius, mean - radius}};
      result.direction     = {{std::cos(angle) * e + std::sin(angle) * f, std::cos(angle) * f - std::sin(angle) * e}};
    }

    /// Of a point whose patch is smooth around its closest point.
    RigidPoint smooth_point(const PatchPoint &x, const Point &p)
    {
      RigidPoint result;
      result.found  = true;
      result.x      = x.x;
      result.normal = x.normal();
      result.height = (p - x.x) * result.normal;
      bend(x, result);
      return result;
    }

    std::vector<TreeBox> boxes_of(const std::vector<TrianglePatch> &patches)
    {
      std::vector<TreeBox> result(patches.size());
      for (unsigned int t = 0; t < patches.size(); ++t)
        for (const Point &p : patches[t].points())
          result[t].add(p);
      return result;
    }

    std::vector<TrianglePatch> patches_of(const TriangleMesh &mesh)
    {
      std::vector<TrianglePatch> result;
      for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
        result.emplace_back(mesh, t);
      return result;
    }
  } // namespace

  std::shared_ptr<const TriangleSurface> TriangleSurface::of_file(const std::string &file, const Options &options)
  {
    static std::map<std::string, std::weak_ptr<const TriangleSurface>> in_use;

    std::error_code    unknown;
    std::ostringstream key;
    key.precision(17);
    key << file << ' ' << std::filesystem::last_write_time(file, unknown).time_since_epoch().count() << ' '
        << std::filesystem::file_size(file, unknown) << ' ' << options.origin << ' ' << options.scale << ' '
        << options.turned << options.smoothed;
    std::weak_ptr<const TriangleSurface> &known = in_use[key.str()];
    if (auto surface = known.lock())
      return surface;
    auto corners = read_stl(file);
    for (auto &triangle : corners)
    {
      for (Point &p : triangle)
        p = options.origin + options.scale * Vector3(p);
      if (options.turned)
        std::swap(triangle[1], triangle[2]);
    }
    const auto surface = std::make_shared<const TriangleSurface>(corners, options.smoothed, file);
    known              = surface;
    return surface;
  }

  TriangleSurface::TriangleSurface(const std::vector<std::array<Point, 3>> &corners,
                                   const bool                               smoothed,
                                   const std::string                       &name)
      : mesh_(corners, smoothed, name)
      , patches_(patches_of(mesh_))
      , tree_(boxes_of(patches_))
  {
    for (unsigned int t = 0; t < n_triangles(); ++t)
    {
      const Point a = mesh_.corner(t, 0), b = mesh_.corner(t, 1), c = mesh_.corner(t, 2);
      double      bulge = 0., u, v; // the distance from a triangle is convex: largest at the points around the patch
      for (const Point &p : patches_[t].points())
        bulge = std::max(bulge, flat_distance(a, b, c, p, u, v));
      bulge_.push_back(bulge);
      size_.push_back(std::sqrt(0.5 * dealii::cross_product_3d(b - a, c - a).norm()));
    }
  }

  std::string TriangleSurface::describe() const
  {
    const bool closed = mesh_.n_rim_edges() == 0;
    TreeBox    box;
    double     volume = 0.;
    for (const Point &p : mesh_.vertices())
      box.add(p);
    for (unsigned int t = 0; t < n_triangles(); ++t)
    {
      const Point &origin = mesh_.vertices()[0];
      volume += (mesh_.corner(t, 0) - origin) *
                dealii::cross_product_3d(mesh_.corner(t, 1) - origin, mesh_.corner(t, 2) - origin);
    }
    std::ostringstream text;
    text << (closed ? "closed" : "open") << " surface of " << n_triangles() << " triangles, ";
    text.precision(4);
    for (unsigned int c = 0; c < dim; ++c)
      text << (c > 0 ? " x " : "") << box.upper[c] - box.lower[c];
    text << (closed && volume < 0. ? " around a cavity" : "");
    return text.str();
  }

  RigidPoint TriangleSurface::closest(const Point &p) const
  {
    return point(nearest(p), p);
  }

  double TriangleSurface::height(const Point &p) const
  {
    const Nearest    at     = nearest(p);
    const RigidPoint result = point(at, p);
    return result.found && result.overhang == 0. ? result.height : std::sqrt(at.squared);
  }

  TriangleSurface::Nearest TriangleSurface::nearest(const Point &p) const
  {
    Nearest best;
    tree_.nearest(p,
                  best.squared,
                  [&](const unsigned int triangle, const double squared)
                  {
                    double       s, t;
                    const double least =
                        flat_distance(
                            mesh_.corner(triangle, 0), mesh_.corner(triangle, 1), mesh_.corner(triangle, 2), p, s, t) -
                        bulge_[triangle];
                    if (least > 0. && least * least >= squared)
                      return squared;
                    if (const Nearest found = nearest(triangle, p, s, t); found.squared < best.squared)
                      best = found;
                    return best.squared;
                  });
    return best;
  }

  TriangleSurface::Nearest
  TriangleSurface::nearest(const unsigned int triangle, const Point &p, const double s, const double t) const
  {
    const TrianglePatch &patch = patches_[triangle];
    Nearest              result{triangle, none, s, t, 0.};
    if (solve(triangle, p, 0.1, result.s, result.t) &&
        std::min({result.s, result.t, 1. - result.s - result.t}) >= -inside)
    {
      result.squared = (patch.at(result.s, result.t).x - p).norm_square();
      return result;
    }
    result.squared = std::numeric_limits<double>::max();
    for (unsigned int i = 0; i < 3; ++i)
    {
      const double r = nearest_on_edge(patch, i, p);
      if (const double squared = (patch.edge(i, r)[0] - Vector3(p)).norm_square(); squared < result.squared)
      {
        const auto [at_s, at_t] = on_edge(i, r);
        result                  = {triangle, i, at_s, at_t, squared};
      }
    }
    return result;
  }

  bool
  TriangleSurface::solve(const unsigned int triangle, const Point &p, const double margin, double &s, double &t) const
  {
    for (unsigned int iteration = 0; iteration < most_iterations; ++iteration)
    {
      const PatchPoint x    = patches_[triangle].at(s, t);
      const Vector3    r    = x.x - p;
      const double     g[2] = {r * x.d[0], r * x.d[1]};
      const double     a = x.d[0] * x.d[0], b = x.d[0] * x.d[1], c = x.d[1] * x.d[1];
      double           A = a + r * x.dd[0], B = b + r * x.dd[1], C = c + r * x.dd[2];
      const bool       convex = A > 0. && A * C - B * B > 1e-3 * (a * c - b * b);
      if (!convex) // Gauss-Newton's metric is safe
      {
        A = a;
        B = b;
        C = c;
      }
      const double det = A * C - B * B, step[2] = {(B * g[1] - C * g[0]) / det, (B * g[0] - A * g[1]) / det};
      double       part = 1.;
      for (const auto &[at, change] :
           {std::make_pair(s, step[0]), std::make_pair(t, step[1]), std::make_pair(1. - s - t, -step[0] - step[1])})
        if (at + change < -margin)
          part = std::min(part, (at + margin) / -change);
      s += part * step[0];
      t += part * step[1];
      if (part < 1e-3) // it is outside
        return false;
      if (std::abs(step[0]) + std::abs(step[1]) < converged * (1. + r.norm() / size_[triangle]))
        return convex;
    }
    return false;
  }

  RigidPoint TriangleSurface::point(const Nearest &at, const Point &p) const
  {
    const PatchPoint x = patches_[at.triangle].at(at.s, at.t);
    if (at.edge == none)
      return smooth_point(x, p);
    const TriangleMesh::Triangle &triangle = mesh_.triangles()[at.triangle];
    const double                  r        = along_edge(at.edge, at.s, at.t);
    if (r == 0. || r == 1.)
    {
      const unsigned int vertex = triangle.vertex[r == 0. ? at.edge : (at.edge + 1) % 3];
      if (mesh_.on_rim(vertex))
        return beyond_rim(at, x, p);
      return mesh_.is_smooth(vertex) ? smooth_point(x, p) : on_sharp_edge(at, x, mesh_.mean_normal(vertex), p);
    }
    if (triangle.neighbour[at.edge] == none)
      return beyond_rim(at, x, p);
    const unsigned int j = triangle.edge[at.edge];
    const auto [s, t]    = on_edge(j, 1. - r);
    const Vector3 one = x.normal(), other = patches_[triangle.neighbour[at.edge]].at(s, t).normal();
    if (dealii::cross_product_3d(one, other).norm() < same_normal && one * other > 0.)
      return smooth_point(x, p);
    const Vector3 sum = one + other;
    return on_sharp_edge(at, x, sum.norm() > same_normal ? unit(sum) : one, p);
  }

  RigidPoint TriangleSurface::beyond_rim(const Nearest &at, const PatchPoint &x, const Point &p) const
  {
    const Vector3 n = x.normal(), d = p - x.x;
    if ((d - (d * n) * n).norm() <= on_rim * size_[at.triangle])
      return smooth_point(x, p);
    double s = at.s, t = at.t;
    if (!solve(at.triangle, p, 1., s, t))
      return RigidPoint();
    RigidPoint result = smooth_point(patches_[at.triangle].at(s, t), p);
    result.overhang   = result.x.distance(x.x);
    return result;
  }

  /// As if the edge were round with a small radius: the mean normal of its sides counts more than the direction to the
  /// point where that is nearer (eq. R9).
  RigidPoint
  TriangleSurface::on_sharp_edge(const Nearest &at, const PatchPoint &x, const Vector3 &mean, const Point &p) const
  {
    const auto   &vertex = mesh_.triangles()[at.triangle].vertex;
    const double  r = along_edge(at.edge, at.s, at.t), side = (p - x.x) * mean < 0. ? -1. : 1.;
    const double  radius = edge_radius * ((1. - r) * mesh_.shortest_edge(vertex[at.edge]) +
                                         r * mesh_.shortest_edge(vertex[(at.edge + 1) % 3]));
    const Vector3 d = p - x.x, outward = side * d + radius * mean;
    RigidPoint    result;
    result.found     = true;
    result.x         = x.x;
    result.normal    = unit(outward);
    result.height    = d * result.normal;
    result.curvature = {{side / radius, side / radius}};
    result.stays     = {{true, true}};
    Vector3 e        = across(result.normal);
    if (r > 0. && r < 1.)
    {
      const auto [at_r, slope, second] = patches_[at.triangle].edge(at.edge, r);
      e                                = unit(slope - (slope * result.normal) * result.normal);
      result.curvature[0]              = -(second * result.normal) / slope.norm_square();
      result.stays[0]                  = false;
    }
    result.direction = {{e, dealii::cross_product_3d(result.normal, e)}};
    return result;
  }
} // namespace Nodus
