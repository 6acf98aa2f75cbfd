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

    /// Faces that look away from each other less than this (cosine) do not overlap.
    constexpr double facing_cosine = 0.1;
    /// Overlaps below this fraction of a slave cell are round-off.
    constexpr double smallest_overlap = 1e-10;

    double cross(const dealii::Tensor<1, 2> &a, const dealii::Tensor<1, 2> &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }

    /// Plane through a slave cell: its outward normal and two axes.
    struct Plane
    {
      Point   origin;
      Vector3 normal, axis[2];

      Point2 operator()(const Point &x) const
      {
        return Point2((x - origin) * axis[0], (x - origin) * axis[1]);
      }
    };

    /// A convex polygon; two quadrilaterals overlap in at most eight corners.
    struct Polygon
    {
      std::array<Point2, 16> corner;
      unsigned int           n = 0;

      void add(const Point2 &p)
      {
        corner[n++] = p;
      }
      double area() const
      {
        double twice = 0.;
        for (unsigned int i = 2; i < n; ++i)
          twice += cross(corner[i - 1] - corner[0], corner[i] - corner[0]);
        return 0.5 * twice;
      }
      void make_counterclockwise()
      {
        if (area() < 0.)
          std::reverse(corner.begin(), corner.begin() + n);
      }
    };

    /// A cell as the plane sees it, counterclockwise, and its bounding box.
    struct Shadow
    {
      Polygon polygon;
      Point2  low, high;

      Shadow(const std::array<Point, 4> &corner, const Plane &plane)
          : low(plane(corner[0]))
          , high(low)
      {
        for (const Point &x : corner)
        {
          const Point2 p = plane(x);
          polygon.add(p);
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

    /// The part of @p polygon inside the convex @p window (Sutherland & Hodgman 1974).
    Polygon clip(Polygon polygon, const Polygon &window)
    {
      for (unsigned int e = 0; e < window.n && polygon.n > 0; ++e)
      {
        const Point2 &a = window.corner[e], &b = window.corner[(e + 1) % window.n];
        const auto    inside = [&](const Point2 &p) { return cross(b - a, p - a); };
        Polygon       rest;
        for (unsigned int i = 0; i < polygon.n && rest.n + 2 < rest.corner.size(); ++i)
        {
          const Point2 &p = polygon.corner[i], &q = polygon.corner[(i + 1) % polygon.n];
          const double  s = inside(p), t = inside(q);
          if (s >= 0.)
            rest.add(p);
          if ((s > 0. && t < 0.) || (s < 0. && t > 0.))
            rest.add(p + s / (s - t) * (q - p));
        }
        polygon = rest;
      }
      return polygon;
    }

    /// The cells of a face that are clipped: the face itself, or the quarters of one of degree 2.
    unsigned int n_cells(const unsigned int degree)
    {
      return degree * degree;
    }
    std::array<Point, 4> cell_corners(const SurfaceGeometry &surface, const unsigned int f, const unsigned int cell)
    {
      const unsigned int degree = surface.degree(), n = degree + 1;
      const unsigned int first = cell % degree + n * (cell / degree);
      const auto        &nodes = surface.face(f).nodes;
      const auto        &x     = surface.positions();
      return {{x[nodes[first]], x[nodes[first + 1]], x[nodes[first + 1 + n]], x[nodes[first + n]]}};
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
      FlatFace(const unsigned int degree, const Plane &plane, const Node &node)
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
    FlatFace smooth_face(const SurfaceGeometry &surface, const unsigned int f, const Plane &plane)
    {
      const Point *const points = surface.shape_points(f);
      return FlatFace(surface.shape_degree(), plane, [&](const unsigned int n) { return points[n]; });
    }
    FlatFace faceted_face(const SurfaceGeometry &surface, const unsigned int f, const Plane &plane)
    {
      return FlatFace(
          surface.degree(), plane, [&](const unsigned int n) { return surface.positions()[surface.face(f).nodes[n]]; });
    }

    /// The plane through the corners of a cell.
    Plane plane_through(const std::array<Point, 4> &corner, const double orientation)
    {
      Plane plane;
      plane.normal  = cell_normal(corner, orientation);
      plane.origin  = corner[0];
      plane.axis[0] = corner[1] - corner[0];
      plane.axis[0] -= (plane.axis[0] * plane.normal) * plane.normal;
      plane.axis[0] /= plane.axis[0].norm();
      plane.axis[1] = dealii::cross_product_3d(plane.normal, plane.axis[0]);
      return plane;
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

    /// Local coordinates of the centre of a cell.
    struct CellCentre
    {
      double xi, eta;

      CellCentre(const unsigned int cell, const unsigned int degree)
          : xi((cell % degree + 0.5) / degree)
          , eta((cell / degree + 0.5) / degree)
      {
      }
    };

    /// A cell of a slave face, with the plane that overlaps are seen in.
    struct SlaveCell
    {
      const SurfaceGeometry     &surface;
      const unsigned int         face, cell;
      const std::array<Point, 4> corner;
      const Plane                plane;
      const FlatFace             facet; ///< the whole face in the plane
      const Shadow               window;
      const double               area;

      SlaveCell(const SurfaceGeometry &surface, const unsigned int f, const unsigned int cell)
          : surface(surface)
          , face(f)
          , cell(cell)
          , corner(cell_corners(surface, f, cell))
          , plane(plane_through(corner, surface.face(f).orientation))
          , facet(faceted_face(surface, f, plane))
          , window(corner, plane)
          , area(window.polygon.area())
      {
      }
    };

    /// What a master cell covers of a slave cell; no corners where that is next to nothing.
    Polygon
    overlap(const SlaveCell &slave, const SurfaceGeometry &master, const unsigned int m, const unsigned int master_cell)
    {
      const auto corner = cell_corners(master, m, master_cell);
      if (cell_normal(corner, master.face(m).orientation) * slave.plane.normal > -facing_cosine)
        return Polygon();
      const Shadow shadow(corner, slave.plane);
      if (shadow.apart(slave.window))
        return Polygon();
      const Polygon polygon = clip(shadow.polygon, slave.window.polygon);
      return polygon.n < 3 || polygon.area() < smallest_overlap * slave.area ? Polygon() : polygon;
    }

    /// Integration points of a slave face, and the area in the planes of its cells that they stand for.
    class Segments
    {
    public:
      /// Clears @p points, which get those of the calls that follow.
      Segments(const unsigned int degree, const double reach, std::vector<MortarPoint> &points)
          : degree_(degree)
          , reach_(reach)
          , points_(points)
      {
        points_.clear();
      }

      /// Adds the points on an overlap, triangle by triangle. @returns false, and has no points any more, where the
      /// slave face is folded over.
      bool add(const SlaveCell       &slave,
               const SurfaceGeometry &master,
               const unsigned int     m,
               const unsigned int     master_cell,
               const Polygon         &polygon)
      {
        // the product of two shape functions has total degree 4 (Q1) or 8 (Q2)
        static const dealii::Quadrature<2> rules[] = {dealii::QWitherdenVincentSimplex<2>(3, false),
                                                      dealii::QWitherdenVincentSimplex<2>(5, false)};
        const auto                        &rule    = rules[degree_ - 1];

        const FlatFace   master_face = smooth_face(master, m, slave.plane);
        const CellCentre master_centre(master_cell, degree_);
        CellCentre       on_slave(slave.cell, degree_), on_master = master_centre; // each point starts from the last
        for (unsigned int t = 2; t < polygon.n; ++t)
        {
          const auto   a = polygon.corner[t - 1] - polygon.corner[0], b = polygon.corner[t] - polygon.corner[0];
          const double twice_area = cross(a, b);
          for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const Point2 p = polygon.corner[0] + rule.point(q)[0] * a + rule.point(q)[1] * b;
            if (!slave.facet.invert(p, on_slave.xi, on_slave.eta))
            {
              points_.clear();
              return false;
            }
            // the partner lies on the smoothed faces, straight across
            const Point x = slave.surface.position(slave.face, on_slave.xi, on_slave.eta);
            if (!master_face.invert(slave.plane(x), on_master.xi, on_master.eta))
            {
              on_master = master_centre;
              continue;
            }
            const Vector3 gap = master.position(m, on_master.xi, on_master.eta) - x;
            if (gap.norm() > reach_)
              continue;
            const double area = twice_area * rule.weight(q);
            points_.push_back({on_slave.xi,
                               on_slave.eta,
                               area / slave.facet.area(on_slave.xi, on_slave.eta),
                               {m, on_master.xi, on_master.eta}});
            covered_ += area;
          }
        }
        return true;
      }
      double covered() const
      {
        return covered_;
      }

    private:
      const unsigned int        degree_;
      const double              reach_;
      std::vector<MortarPoint> &points_;
      double                    covered_ = 0.;
    };
  } // namespace

  double segment_points(const SurfaceGeometry    &slave,
                        const unsigned int        f,
                        const SurfaceGeometry    &master,
                        const MasterSearch       &search,
                        const double              reach,
                        std::vector<MortarPoint> &points)
  {
    thread_local std::vector<unsigned int> candidates;
    const unsigned int                     degree = slave.degree();
    Segments                               segments(degree, reach, points);
    double                                 face_area = 0.;
    for (unsigned int cell = 0; cell < n_cells(degree); ++cell)
    {
      const SlaveCell slave_cell(slave, f, cell);
      face_area += slave_cell.area;
      search.candidates(swept_box(slave_cell.corner, slave_cell.plane.normal, reach), candidates);
      for (const unsigned int m : candidates)
        for (unsigned int master_cell = 0; master_cell < n_cells(degree); ++master_cell)
        {
          const Polygon polygon = overlap(slave_cell, master, m, master_cell);
          if (polygon.n > 0 && !segments.add(slave_cell, master, m, master_cell, polygon))
            return 0.; // no partner
        }
    }
    return segments.covered() / face_area;
  }
} // namespace Nodus
