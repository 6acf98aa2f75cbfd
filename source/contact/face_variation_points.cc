#include "contact/face_variation.h"
#include "contact/segment_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

// How the integration points of a face move: with the corners of the overlaps, or sliding on the master.

namespace Nodus
{
  namespace
  {
    /// Corners of an overlap that are in a line span triangles without area. Their points have next to no weight; this
    /// bounds the derivative of its logarithm.
    constexpr double smallest_sine = 1e-10;

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
        d_coverage_.fraction.middleCols<3>(3 * i) -=
            face_.coverage.fraction * frame.cell_area.template segment<3>(3 * i);
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
        frame->set_master(master_, polygon, local_.n_slave);
        for (unsigned int i = 0; i < polygon.n; ++i)
          frame->corners_motion[i] = frame->motion(polygon, i, degree, local_.n_slave);
      }
      add_point(face_.points[q], segment_gradient<columns>(polygon, place, face_.points[q], *frame));
    }
    flush();
    d_coverage_.fraction /= face_area;
    d_coverage_.counted /= face_area;
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
            std::max(twice_area,
                     smallest_sine * (a.squaredNorm() + b.squaredNorm()) + std::numeric_limits<double>::min()) +
        frame.log_part;
    if (face_.dual_slope() > 0. || face_.coverage.counted < 1.)
    {
      // f = S^2/(A T), counted = T/S, with the sums S and T of the areas times parts, and squares of parts
      const auto [fraction, counted] = face_.coverage;
      const double area = place.part * twice_area * rule.weight(place.q) / counted, relative = place.part / counted;
      const Row    squared = relative * (log_area + frame.log_part);
      for (unsigned int l = 0; l < local_.size(); ++l)
      {
        const unsigned int to = 3 * local_.place[l];
        d_coverage_.fraction.middleCols<3>(to) +=
            area * (2. * log_area.template segment<3>(3 * l) - squared.template segment<3>(3 * l));
        d_coverage_.counted.middleCols<3>(to) +=
            area * counted / fraction * (squared.template segment<3>(3 * l) - log_area.template segment<3>(3 * l));
      }
    }

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
      d_coverage_.fraction.middleCols<3>(3 * local_.place[l]) += point.weight * fading.segment<3>(3 * l);
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

  std::array<FaceVariation::Nodal, 3> FaceVariation::hats(const MortarPoint &point) const
  {
    constexpr double step = 1e-6; // they are bilinear
    const auto       at   = [&](const double dx, const double dy) -> Nodal
    { return of_slaves(AveragedJump::hats(slave_.degree(), point.xi + dx, point.eta + dy)); };
    return {{at(0., 0.), (at(step, 0.) - at(-step, 0.)) / (2. * step), (at(0., step) - at(0., -step)) / (2. * step)}};
  }

  void FaceVariation::add_normals(const MortarPoint                   &point,
                                  const double                         weight,
                                  const Nodal                         &hat,
                                  const Nodal                         *d_hat,
                                  const Eigen::Ref<const AnyGradient> &gradient)
  {
    std::vector<unsigned int> nodes;
    for (const unsigned int place : local_.place)
      nodes.push_back(nodes_[place]);
    normals_->add(point, weight, hat, d_hat, gradient, nodes);
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
