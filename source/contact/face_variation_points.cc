#include "contact/face_variation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

// How the integration points of a face move: with the corners of the overlaps, or sliding on the master.

namespace Nodus
{
  namespace
  {
    /// Edges that are as parallel as this (sine) have no crossing that follows both: matching faces.
    constexpr double parallel = 1e-6;
    /// Corners of an overlap that are in a line span triangles without area. Their points have next to no weight; this
    /// bounds the derivative of its logarithm.
    constexpr double smallest_sine = 1e-10;

    using Plane2 = Eigen::Vector2d;

    double cross(const Plane2 &a, const Plane2 &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }
    Eigen::RowVector3d eigen(const Vector3 &v)
    {
      return {v[0], v[1], v[2]};
    }
    Plane2 plane_point(const dealii::Point<2> &p)
    {
      return {p[0], p[1]};
    }
    /// x^alpha with x^alpha . x_beta = delta, in the tangent plane.
    std::array<Vector3, 2> dual_tangents(const FaceGeometry &x)
    {
      const double a = x.d_xi * x.d_xi, b = x.d_xi * x.d_eta, c = x.d_eta * x.d_eta, det = a * c - b * b;
      return {{(c * x.d_xi - b * x.d_eta) / det, (a * x.d_eta - b * x.d_xi) / det}};
    }
    std::array<Vector3, 3> curvature(const SurfaceFace        &face,
                                     const std::vector<Point> &x,
                                     const unsigned int        degree,
                                     const double              xi,
                                     const double              eta)
    {
      std::array<Point, 9> points;
      for (unsigned int n = 0; n < face.nodes.size(); ++n)
        points[n] = x[face.nodes[n]];
      return FaceCurvature(degree, xi, eta).of(points.data(), face.nodes.size());
    }
  } // namespace

  /// Variation of the logarithm of the surface element that areas are measured with (eq. G19).
  template <typename Element, typename Motion>
  Element
  FaceVariation::element_gradient(const FaceShape &shape, const double xi, const double eta, const Motion &motion) const
  {
    const SurfaceFace &face   = slave_.face(face_.face);
    const auto         dual   = dual_tangents(FaceGeometry(face, shape, measure_));
    const auto         second = curvature(face, measure_, slave_.degree(), xi, eta);
    Element            result = Element::Zero(1, motion.cols());
    for (unsigned int i = 0; i < 2; ++i)
    {
      for (unsigned int n = 0; n < shape.n && current_; ++n)
        result.template segment<3>(3 * n) += (i == 0 ? shape.d_xi : shape.d_eta)[n] * eigen(dual[i]);
      for (unsigned int j = 0; j < 2; ++j)
        result += dual[i] * second[i + j] * motion.row(1 + j);
    }
    return result;
  }
  /// The plane of a slave cell and how it tilts; motions in it leave its origin and its spin out, on which nothing
  /// depends.
  template <int columns>
  struct FaceVariation::SegmentFrame
  {
    using Row  = Eigen::Matrix<double, 1, columns, Eigen::RowMajor>;
    using Row2 = Eigen::Matrix<double, 2, columns, Eigen::RowMajor>;

    SegmentFrame(const SurfaceGeometry &slave, const unsigned int f, const unsigned int cell)
        : corner(corners(slave, f, cell))
        , plane(corner, slave.face(f).orientation)
        , tilt(Row2::Zero())
        , cell_area(Row::Zero())
    {
      for (unsigned int i = 0; i < 2; ++i)
        axes.row(i) = eigen(plane.axis[i]);
      const Vector3 d[2]       = {corner[2] - corner[0], corner[3] - corner[1]};
      const Vector3 twice_area = dealii::cross_product_3d(d[0], d[1]);
      area                     = 0.5 * twice_area.norm();
      const auto add           = [&](auto &&row, const Vector3 &n, const double factor)
      {
        const Eigen::RowVector3d first  = factor * eigen(dealii::cross_product_3d(d[1], n)),
                                 second = factor * eigen(dealii::cross_product_3d(n, d[0]));
        for (const auto &[at, value] : {std::make_pair(2u, first), std::make_pair(3u, second)})
        {
          row.template segment<3>(3 * cell_node(slave.degree(), cell, at)) += value;
          row.template segment<3>(3 * cell_node(slave.degree(), cell, at - 2)) -= value;
        }
      };
      for (unsigned int i = 0; i < 2; ++i)
        add(tilt.row(i), plane.axis[i], slave.face(f).orientation / (2. * area));
      add(cell_area.row(0), twice_area / twice_area.norm(), 0.5);
    }
    static std::array<Point, 4> corners(const SurfaceGeometry &surface, const unsigned int f, const unsigned int cell)
    {
      std::array<Point, 4> result;
      for (unsigned int i = 0; i < 4; ++i)
        result[i] = surface.positions()[surface.face(f).nodes[cell_node(surface.degree(), cell, i)]];
      return result;
    }

    double height(const Point &x) const
    {
      return (x - plane.origin) * plane.normal;
    }
    Plane2 in_plane(const Vector3 &v) const
    {
      return {v * plane.axis[0], v * plane.axis[1]};
    }
    /// Adds the motion of a corner of the slave cell, or of the master one.
    void add_corner(const unsigned int node, const Point &x, const double factor, Row2 &motion) const
    {
      motion.template middleCols<3>(3 * node) += factor * axes;
      motion -= factor * height(x) * tilt;
    }
    Row2 motion(const SegmentTrace::Polygon &polygon,
                const unsigned int           i,
                const unsigned int           degree,
                const unsigned int           n_slave) const;

    std::array<Point, 4>        corner, master_corner;
    CellPlane                   plane;
    Eigen::Matrix<double, 2, 3> axes;
    double                      area;
    Row2                        tilt; ///< in-plane components of the change of the normal
    Row                         cell_area;
    std::array<Row2, 16>        corners_motion; ///< of the polygon
  };

  template <int columns>
  typename FaceVariation::SegmentFrame<columns>::Row2
  FaceVariation::SegmentFrame<columns>::motion(const SegmentTrace::Polygon &polygon,
                                               const unsigned int           i,
                                               const unsigned int           degree,
                                               const unsigned int           n_slave) const
  {
    using Corner         = SegmentTrace::Corner;
    const Corner &origin = polygon.corner[i];
    const auto    vertex = [&](const bool master, const unsigned int at, const double factor, Row2 &sum)
    {
      if (master)
        add_corner(n_slave + cell_node(degree, polygon.master_cell, at), master_corner[at], factor, sum);
      else
        add_corner(cell_node(degree, polygon.cell, at), corner[at], factor, sum);
    };
    Row2 result = Row2::Zero();
    if (origin.kind != Corner::crossing)
    {
      const bool master = origin.kind == Corner::of_master;
      vertex(master, master ? origin.master[0] : origin.slave[0], 1., result);
      return result;
    }
    // The point stays on both edges: it goes along with the master edge, and slides on that as far as the slave edge
    // moves across itself.
    const Plane2 p = plane_point(plane(master_corner[origin.master[0]])),
                 d = plane_point(plane(master_corner[origin.master[1]])) - p,
                 a = plane_point(plane(corner[origin.slave[0]])), e = plane_point(plane(corner[origin.slave[1]])) - a,
                 x         = plane_point(polygon.x[i]);
    const double on_master = (x - p).dot(d) / d.squaredNorm(), on_slave = (x - a).dot(e) / e.squaredNorm();
    vertex(true, origin.master[0], 1. - on_master, result);
    vertex(true, origin.master[1], on_master, result);
    const double sine = cross(e, d);
    if (std::abs(sine) < parallel * e.norm() * d.norm())
      return result;
    Row2 across = -result;
    vertex(false, origin.slave[0], 1. - on_slave, across);
    vertex(false, origin.slave[1], on_slave, across);
    const Row slide = (e[0] * across.row(1) - e[1] * across.row(0)) / sine;
    result += d * slide;
    return result;
  }

  template <int columns>
  void FaceVariation::add_segments()
  {
    const unsigned int degree = slave_.degree(), none = static_cast<unsigned int>(-1);
    double             face_area = 0.;
    unsigned int       at        = none;
    number_local(face_.points[0].master.face);
    for (unsigned int cell = 0; cell < degree * degree; ++cell)
    {
      const SegmentFrame<columns> frame(slave_, face_.face, cell);
      face_area += frame.area;
      for (unsigned int i = 0; i < local_.n_slave; ++i)
        d_coverage_.middleCols<3>(3 * i) -= face_.coverage * frame.cell_area.template segment<3>(3 * i);
    }
    std::optional<SegmentFrame<columns>> frame;
    for (unsigned int q = 0; q < face_.points.size(); ++q)
    {
      const SegmentTrace::Place   &place   = face_.trace.places[q];
      const SegmentTrace::Polygon &polygon = face_.trace.polygons[place.polygon];
      if (place.polygon != at)
      {
        flush();
        at = place.polygon;
        number_local(polygon.master);
        frame.emplace(slave_, face_.face, polygon.cell);
        frame->master_corner = SegmentFrame<columns>::corners(master_, polygon.master, polygon.master_cell);
        for (unsigned int i = 0; i < polygon.n; ++i)
          frame->corners_motion[i] = frame->motion(polygon, i, degree, local_.n_slave);
      }
      add_point(face_.points[q], segment_gradient<columns>(polygon, place, face_.points[q], *frame));
    }
    flush();
    d_coverage_ /= face_area;
  }

  template <int columns>
  FaceVariation::FixedGradient<columns> FaceVariation::segment_gradient(const SegmentTrace::Polygon &polygon,
                                                                        const SegmentTrace::Place   &place,
                                                                        const MortarPoint           &point,
                                                                        const SegmentFrame<columns> &frame)
  {
    using Row               = typename SegmentFrame<columns>::Row;
    using Row2              = typename SegmentFrame<columns>::Row2;
    const auto  &rule       = segment_rule(slave_.degree());
    const Plane2 a          = plane_point(polygon.x[place.last - 1]) - plane_point(polygon.x[0]),
                 b          = plane_point(polygon.x[place.last]) - plane_point(polygon.x[0]);
    const double twice_area = cross(a, b), r = rule.point(place.q)[0], s = rule.point(place.q)[1];
    const Row2  &first = frame.corners_motion[0];
    const Row2   d_a = frame.corners_motion[place.last - 1] - first, d_b = frame.corners_motion[place.last] - first;
    Eigen::Matrix<double, n_coordinates, columns, Eigen::RowMajor> result;
    const Row                                                      log_area =
        (d_a.row(0) * b[1] - d_a.row(1) * b[0] + a[0] * d_b.row(1) - a[1] * d_b.row(0)) /
        std::max(twice_area, smallest_sine * (a.squaredNorm() + b.squaredNorm()) + std::numeric_limits<double>::min());
    if (face_.dual_slope() > 0.)
      for (unsigned int l = 0; l < local_.size(); ++l)
        d_coverage_.middleCols<3>(3 * local_.place[l]) +=
            twice_area * rule.weight(place.q) * log_area.template segment<3>(3 * l);

    // where the point is on the facet
    const FaceShape    shape(slave_.degree(), point.xi, point.eta);
    const FaceGeometry facet(slave_.face(face_.face), shape, slave_.positions());
    Eigen::Matrix2d    J;
    J.col(0)                      = frame.in_plane(facet.d_xi);
    J.col(1)                      = frame.in_plane(facet.d_eta);
    const Eigen::Matrix2d inverse = J.inverse();
    Row2                  motion  = first + r * d_a + s * d_b + frame.height(facet.x) * frame.tilt;
    Row2                  nodes   = Row2::Zero(); // of the same point of the slave face
    for (unsigned int n = 0; n < shape.n; ++n)
      nodes.template middleCols<3>(3 * n) = shape.value[n] * frame.axes;
    motion -= nodes;
    result.template middleRows<2>(1) = inverse * motion;

    // straight across, on the smoothed faces
    const FaceGeometry x = slave_.at(face_.face, point.xi, point.eta),
                       y = master_.at(polygon.master, point.master.xi, point.master.eta);
    J.col(0)             = frame.in_plane(x.d_xi);
    J.col(1)             = frame.in_plane(x.d_eta);
    motion = J * result.template middleRows<2>(1) + nodes + (frame.height(y.x) - frame.height(x.x)) * frame.tilt;
    const FaceShape master_shape(master_.degree(), point.master.xi, point.master.eta);
    for (unsigned int n = 0; n < master_shape.n; ++n)
      motion.template middleCols<3>(3 * (local_.n_slave + n)) -= master_shape.value[n] * frame.axes;
    J.col(0)                         = frame.in_plane(y.d_xi);
    J.col(1)                         = frame.in_plane(y.d_eta);
    result.template middleRows<2>(3) = J.inverse() * motion;

    // weight: area in the plane times the surface element over that in the plane
    result.row(0)       = log_area + element_gradient<Row>(shape, point.xi, point.eta, result);
    const auto   second = curvature(slave_.face(face_.face), slave_.positions(), slave_.degree(), point.xi, point.eta);
    const double heights[2] = {facet.d_xi * frame.plane.normal, facet.d_eta * frame.plane.normal};
    for (unsigned int i = 0; i < 2; ++i)
    {
      const Eigen::RowVector2d dual = inverse.row(i);
      for (unsigned int n = 0; n < shape.n; ++n)
        result.template block<1, 3>(0, 3 * n) -= (i == 0 ? shape.d_xi : shape.d_eta)[n] * dual * frame.axes;
      result.row(0) += heights[i] * dual * frame.tilt;
      for (unsigned int j = 0; j < 2; ++j)
        result.row(0) -= dual.dot(frame.in_plane(second[i + j])) * result.row(1 + j);
    }
    return result;
  }

  void FaceVariation::add_fixed_points()
  {
    unsigned int at = static_cast<unsigned int>(-1);
    for (const MortarPoint &point : face_.points)
    {
      if (batch_.n_points == 0 || point.master.face != at)
      {
        flush();
        at = point.master.face;
        number_local(at);
      }
      add_point(point, fixed_gradient(point));
    }
    flush();
  }

  /// The weight of a point beyond the rim of the master goes with its overhang, and with that the covered part.
  void FaceVariation::fade_out(const MortarPoint &point, const FaceShape &shape, Gradient &gradient)
  {
    const Vector3 beyond   = search_.overhang(point.master, slave_.at(face_.face, point.xi, point.eta).x);
    const double  overhang = beyond.norm();
    if (!(overhang > 0.))
      return;
    const FaceShape master_shape(master_.degree(), point.master.xi, point.master.eta);
    const double    rate   = ContactGeometry::fading / ContactGeometry::counted_part(overhang);
    const auto      slope  = eigen(-rate / (search_.tolerated_overhang(point.master.face) * overhang) * beyond);
    Row             fading = Row::Zero(1, gradient.cols());
    for (unsigned int n = 0; n < shape.n; ++n)
      fading.segment<3>(3 * n) += shape.value[n] * slope;
    for (unsigned int n = 0; n < master_shape.n; ++n)
      fading.segment<3>(3 * (local_.n_slave + n)) -= master_shape.value[n] * slope;
    gradient.row(0) += fading;
    for (unsigned int l = 0; l < local_.size(); ++l)
      d_coverage_.middleCols<3>(3 * local_.place[l]) += point.weight * fading.segment<3>(3 * l);
  }

  FaceVariation::Gradient FaceVariation::fixed_gradient(const MortarPoint &point)
  {
    const FaceShape shape(slave_.degree(), point.xi, point.eta);
    const Point     p      = slave_.at(face_.face, point.xi, point.eta).x;
    Gradient        result = Gradient::Zero(n_coordinates, 3 * local_.size());
    result.row(0)          = element_gradient<Row>(shape, point.xi, point.eta, result);
    const auto add_slave   = [&](const unsigned int row, const Vector3 &dual)
    {
      for (unsigned int n = 0; n < shape.n; ++n)
        result.block<1, 3>(row, 3 * n) += shape.value[n] * eigen(dual);
    };
    if (rigid_ != nullptr)
    {
      const RigidPoint closest = rigid_->closest(p);
      for (unsigned int i = 0; i < 2; ++i)
      {
        const Vector3 dual = closest.slide() * closest.direction[i];
        add_slave(3 + i, dual);
        if (const RigidCarrier *const carrier = rigid_->carrier())
        {
          const RigidCarrier::Weights weights = carrier->weights(p);
          for (unsigned int n = 0; n < weights.size(); ++n)
            result.block<1, 3>(3 + i, 3 * (local_.n_slave + n)) -= weights[n] * eigen(dual);
        }
      }
      return result;
    }
    fade_out(point, shape, result);
    const ProjectionGradient gradient(master_, point.master, p);
    for (unsigned int i = 0; i < 2; ++i)
    {
      add_slave(3 + i, gradient.point[i]);
      for (unsigned int n = 0; n < local_.n_master; ++n)
        result.block<1, 3>(3 + i, 3 * (local_.n_slave + n)) += eigen(gradient.node[i][n]);
    }
    return result;
  }

  FaceVariation::Row
  FaceVariation::fixed_element_gradient(const FaceShape &shape, const double xi, const double eta) const
  {
    return element_gradient<Row>(shape, xi, eta, Gradient(Gradient::Zero(n_coordinates, 3 * local_.size())));
  }

  void FaceVariation::add_all_points()
  {
    if (face_.trace.places.empty())
      add_fixed_points();
    else if (slave_.degree() == 1)
      add_segments<24>();
    else
      add_segments<54>();
  }
} // namespace Nodus
