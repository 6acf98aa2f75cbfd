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

    /// Corners of the edges of a face, and their middles as nodes of the quadratic face.
    constexpr unsigned int edges[4][3] = {{0, 1, 1}, {0, 2, 3}, {1, 3, 5}, {2, 3, 7}};

    /// [v] with [v] w = v x w.
    dealii::Tensor<2, dim> cross_matrix(const Vector3 &v)
    {
      return dealii::Tensor<2, dim>({{0., -v[2], v[1]}, {v[2], 0., -v[0]}, {-v[1], v[0], 0.}});
    }

    /// Derivative of v/|v|.
    dealii::Tensor<2, dim> unit_derivative(const Vector3 &v)
    {
      const double           norm   = v.norm();
      dealii::Tensor<2, dim> result = -1. / (norm * norm * norm) * dealii::outer_product(v, v);
      for (unsigned int c = 0; c < dim; ++c)
        result[c][c] += 1. / norm;
      return result;
    }
  } // namespace

  SurfaceGeometry::SurfaceGeometry(const std::vector<SurfaceFace>           &faces,
                                   const unsigned int                        degree,
                                   const std::vector<Point>                 &positions,
                                   const std::vector<std::array<bool, dim>> &fixed,
                                   const ContactPairParameters::Surface      surface)
      : faces_(faces)
      , positions_(positions)
      , fixed_(fixed)
      , degree_(degree)
      , shape_degree_(degree)
  {
    average_normals();
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

  void add(std::vector<NodeDerivative> &derivative, const unsigned int node, const dealii::Tensor<2, dim> &value)
  {
    for (NodeDerivative &d : derivative)
      if (d.node == node)
      {
        d.value += value;
        return;
      }
    derivative.push_back({node, value});
  }

  void SurfaceGeometry::average_normals()
  {
    const unsigned int n_face_nodes = (degree_ + 1) * (degree_ + 1);
    for (unsigned int n = 0; n < n_face_nodes; ++n)
      node_shapes_.emplace_back(degree_, 1. / degree_ * (n % (degree_ + 1)), 1. / degree_ * (n / (degree_ + 1)));

    unit_.resize(faces_.size() * n_face_nodes);
    occurrence_.resize(unit_.size());
    start_.assign(positions_.size() + 1, 0);
    for (const SurfaceFace &face : faces_)
      for (const unsigned int n : face.nodes)
        ++start_[n + 1];
    for (unsigned int i = 0; i < positions_.size(); ++i)
      start_[i + 1] += start_[i];
    std::vector<unsigned int> next(start_.begin(), start_.end() - 1);
    for (unsigned int f = 0; f < faces_.size(); ++f)
      for (unsigned int n = 0; n < n_face_nodes; ++n)
      {
        const Vector3 area = faces_[f].orientation * FaceGeometry(faces_[f], node_shapes_[n], positions_).area_vector();
        const unsigned int here                 = f * n_face_nodes + n;
        unit_[here]                             = area / area.norm();
        occurrence_[next[faces_[f].nodes[n]]++] = here;
      }

    nodal_normals_.resize(unit_.size());
    for (unsigned int f = 0; f < faces_.size(); ++f)
      for (unsigned int n = 0; n < n_face_nodes; ++n)
      {
        const unsigned int node   = faces_[f].nodes[n];
        Vector3            normal = averaged_direction(f, n);
        normal /= normal.norm();
        if (on_symmetry_plane(node, normal))
        {
          for (unsigned int c = 0; c < dim; ++c)
            if (fixed_[node][c])
              normal[c] = 0.;
          normal /= normal.norm();
        }
        nodal_normals_[f * n_face_nodes + n] = normal;
      }
  }

  template <typename Function>
  void SurfaceGeometry::for_faces(const unsigned int node, const Vector3 &unit, const Function &g) const
  {
    const unsigned int n_face_nodes = node_shapes_.size();
    for (unsigned int i = start_[node]; i < start_[node + 1]; ++i)
      if (unit_[occurrence_[i]] * unit > smooth_cosine)
        g(faces_[occurrence_[i] / n_face_nodes], node_shapes_[occurrence_[i] % n_face_nodes]);
  }

  Vector3 SurfaceGeometry::sum_of_normals(const unsigned int node, const Vector3 &unit) const
  {
    Vector3 sum;
    for_faces(node,
              unit,
              [&](const SurfaceFace &face, const FaceShape &shape)
              {
                const FaceGeometry geometry(face, shape, positions_);
                sum += face.orientation / (geometry.d_xi.norm_square() * geometry.d_eta.norm_square()) *
                       geometry.area_vector();
              });
    return sum;
  }

  Vector3 SurfaceGeometry::averaged_direction(const unsigned int f, const unsigned int n) const
  {
    const Vector3 &unit = unit_[f * node_shapes_.size() + n];
    const auto    *hung = faces_[f].follower(n);
    Vector3        sum;
    for (unsigned int m = 0; hung && m < hung->masters.size(); ++m)
    {
      const Vector3 normal = sum_of_normals(hung->masters[m].first, unit);
      if (normal.norm() == 0.) // beyond a sharp edge
        return sum_of_normals(faces_[f].nodes[n], unit);
      sum += hung->masters[m].second / normal.norm() * normal;
    }
    return hung ? sum : sum_of_normals(faces_[f].nodes[n], unit);
  }

  bool SurfaceGeometry::on_symmetry_plane(const unsigned int node, const Vector3 &normal) const
  {
    unsigned int held = 0;
    double       free = 0.; // squared length of the normal in the plane
    for (unsigned int c = 0; c < dim; ++c)
    {
      held += fixed_[node][c];
      free += fixed_[node][c] ? 0. : normal[c] * normal[c];
    }
    return held > 0 && held < dim && free > in_plane * in_plane;
  }

  void SurfaceGeometry::nodal_normal_derivative(const unsigned int           f,
                                                const unsigned int           n,
                                                std::vector<NodeDerivative> &derivative) const
  {
    const unsigned int     node    = faces_[f].nodes[n];
    const Vector3         &unit    = unit_[f * node_shapes_.size() + n];
    const Vector3          sum     = averaged_direction(f, n);
    dealii::Tensor<2, dim> to_unit = unit_derivative(sum);
    if (on_symmetry_plane(node, sum / sum.norm()))
    {
      Vector3                free = sum;
      dealii::Tensor<2, dim> projector;
      for (unsigned int c = 0; c < dim; ++c)
        if (fixed_[node][c])
          free[c] = 0.;
        else
          projector[c][c] = 1.;
      to_unit = unit_derivative(free) * projector;
    }
    const auto *const hung         = faces_[f].follower(n);
    bool              interpolated = hung;
    for (unsigned int m = 0; interpolated && m < hung->masters.size(); ++m)
      interpolated = sum_of_normals(hung->masters[m].first, unit).norm() > 0.;
    if (!interpolated)
      add_sum_derivative(node, unit, to_unit, derivative);
    else
      for (const auto &[master, weight] : hung->masters)
        add_sum_derivative(master, unit, weight * to_unit * unit_derivative(sum_of_normals(master, unit)), derivative);
  }

  void SurfaceGeometry::add_sum_derivative(const unsigned int            node,
                                           const Vector3                &unit,
                                           const dealii::Tensor<2, dim> &factor,
                                           std::vector<NodeDerivative>  &derivative) const
  {
    for_faces(node,
              unit,
              [&](const SurfaceFace &face, const FaceShape &shape)
              {
                const FaceGeometry geometry(face, shape, positions_);
                const Vector3     &a = geometry.d_xi, &b = geometry.d_eta;
                const double       scale  = face.orientation / (a.norm_square() * b.norm_square());
                const Vector3      normal = scale * geometry.area_vector();
                const auto to_a = -scale * cross_matrix(b) - 2. / a.norm_square() * dealii::outer_product(normal, a);
                const auto to_b = scale * cross_matrix(a) - 2. / b.norm_square() * dealii::outer_product(normal, b);
                for (unsigned int m = 0; m < shape.n; ++m)
                  if (shape.d_xi[m] != 0. || shape.d_eta[m] != 0.)
                    add(derivative, face.nodes[m], factor * (shape.d_xi[m] * to_a + shape.d_eta[m] * to_b));
              });
  }

  void SurfaceGeometry::averaged_normal_derivative(const unsigned int           f,
                                                   const double                 xi,
                                                   const double                 eta,
                                                   std::vector<NodeDerivative> &derivative) const
  {
    const FaceShape shape(degree_, xi, eta);
    Vector3         sum;
    for (unsigned int n = 0; n < shape.n; ++n)
      sum += shape.value[n] * nodal_normal(f, n);
    const dealii::Tensor<2, dim> to_unit = unit_derivative(sum);
    std::vector<NodeDerivative>  nodal;
    for (unsigned int n = 0; n < shape.n; ++n)
      if (shape.value[n] != 0.)
      {
        nodal.clear();
        nodal_normal_derivative(f, n, nodal);
        for (const NodeDerivative &d : nodal)
          add(derivative, d.node, shape.value[n] * to_unit * d.value);
      }
  }

  void SurfaceGeometry::normal_derivative(const unsigned int           f,
                                          const double                 xi,
                                          const double                 eta,
                                          std::vector<NodeDerivative> &derivative) const
  {
    const FaceGeometry           geometry = at(f, xi, eta);
    const FaceShape              shape(degree_, xi, eta);
    const dealii::Tensor<2, dim> to_unit = faces_[f].orientation * unit_derivative(geometry.area_vector());
    for (unsigned int n = 0; n < shape.n; ++n)
      add(derivative,
          faces_[f].nodes[n],
          to_unit * (shape.d_eta[n] * cross_matrix(geometry.d_xi) - shape.d_xi[n] * cross_matrix(geometry.d_eta)));
  }

  namespace
  {
    /// Middle of the edge from a to b: the chord turns by asin(rise / length) to either end's tangent.
    Point edge_middle(const Point &a, const Point &b, const Vector3 &normal_a, const Vector3 &normal_b)
    {
      const Vector3 chord   = b - a;
      const double  sine    = 0.5 * (chord * normal_b - chord * normal_a) / chord.norm();
      const Vector3 sum     = normal_a + normal_b;
      const double  sagitta = 0.5 * chord.norm() * std::tan(0.5 * std::asin(std::clamp(sine, -0.7, 0.7)));
      return Point(a + 0.5 * chord + sagitta * sum / sum.norm());
    }
  } // namespace

  Point SurfaceGeometry::smoothed_corner(const unsigned int f, const unsigned int n) const
  {
    const auto *const hung = faces_[f].follower(n);
    if (!hung || hung->masters.size() != 2)
      return positions_[faces_[f].nodes[n]];
    const Vector3 &unit        = unit_[4 * f + n];
    const auto     unit_normal = [&](const unsigned int node)
    {
      const Vector3 normal = sum_of_normals(node, unit);
      return normal.norm() > 0. ? Vector3(normal / normal.norm()) : unit;
    };
    const unsigned int a = hung->masters[0].first, b = hung->masters[1].first;
    return edge_middle(positions_[a], positions_[b], unit_normal(a), unit_normal(b));
  }

  /// Half an edge of a larger face is half of that edge's parabola.
  Point SurfaceGeometry::smoothed_middle(const unsigned int f, const unsigned int a, const unsigned int b) const
  {
    for (const auto &[end, other] : {std::make_pair(a, b), std::make_pair(b, a)})
      if (const auto *const hung = faces_[f].follower(end); hung && hung->masters.size() == 2)
        for (unsigned int m = 0; m < 2; ++m)
          if (hung->masters[m].first == faces_[f].nodes[other])
            return Point(3. / 8. * Vector3(positions_[hung->masters[m].first]) +
                         3. / 4. * Vector3(smoothed_corner(f, end)) -
                         1. / 8. * Vector3(positions_[hung->masters[1 - m].first]));
    return edge_middle(smoothed_corner(f, a), smoothed_corner(f, b), nodal_normal(f, a), nodal_normal(f, b));
  }

  void SurfaceGeometry::smooth()
  {
    points_.resize(9 * faces_.size());
    for (unsigned int f = 0; f < faces_.size(); ++f)
    {
      Point *x = points_.data() + 9 * f;
      // corner n of the face is node 2 (n % 2) + 6 (n / 2) of the quadratic one
      for (unsigned int n = 0; n < 4; ++n)
        x[2 * (n % 2) + 6 * (n / 2)] = smoothed_corner(f, n);
      for (const auto &[a, b, m] : edges)
        x[m] = smoothed_middle(f, a, b);
      // eight-node face
      x[4] = Point(0.5 * (Vector3(x[1]) + Vector3(x[3]) + Vector3(x[5]) + Vector3(x[7])) -
                   0.25 * (Vector3(x[0]) + Vector3(x[2]) + Vector3(x[6]) + Vector3(x[8])));
    }
  }

  double SurfaceGeometry::edge_function(const unsigned int edge, const double xi, const double eta)
  {
    const FaceShape shape(2, xi, eta); // the centre takes half of each middle
    return shape.value[edges[edge][2]] + 0.5 * shape.value[4];
  }

  std::vector<NodeDerivative> SurfaceGeometry::edge_derivative(const unsigned int f, const unsigned int edge) const
  {
    const unsigned int a = edges[edge][0], b = edges[edge][1];
    const Vector3      chord = positions_[faces_[f].nodes[b]] - positions_[faces_[f].nodes[a]];
    const Vector3     &n_a = nodal_normal(f, a), &n_b = nodal_normal(f, b);
    const Vector3      sum = n_a + n_b, m = sum / sum.norm(), bend = n_b - n_a;
    const double       length = chord.norm(), sine = std::clamp(0.5 * (chord * bend) / length, -0.7, 0.7);
    const double       angle = std::asin(sine), half_tangent = std::tan(0.5 * angle);
    // sagitta = length/2 tan(angle/2), sin(angle) = q/length, q = chord . bend / 2
    const double sagitta   = 0.5 * length * half_tangent;
    const double to_q      = 0.25 * (1. + half_tangent * half_tangent) / std::cos(angle);
    const double to_length = 0.5 * half_tangent - to_q * sine;

    std::vector<NodeDerivative> derivative, nodal;
    const Vector3               to_chord = 0.5 * to_q * bend + to_length / length * chord;
    add(derivative, faces_[f].nodes[b], dealii::outer_product(m, to_chord));
    add(derivative, faces_[f].nodes[a], -dealii::outer_product(m, to_chord));
    const auto turn = sagitta * unit_derivative(sum), bending = 0.5 * to_q * dealii::outer_product(m, chord);
    nodal_normal_derivative(f, a, nodal);
    for (const NodeDerivative &d : nodal)
      add(derivative, d.node, (turn - bending) * d.value);
    nodal.clear();
    nodal_normal_derivative(f, b, nodal);
    for (const NodeDerivative &d : nodal)
      add(derivative, d.node, (turn + bending) * d.value);
    return derivative;
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
