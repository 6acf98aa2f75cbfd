#include "contact/segments.h"
#include "contact/clipping.h"
#include "contact/flat_face.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Overlaps below this fraction of a slave cell are round-off.
    constexpr double smallest_overlap = 1e-10;
    /// Of the reach: a face this much nearer than another one is before it.
    constexpr double round_off = 1e-6;

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

    /// Box around a cell swept along its normal, so far ahead and behind.
    dealii::BoundingBox<dim>
    swept_box(const std::array<Point, 4> &corner, const Vector3 &normal, const double ahead, const double behind)
    {
      Point low = corner[0], high = low;
      for (const Point &x : corner)
        for (unsigned int c = 0; c < dim; ++c)
        {
          const double ends[] = {ahead * normal[c], -behind * normal[c]};
          low[c]              = std::min({low[c], x[c] + ends[0], x[c] + ends[1]});
          high[c]             = std::max({high[c], x[c] + ends[0], x[c] + ends[1]});
        }
      return dealii::BoundingBox<dim>({low, high});
    }

    /// What a master cell covers of a slave cell.
    struct Overlap
    {
      unsigned int         m, cell;   ///< master face, its cell
      double               part;      ///< that its points count with
      double               near_rate; ///< SegmentTrace::Polygon
      Polygon              polygon;
      double               at_origin; ///< height of the master cell over the plane, where the origin of that is, ...
      dealii::Tensor<1, 2> slope;     ///< ... and how it rises

      double height(const Point2 &p) const
      {
        return at_origin + slope * p;
      }
    };

    /// Integration points of one slave face.
    class FacePoints
    {
    public:
      FacePoints(const ContactGeometry    &geometry,
                 const unsigned int        pair,
                 const unsigned int        f,
                 std::vector<MortarPoint> &points,
                 SegmentTrace             &trace)
          : slave_(geometry.slave[pair])
          , master_(geometry.master[pair])
          , search_(geometry.search[pair])
          , self_(geometry.self[pair].get())
          , reach_(geometry.reach[pair])
          , f_(f)
          , degree_(slave_.degree())
          , points_(points)
          , trace_(trace)
      {
      }

      Coverage find()
      {
        points_.clear();
        trace_.polygons.clear();
        trace_.places.clear();
        for (unsigned int cell = 0; cell < n_cells(degree_); ++cell)
        {
          const auto      corner = cell_corners(slave_, f_, cell);
          const CellPlane plane(corner, slave_.face(f_).orientation);
          if (!find_candidates(corner, plane))
            continue;
          const FlatFace slave_facet = facet(slave_, f_, plane), slave_face = smooth_face(slave_, f_, plane);
          find_overlaps(corner, plane);
          reserve();
          for (const Overlap &overlap : overlaps())
            if ((self_ == nullptr || self_->is_slave(f_, overlap.m)) &&
                !add_points(cell, plane, slave_facet, slave_face, overlap))
            {
              points_.clear();
              trace_.places.clear();
              return {}; // the face is folded over: no partner
            }
        }
        if (points_.empty())
          return {};
        double area = 0.;
        for (unsigned int cell = 0; cell < n_cells(degree_); ++cell)
        {
          const auto corner = cell_corners(slave_, f_, cell);
          area += Shadow(corner, CellPlane(corner, slave_.face(f_).orientation)).polygon.area();
        }
        return {covered_ * covered_ / (area * twice_counted_), twice_counted_ / covered_};
      }

    private:
      /// Those of the present slave cell.
      static std::vector<Overlap> &overlaps()
      {
        thread_local std::vector<Overlap> overlaps;
        return overlaps;
      }

      /// Master faces that the present slave cell may overlap.
      static std::vector<unsigned int> &candidates()
      {
        thread_local std::vector<unsigned int> candidates;
        return candidates;
      }

      /// @returns whether there are some that the slave cell is the slave of: most of a surface that touches itself has
      /// none.
      bool find_candidates(const std::array<Point, 4> &corner, const CellPlane &plane)
      {
        std::vector<unsigned int> &faces = candidates();
        if (self_ == nullptr)
        {
          search_.candidates(swept_box(corner, plane.normal, reach_, reach_), faces);
          return !faces.empty();
        }
        const double most_visible = self_->most_visible(f_);
        search_.candidates(swept_box(corner, plane.normal, reach_, std::min(reach_, most_visible)), faces);
        faces.erase(std::remove_if(faces.begin(),
                                   faces.end(),
                                   [&](const unsigned int m) {
                                     return !self_->may_touch(f_, m) ||
                                            self_->is_beyond(m, plane.origin, plane.normal, most_visible);
                                   }),
                    faces.end());
        return std::any_of(faces.begin(), faces.end(), [&](const unsigned int m) { return self_->is_slave(f_, m); });
      }

      /// With all of these that face the slave cell.
      void find_overlaps(const std::array<Point, 4> &corner, const CellPlane &plane)
      {
        const Shadow  window(corner, plane);
        const double  cell_area = window.polygon.area();
        const Vector3 middle    = cell_middle(corner);
        overlaps().clear();
        for (const unsigned int m : candidates())
          for (unsigned int cell = 0; cell < n_cells(degree_); ++cell)
            add_overlap(window, plane, middle, cell_area, m, cell);
      }

      /// For as many points as the overlaps of the present slave cell have.
      void reserve()
      {
        unsigned int triangles = 0;
        for (const Overlap &overlap : overlaps())
          triangles += overlap.polygon.n - 2;
        points_.reserve(points_.size() + triangles * segment_rule(degree_).size());
        trace_.places.reserve(points_.capacity());
        trace_.polygons.reserve(trace_.polygons.size() + overlaps().size());
      }

      /// Unless it is next to nothing, or the cells do not face each other.
      void add_overlap(const Shadow      &window,
                       const CellPlane   &plane,
                       const Vector3     &slave_middle,
                       const double       cell_area,
                       const unsigned int m,
                       const unsigned int cell)
      {
        const auto    corner = cell_corners(master_, m, cell);
        const Vector3 normal = cell_normal(corner, master_.face(m).orientation);
        const double  cosine = -(normal * plane.normal);
        double        part   = facing(cosine).part;
        if (part == 0.)
          return;
        const Shadow shadow(corner, plane);
        if (shadow.apart(window))
          return;
        const Polygon polygon = clip(shadow.polygon, window.polygon);
        if (polygon.n < 3 || polygon.area() < smallest_overlap * cell_area)
          return;
        const Vector3 rises = normal / cosine, middle = cell_middle(corner);
        double        near_rate = 0.;
        if (self_ != nullptr)
        {
          const double height = (slave_middle - middle) * rises;
          const Fading near   = self_->near_part(std::abs(height));
          if (near.part == 0.)
            return;
          part *= near.part;
          near_rate = (height < 0. ? -near.slope : near.slope) / near.part;
        }
        overlaps().push_back({m,
                              cell,
                              part,
                              near_rate,
                              polygon,
                              (plane.origin - middle) * rises,
                              Point2(plane.axis[0] * rises, plane.axis[1] * rises)});
      }

      /// What the faces before this one leave of the part that it counts with at @p p (eq. J11).
      double seen(const Overlap &overlap, const Point2 &p) const
      {
        const double height = std::abs(overlap.height(p)) - round_off * reach_;
        double       hidden = 0.;
        for (const Overlap &other : overlaps())
          if (other.part > hidden && other.m != overlap.m)
          {
            const double before = other.height(p);
            if (std::abs(before) < height && other.polygon.contains(p) &&
                (before >= 0. ||
                 before > -(self_ == nullptr ? reach_ : self_->visible(f_, 0.5, 0.5, other.m, 0.5, 0.5))))
              hidden = other.part;
          }
        return 1. - hidden;
      }

      /// False where the slave face is folded over.
      bool add_points(const unsigned int cell,
                      const CellPlane   &plane,
                      const FlatFace    &slave_facet,
                      const FlatFace    &slave_face,
                      const Overlap     &overlap)
      {
        const Polygon &polygon = overlap.polygon;
        const auto    &rule    = segment_rule(degree_);
        trace_.polygons.push_back(
            {cell, overlap.m, overlap.cell, overlap.near_rate, polygon.n, polygon.corner, polygon.origin});
        const FlatFace master_face = smooth_face(master_, overlap.m, plane);
        double         xi = (cell % degree_ + 0.5) / degree_, eta = (cell / degree_ + 0.5) / degree_;
        const double   middle_xi = (overlap.cell % degree_ + 0.5) / degree_,
                     middle_eta  = (overlap.cell / degree_ + 0.5) / degree_;
        Projection master{overlap.m, middle_xi, middle_eta};
        for (unsigned int t = 2; t < polygon.n; ++t)
        {
          const auto   a = polygon.corner[t - 1] - polygon.corner[0], b = polygon.corner[t] - polygon.corner[0];
          const double twice_area = cross(a, b);
          for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const Point2 p = polygon.corner[0] + rule.point(q)[0] * a + rule.point(q)[1] * b;
            if (!slave_facet.invert(p, xi, eta))
              return false;
            // the partner lies on the smoothed faces, straight across
            const FlatFace::Place x = slave_face.place(xi, eta);
            if (!master_face.invert(x.x, master.xi, master.eta))
            {
              master.xi  = middle_xi;
              master.eta = middle_eta;
              continue;
            }
            const double depth = x.height - master_face.place(master.xi, master.eta).height;
            if (std::abs(depth) > reach_)
              continue;
            if (self_ != nullptr && depth > 0. && depth > self_->visible(f_, xi, eta, overlap.m, master.xi, master.eta))
              continue;
            const double part = overlap.part * seen(overlap, p);
            if (part == 0.)
              continue;
            const double area = part * twice_area * rule.weight(q);
            points_.push_back({xi, eta, area / slave_facet.area(xi, eta), master});
            trace_.places.push_back({part,
                                     static_cast<unsigned int>(trace_.polygons.size() - 1),
                                     static_cast<unsigned char>(t),
                                     static_cast<unsigned char>(q)});
            covered_ += area;
            twice_counted_ += part * area;
          }
        }
        return true;
      }

      const SurfaceGeometry    &slave_, &master_;
      const MasterSearch       &search_;
      const SelfContact *const  self_; ///< or nullptr
      const double              reach_;
      const unsigned int        f_, degree_;
      std::vector<MortarPoint> &points_;
      SegmentTrace             &trace_;
      double                    covered_ = 0., twice_counted_ = 0.; ///< with the part, with its square
    };
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

  Coverage segment_points(const ContactGeometry    &geometry,
                          const unsigned int        pair,
                          const unsigned int        f,
                          std::vector<MortarPoint> &points,
                          SegmentTrace             &trace)
  {
    return FacePoints(geometry, pair, f, points, trace).find();
  }
} // namespace Nodus
