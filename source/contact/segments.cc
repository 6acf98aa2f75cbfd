#include "contact/segments.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Nodus
{
  namespace
  {
    using Point2 = dealii::Point<2>;

    /// Overlaps below this fraction of a slave cell are round-off.
    constexpr double smallest_overlap = 1e-10;

    double cross(const dealii::Tensor<1, 2> &a, const dealii::Tensor<1, 2> &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }

    /// A convex polygon; two quadrilaterals overlap in at most eight corners.
    struct Polygon
    {
      using Corner = SegmentTrace::Corner;

      std::array<Point2, 16>        corner;
      std::array<Corner, 16>        origin;
      std::array<unsigned char, 16> line; ///< that the edge to the next corner lies on: of the master, slave_line +
                                          ///< that of the slave
      unsigned int n = 0;

      void add(const Point2 &p, const Corner &what, const unsigned char along)
      {
        corner[n] = p;
        origin[n] = what;
        line[n++] = along;
      }
      double area() const
      {
        double twice = 0.;
        for (unsigned int i = 2; i < n; ++i)
          twice += cross(corner[i - 1] - corner[0], corner[i] - corner[0]);
        return 0.5 * twice;
      }
      /// Triangles fan out from corner 0. What rules of integration leave depends on which it is: it is to stay the
      /// same where a corner splits in two, or the integrals would jump. The farthest one in a direction that edges
      /// hardly ever lie across does.
      void begin_at_extreme()
      {
        const auto   along = [](const Point2 &p) { return 0.854 * p[0] + 0.520 * p[1]; };
        unsigned int first = 0;
        for (unsigned int i = 1; i < n; ++i)
          if (along(corner[i]) > along(corner[first]))
            first = i;
        if (first == 0)
          return;
        const Polygon before = *this;
        for (unsigned int i = 0; i < n; ++i, ++first)
        {
          if (first == n)
            first = 0;
          corner[i] = before.corner[first];
          origin[i] = before.origin[first];
          line[i]   = before.line[first];
        }
      }
      void make_counterclockwise()
      {
        if (area() >= 0.)
          return;
        std::reverse(corner.begin(), corner.begin() + n);
        std::reverse(origin.begin(), origin.begin() + n);
      }
    };
    constexpr unsigned char slave_line = 4;

    /// A cell as the plane sees it, counterclockwise, and its bounding box.
    struct Shadow
    {
      Polygon polygon;
      Point2  low, high;

      Shadow(const std::array<Point, 4> &corner, const CellPlane &plane)
          : low(plane(corner[0]))
          , high(low)
      {
        for (unsigned char i = 0; i < corner.size(); ++i)
        {
          const Point2 p = plane(corner[i]);
          polygon.add(p, {Polygon::Corner::of_master, {{i, i}}, {{i, i}}}, i);
          for (unsigned int c = 0; c < 2; ++c)
          {
            low[c]  = std::min(low[c], p[c]);
            high[c] = std::max(high[c], p[c]);
          }
        }
        polygon.make_counterclockwise();
      }
      bool apart(const Shadow &other) const
      {
        return low[0] > other.high[0] || high[0] < other.low[0] || low[1] > other.high[1] || high[1] < other.low[1];
      }
    };

    /// Where the edge of @p polygon from corner @p i leaves the half plane of edge @p e of the @p window, or enters it.
    SegmentTrace::Corner crossing(const Polygon     &polygon,
                                  const unsigned int i,
                                  const Polygon     &shadow,
                                  const Polygon     &window,
                                  const unsigned int e)
    {
      SegmentTrace::Corner corner;
      const auto of = [](const Polygon &cell, const unsigned int at) { return cell.origin[at % 4].master[0]; };
      if (polygon.line[i] >= slave_line) // edges of the window meet in its corners
      {
        const unsigned int before = polygon.line[i] - slave_line;
        const auto         at     = of(window, before == (e + 1) % 4 ? before : e);
        corner.kind               = SegmentTrace::Corner::of_slave;
        corner.slave              = {{at, at}};
        return corner;
      }
      corner.kind   = SegmentTrace::Corner::crossing;
      corner.master = {{of(shadow, polygon.line[i]), of(shadow, polygon.line[i] + 1u)}};
      corner.slave  = {{of(window, e), of(window, e + 1)}};
      return corner;
    }

    /// The part of @p shadow inside the convex @p window (Sutherland & Hodgman 1974).
    Polygon clip(const Polygon &shadow, const Polygon &window)
    {
      Polygon polygon = shadow;
      for (unsigned int e = 0; e < window.n && polygon.n > 0; ++e)
      {
        const Point2 &a = window.corner[e], &b = window.corner[(e + 1) % window.n];
        const auto    inside = [&](const Point2 &p) { return cross(b - a, p - a); };
        Polygon       rest;
        for (unsigned int i = 0; i < polygon.n && rest.n + 2 < rest.corner.size(); ++i)
        {
          const Point2       &p = polygon.corner[i], &q = polygon.corner[(i + 1) % polygon.n];
          const double        s = inside(p), t = inside(q);
          const unsigned char along = t < 0. ? slave_line + e : polygon.line[i];
          if (s >= 0.)
            rest.add(p, polygon.origin[i], s > 0. ? polygon.line[i] : along);
          if ((s > 0. && t < 0.) || (s < 0. && t > 0.))
            rest.add(p + s / (s - t) * (q - p), crossing(polygon, i, shadow, window, e), along);
        }
        polygon = rest;
      }
      polygon.begin_at_extreme();
      return polygon;
    }

    unsigned int n_cells(const unsigned int degree)
    {
      return degree * degree;
    }
    std::array<Point, 4> cell_corners(const SurfaceGeometry &surface, const unsigned int f, const unsigned int cell)
    {
      std::array<Point, 4> corners;
      for (unsigned int i = 0; i < 4; ++i)
        corners[i] = surface.positions()[surface.face(f).nodes[cell_node(surface.degree(), cell, i)]];
      return corners;
    }
    Vector3 cell_normal(const std::array<Point, 4> &corner, const double orientation)
    {
      const Vector3 area = dealii::cross_product_3d(corner[2] - corner[0], corner[3] - corner[1]);
      return orientation / area.norm() * area;
    }

    /// A face as the plane sees it.
    class FlatFace
    {
    public:
      /// @param node called as node(n) for the (degree + 1)^2 positions of the face
      template <typename Node>
      FlatFace(const unsigned int degree, const CellPlane &plane, const Node &node)
          : degree_(degree)
      {
        for (unsigned int n = 0; n < (degree + 1) * (degree + 1); ++n)
          nodes_[n] = plane(node(n));
      }

      /// Finds the local coordinates of @p p by Newton's method from what is given; false where there are none.
      bool invert(const Point2 &p, double &xi, double &eta) const
      {
        for (unsigned int iteration = 0; iteration < 20; ++iteration)
        {
          const Tangents t       = tangents(xi, eta);
          const auto     r       = p - t.x;
          const double   det     = cross(t.d_xi, t.d_eta);
          const double   step_xi = cross(r, t.d_eta) / det, step_eta = cross(t.d_xi, r) / det;
          xi += step_xi;
          eta += step_eta;
          if (!(std::abs(xi) + std::abs(eta) < 10.))
            return false;
          if (std::abs(step_xi) + std::abs(step_eta) < 1e-8) // its square is what is left
            return true;
        }
        return false;
      }
      /// Area in the plane over that in local coordinates.
      double area(const double xi, const double eta) const
      {
        const Tangents t = tangents(xi, eta);
        return std::abs(cross(t.d_xi, t.d_eta));
      }

    private:
      struct Tangents
      {
        Point2               x;
        dealii::Tensor<1, 2> d_xi, d_eta;
      };
      Tangents tangents(const double xi, const double eta) const
      {
        const FaceShape shape(degree_, xi, eta);
        Tangents        result;
        for (unsigned int n = 0; n < shape.n; ++n)
        {
          result.x += shape.value[n] * nodes_[n];
          result.d_xi += shape.d_xi[n] * nodes_[n];
          result.d_eta += shape.d_eta[n] * nodes_[n];
        }
        return result;
      }

      const unsigned int    degree_;
      std::array<Point2, 9> nodes_;
    };

    /// Of the face with its smoothing.
    FlatFace smooth_face(const SurfaceGeometry &surface, const unsigned int f, const CellPlane &plane)
    {
      const Point *const points = surface.shape_points(f);
      return FlatFace(surface.shape_degree(), plane, [&](const unsigned int n) { return points[n]; });
    }
    FlatFace facet(const SurfaceGeometry &surface, const unsigned int f, const CellPlane &plane)
    {
      return FlatFace(
          surface.degree(), plane, [&](const unsigned int n) { return surface.positions()[surface.face(f).nodes[n]]; });
    }

    /// Box around a cell swept along its normal by @p reach to both sides.
    dealii::BoundingBox<dim> swept_box(const std::array<Point, 4> &corner, const Vector3 &normal, const double reach)
    {
      Point low = corner[0], high = low;
      for (const Point &x : corner)
        for (unsigned int c = 0; c < dim; ++c)
        {
          const double swept = reach * std::abs(normal[c]);
          low[c]             = std::min(low[c], x[c] - swept);
          high[c]            = std::max(high[c], x[c] + swept);
        }
      return dealii::BoundingBox<dim>({low, high});
    }

    /// What a master cell covers of a slave cell, which is @p window in the @p plane, and the @p part that its points
    /// count with; no corners where that is next to nothing or they do not face each other.
    Polygon overlap(const Shadow          &window,
                    const CellPlane       &plane,
                    const double           cell_area,
                    const SurfaceGeometry &master,
                    const unsigned int     m,
                    const unsigned int     master_cell,
                    double                &part)
    {
      const auto master_corner = cell_corners(master, m, master_cell);
      part                     = facing(-(cell_normal(master_corner, master.face(m).orientation) * plane.normal)).part;
      if (part == 0.)
        return Polygon();
      const Shadow shadow(master_corner, plane);
      if (shadow.apart(window))
        return Polygon();
      const Polygon polygon = clip(shadow.polygon, window.polygon);
      return polygon.n < 3 || polygon.area() < smallest_overlap * cell_area ? Polygon() : polygon;
    }
  } // namespace

  CellPlane::CellPlane(const std::array<Point, 4> &corner, const double orientation)
      : origin(corner[0])
      , normal(cell_normal(corner, orientation))
  {
    axis[0] = corner[1] - corner[0];
    axis[0] -= (axis[0] * normal) * normal;
    axis[0] /= axis[0].norm();
    axis[1] = dealii::cross_product_3d(normal, axis[0]);
  }

  const dealii::Quadrature<2> &segment_rule(const unsigned int degree)
  {
    // the product of two shape functions has total degree 4 (Q1) or 8 (Q2)
    static const dealii::Quadrature<2> rules[] = {dealii::QWitherdenVincentSimplex<2>(3, false),
                                                  dealii::QWitherdenVincentSimplex<2>(5, false)};
    return rules[degree - 1];
  }

  Coverage segment_points(const SurfaceGeometry    &slave,
                          const unsigned int        f,
                          const SurfaceGeometry    &master,
                          const MasterSearch       &search,
                          const double              reach,
                          std::vector<MortarPoint> &points,
                          SegmentTrace             &trace)
  {
    const unsigned int degree = slave.degree();
    const auto        &rule   = segment_rule(degree);
    trace.polygons.clear();
    trace.places.clear();

    thread_local std::vector<unsigned int> candidates;
    points.clear();
    double face_area = 0., covered = 0., twice_counted = 0.; // with the part, with its square
    for (unsigned int cell = 0; cell < n_cells(degree); ++cell)
    {
      const auto      corner = cell_corners(slave, f, cell);
      const CellPlane plane(corner, slave.face(f).orientation);
      const FlatFace  slave_facet = facet(slave, f, plane);
      const Shadow    window(corner, plane);
      const double    cell_area = window.polygon.area();
      face_area += cell_area;

      search.candidates(swept_box(corner, plane.normal, reach), candidates);
      for (const unsigned int m : candidates)
        for (unsigned int master_cell = 0; master_cell < n_cells(degree); ++master_cell)
        {
          double        part;
          const Polygon polygon = overlap(window, plane, cell_area, master, m, master_cell, part);
          if (polygon.n == 0)
            continue;
          trace.polygons.push_back({cell, m, master_cell, part, polygon.n, polygon.corner, polygon.origin});
          const FlatFace master_face = smooth_face(master, m, plane);
          double         xi = (cell % degree + 0.5) / degree, eta = (cell / degree + 0.5) / degree;
          double master_xi = (master_cell % degree + 0.5) / degree, master_eta = (master_cell / degree + 0.5) / degree;
          for (unsigned int t = 2; t < polygon.n; ++t)
          {
            const auto   a = polygon.corner[t - 1] - polygon.corner[0], b = polygon.corner[t] - polygon.corner[0];
            const double twice_area = cross(a, b);
            for (unsigned int q = 0; q < rule.size(); ++q)
            {
              const Point2 p = polygon.corner[0] + rule.point(q)[0] * a + rule.point(q)[1] * b;
              if (!slave_facet.invert(p, xi, eta))
              {
                points.clear();
                trace.places.clear();
                return {}; // the face is folded over: no partner
              }
              // the partner lies on the smoothed faces, straight across
              const Point x = slave.position(f, xi, eta);
              if (!master_face.invert(plane(x), master_xi, master_eta))
              {
                master_xi  = (master_cell % degree + 0.5) / degree;
                master_eta = (master_cell / degree + 0.5) / degree;
                continue;
              }
              const Vector3 gap = master.position(m, master_xi, master_eta) - x;
              if (gap.norm() > reach)
                continue;
              const double area = part * twice_area * rule.weight(q);
              points.push_back({xi, eta, area / slave_facet.area(xi, eta), {m, master_xi, master_eta}});
              trace.places.push_back({static_cast<unsigned int>(trace.polygons.size() - 1),
                                      static_cast<unsigned char>(t),
                                      static_cast<unsigned char>(q)});
              covered += area;
              twice_counted += part * area;
            }
          }
        }
    }
    if (points.empty())
      return {};
    return {covered * covered / (face_area * twice_counted), twice_counted / covered};
  }
} // namespace Nodus
