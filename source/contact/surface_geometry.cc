#include <nodus/contact/surface_geometry.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Faces that meet at a larger angle (cosine below this) have an edge between them, not a smooth surface.
    constexpr double smooth_cosine = 0.70710678;
    /// Least length of an averaged normal in the plane of symmetry of its node, before it is made a unit vector.
    constexpr double in_plane = 0.5;
  } // namespace

  SurfaceGeometry::SurfaceGeometry(const std::vector<SurfaceFace>           &faces,
                                   const unsigned int                        degree,
                                   const std::vector<Point>                 &positions,
                                   const std::vector<std::array<bool, dim>> &fixed,
                                   const ContactPairParameters::Surface      surface)
      : faces_(faces)
      , positions_(positions)
      , degree_(degree)
      , shape_degree_(degree)
  {
    average_normals(fixed);
    if (surface == ContactPairParameters::Surface::smoothed && degree == 1)
    {
      shape_degree_ = 2;
      smooth();
      return;
    }
    for (const SurfaceFace &face : faces)
      for (const unsigned int n : face.nodes)
        points_.push_back(positions[n]);
  }

  void SurfaceGeometry::average_normals(const std::vector<std::array<bool, dim>> &fixed)
  {
    const unsigned int     n_face_nodes = (degree_ + 1) * (degree_ + 1);
    std::vector<FaceShape> shapes;
    for (unsigned int n = 0; n < n_face_nodes; ++n)
      shapes.emplace_back(degree_, 1. / degree_ * (n % (degree_ + 1)), 1. / degree_ * (n / (degree_ + 1)));

    // Normal and weighted normal of every face at each of its nodes, and where each surface node occurs.
    std::vector<Vector3>      unit(faces_.size() * n_face_nodes), weighted(unit.size());
    std::vector<unsigned int> start(positions_.size() + 1, 0), occurrence(unit.size());
    for (const SurfaceFace &face : faces_)
      for (const unsigned int n : face.nodes)
        ++start[n + 1];
    for (unsigned int i = 0; i < positions_.size(); ++i)
      start[i + 1] += start[i];
    std::vector<unsigned int> next(start.begin(), start.end() - 1);
    for (unsigned int f = 0; f < faces_.size(); ++f)
      for (unsigned int n = 0; n < n_face_nodes; ++n)
      {
        const FaceGeometry geometry(faces_[f], shapes[n], positions_);
        const Vector3      area                = faces_[f].orientation * geometry.area_vector();
        const unsigned int here                = f * n_face_nodes + n;
        unit[here]                             = area / area.norm();
        weighted[here]                         = area / (geometry.d_xi.norm_square() * geometry.d_eta.norm_square());
        occurrence[next[faces_[f].nodes[n]]++] = here;
      }

    nodal_normals_.resize(unit.size());
    for (unsigned int f = 0; f < faces_.size(); ++f)
      for (unsigned int n = 0; n < n_face_nodes; ++n)
      {
        const unsigned int here = f * n_face_nodes + n, node = faces_[f].nodes[n];
        Vector3            normal;
        for (unsigned int i = start[node]; i < start[node + 1]; ++i)
          if (unit[occurrence[i]] * unit[here] > smooth_cosine)
            normal += weighted[occurrence[i]];
        normal /= normal.norm();

        Vector3      symmetric = normal;
        unsigned int held      = 0;
        for (unsigned int c = 0; c < dim; ++c)
          if (fixed[node][c])
          {
            ++held;
            symmetric[c] = 0.;
          }
        if (held > 0 && held < dim && symmetric.norm() > in_plane)
          normal = symmetric / symmetric.norm();
        nodal_normals_[here] = normal;
      }
  }

  void SurfaceGeometry::smooth()
  {
    // Middle of the edge from a to b: the chord turns by asin(rise / length) to either end's tangent.
    const auto middle = [](const Point &a, const Point &b, const Vector3 &normal_a, const Vector3 &normal_b)
    {
      const Vector3 chord   = b - a;
      const double  sine    = 0.5 * (chord * normal_b - chord * normal_a) / chord.norm();
      const Vector3 sum     = normal_a + normal_b;
      const double  sagitta = 0.5 * chord.norm() * std::tan(0.5 * std::asin(std::clamp(sine, -0.7, 0.7)));
      return Point(a + 0.5 * chord + sagitta * sum / sum.norm());
    };

    points_.resize(9 * faces_.size());
    for (unsigned int f = 0; f < faces_.size(); ++f)
    {
      const auto corner = [&](const unsigned int n) { return positions_[faces_[f].nodes[n]]; };
      Point     *x      = points_.data() + 9 * f;
      // corner n of the face is node 2 (n % 2) + 6 (n / 2) of the quadratic one
      for (unsigned int n = 0; n < 4; ++n)
        x[2 * (n % 2) + 6 * (n / 2)] = corner(n);
      const unsigned int edges[4][3] = {{0, 1, 1}, {0, 2, 3}, {1, 3, 5}, {2, 3, 7}};
      for (const auto &[a, b, m] : edges)
        x[m] = middle(corner(a), corner(b), nodal_normal(f, a), nodal_normal(f, b));
      // eight-node face
      x[4] = Point(0.5 * (Vector3(x[1]) + Vector3(x[3]) + Vector3(x[5]) + Vector3(x[7])) -
                   0.25 * (Vector3(x[0]) + Vector3(x[2]) + Vector3(x[6]) + Vector3(x[8])));
    }
  }

  Vector3 SurfaceGeometry::normal(const unsigned int f, const double xi, const double eta) const
  {
    const Vector3 area = faces_[f].orientation * at(f, xi, eta).area_vector();
    return area / area.norm();
  }

  Vector3 SurfaceGeometry::averaged_normal(const unsigned int f, const double xi, const double eta) const
  {
    const FaceShape shape(degree_, xi, eta);
    Vector3         normal;
    for (unsigned int n = 0; n < shape.n; ++n)
      normal += shape.value[n] * nodal_normal(f, n);
    return normal / normal.norm();
  }

  Vector3 SurfaceGeometry::offset(const unsigned int f, const double xi, const double eta) const
  {
    if (shape_degree_ == degree_)
      return Vector3();
    return at(f, xi, eta).x - FaceGeometry(faces_[f], FaceShape(degree_, xi, eta), positions_).x;
  }
} // namespace Nodus
