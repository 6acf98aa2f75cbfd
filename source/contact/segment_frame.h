#ifndef nodus_contact_segment_frame_h
#define nodus_contact_segment_frame_h

#include "contact/segments.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <utility>

namespace Nodus
{
  using Plane2 = Eigen::Vector2d;

  inline double cross(const Plane2 &a, const Plane2 &b)
  {
    return a[0] * b[1] - a[1] * b[0];
  }
  inline Eigen::RowVector3d eigen(const Vector3 &v)
  {
    return {v[0], v[1], v[2]};
  }
  inline Plane2 plane_point(const dealii::Point<2> &p)
  {
    return {p[0], p[1]};
  }

  /// The plane of a slave cell and how it tilts; motions in it leave its origin and its spin out, on which nothing
  /// depends. For faces that have this many components of nodes together, slave nodes first.
  template <int columns>
  struct SegmentFrame
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
      const Vector3 twice_area = cross_of_diagonals(corner);
      const auto    node       = [&](const unsigned int at) { return cell_node(slave.degree(), cell, at); };
      area                     = 0.5 * twice_area.norm();
      for (unsigned int i = 0; i < 2; ++i)
        add_change(corner, slave.face(f).orientation / (2. * area) * plane.axis[i], node, tilt.row(i));
      add_change(corner, 0.5 / twice_area.norm() * twice_area, node, cell_area.row(0));
    }
    /// The master cell of a polygon, and how the part changes that its points count with: with the cosine of the angle
    /// between both normals (eq. J8 and G35).
    void set_master(const SurfaceGeometry &master, const SegmentTrace::Polygon &polygon, unsigned int n_slave);

    /// Twice the area of a cell, as a vector.
    static Vector3 cross_of_diagonals(const std::array<Point, 4> &corner)
    {
      return dealii::cross_product_3d(corner[2] - corner[0], corner[3] - corner[1]);
    }
    /// Adds to @p row how the component of that along @p v changes; @p node: the one at a corner.
    template <typename Node, typename RowOfNodes>
    static void add_change(const std::array<Point, 4> &corner, const Vector3 &v, const Node &node, RowOfNodes &&row)
    {
      const Eigen::RowVector3d first  = eigen(dealii::cross_product_3d(corner[3] - corner[1], v)),
                               second = eigen(dealii::cross_product_3d(v, corner[2] - corner[0]));
      for (const auto &[at, value] : {std::make_pair(2u, first), std::make_pair(3u, second)})
      {
        row.template segment<3>(3 * node(at)) += value;
        row.template segment<3>(3 * node(at - 2)) -= value;
      }
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
    Row                         log_part;       ///< of the part that it counts with
  };

  template <int columns>
  void SegmentFrame<columns>::set_master(const SurfaceGeometry       &master,
                                         const SegmentTrace::Polygon &polygon,
                                         const unsigned int           n_slave)
  {
    master_corner            = corners(master, polygon.master, polygon.master_cell);
    log_part                 = Row::Zero();
    const double  sign       = master.face(polygon.master).orientation;
    const Vector3 twice_area = cross_of_diagonals(master_corner), normal = sign / twice_area.norm() * twice_area;
    const double  cosine = -(normal * plane.normal);
    const Fading  faces  = facing(cosine);
    if (faces.slope == 0. && polygon.near_rate == 0.)
      return;
    // of the height, (middle of the slave cell - that of the master cell) . normal/cosine, too
    const Vector3 apart  = cell_middle(corner) - cell_middle(master_corner);
    const double  height = apart * normal / cosine, near_rate = polygon.near_rate / cosine,
                 rate   = faces.slope / faces.part - near_rate * height;
    const Plane2  along = in_plane(normal);
    const Vector3 turns = -rate * (plane.normal + cosine * normal) + near_rate * (apart - (apart * normal) * normal);
    const auto    node  = [&](const unsigned int at)
    { return n_slave + cell_node(master.degree(), polygon.master_cell, at); };
    log_part -= rate * (along[0] * tilt.row(0) + along[1] * tilt.row(1));
    add_change(master_corner, sign / twice_area.norm() * turns, node, log_part);
    for (unsigned int at = 0; at < 4; ++at)
    {
      log_part.template segment<3>(3 * cell_node(master.degree(), polygon.cell, at)) +=
          0.25 * near_rate * eigen(normal);
      log_part.template segment<3>(3 * node(at)) -= 0.25 * near_rate * eigen(normal);
    }
  }

  template <int columns>
  typename SegmentFrame<columns>::Row2 SegmentFrame<columns>::motion(const SegmentTrace::Polygon &polygon,
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
    constexpr double parallel = 1e-6; // edges without a crossing that follows both: matching faces
    const double     sine     = cross(e, d);
    if (std::abs(sine) < parallel * e.norm() * d.norm())
      return result;
    Row2 across = -result;
    vertex(false, origin.slave[0], 1. - on_slave, across);
    vertex(false, origin.slave[1], on_slave, across);
    const Row slide = (e[0] * across.row(1) - e[1] * across.row(0)) / sine;
    result += d * slide;
    return result;
  }
} // namespace Nodus

#endif
