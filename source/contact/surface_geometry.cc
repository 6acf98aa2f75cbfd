#include "contact/surface_geometry.h"

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Least length of an averaged normal in the plane of symmetry of its node, before it is made a unit vector.
    constexpr double in_plane = 0.5;
    /// Width of the strips along the edges of a face in which its normal turns into the averaged one, in faces.
    constexpr double edge_strip = 0.1;
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
    }
    else
      for (const SurfaceFace &face : faces)
        for (const unsigned int n : face.nodes)
          points_.push_back(positions[n]);
    find_powers();
  }

  void SurfaceGeometry::find_powers()
  {
    powers_.reserve(faces_.size());
    for (unsigned int f = 0; f < faces_.size(); ++f)
      powers_.emplace_back(shape_degree_,
                           [points = shape_points(f)](const unsigned int n) { return Vector3(points[n]); });
  }

  double SurfaceGeometry::bulge() const
  {
    const unsigned int last = degree_ * (degree_ + 2); // node of a face
    double             rise = 0.;
    for (unsigned int f = 0; f < faces_.size(); ++f)
      for (const auto &[a, b] :
           {std::make_pair(0u, degree_), {last - degree_, last}, {0u, last - degree_}, {degree_, last}})
      {
        const Vector3 chord = positions_[faces_[f].nodes[b]] - positions_[faces_[f].nodes[a]];
        rise                = std::max(rise, std::abs(chord * (nodal_normal(f, b) - nodal_normal(f, a))));
      }
    return rise / (8. * degree_ * degree_);
  }

  dealii::Tensor<2, dim> cross_matrix(const Vector3 &v)
  {
    return dealii::Tensor<2, dim>({{0., -v[2], v[1]}, {v[2], 0., -v[0]}, {-v[1], v[0], 0.}});
  }

  dealii::Tensor<2, dim> unit_derivative(const Vector3 &v)
  {
    const double           norm   = v.norm();
    dealii::Tensor<2, dim> result = -1. / (norm * norm * norm) * dealii::outer_product(v, v);
    for (unsigned int c = 0; c < dim; ++c)
      result[c][c] += 1. / norm;
    return result;
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
    weighted_.resize(unit_.size());
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
        const FaceGeometry geometry(faces_[f], node_shapes_[n], positions_);
        const Vector3      area = faces_[f].orientation * geometry.area_vector();
        const unsigned int here = f * n_face_nodes + n;
        unit_[here]             = area / area.norm();
        weighted_[here] =
            faces_[f].normal_share[n] / (geometry.d_xi.norm_square() * geometry.d_eta.norm_square()) * area;
        occurrence_[next[faces_[f].nodes[n]]++] = here;
      }

    nodal_normals_.resize(unit_.size());
    for (unsigned int f = 0; f < faces_.size(); ++f)
      for (unsigned int n = 0; n < n_face_nodes; ++n)
      {
        const unsigned int own  = f * n_face_nodes + n;
        const Vector3      hung = interpolated_direction(f, n);
        nodal_normals_[own]     = hung == Vector3() ? averaged_unit(faces_[f].nodes[n], own) : hung / hung.norm();
      }
  }

  template <typename Function>
  void SurfaceGeometry::for_faces(const unsigned int node, const unsigned int own, const Function &g) const // eq. P6
  {
    for (unsigned int i = start_[node]; i < start_[node + 1]; ++i)
      if (const Fading fading = belongs_to_surface(unit_[occurrence_[i]], unit_[own]); fading.part > 0.)
        g(occurrence_[i], fading);
  }

  Vector3 SurfaceGeometry::sum_of_normals(const unsigned int node, const unsigned int own) const
  {
    Vector3 sum;
    for_faces(
        node, own, [&](const unsigned int other, const Fading &fading) { sum += fading.part * weighted_[other]; });
    return sum;
  }

  Vector3 SurfaceGeometry::averaged_unit(const unsigned int node, const unsigned int own) const
  {
    Vector3 sum = sum_of_normals(node, own);
    if (sum == Vector3())
      return sum;
    sum /= sum.norm();
    if (on_symmetry_plane(node, sum))
    {
      for (unsigned int c = 0; c < dim; ++c)
        if (fixed_[node][c])
          sum[c] = 0.;
      sum /= sum.norm();
    }
    return sum;
  }

  Vector3 SurfaceGeometry::interpolated_direction(const unsigned int f, const unsigned int n) const
  {
    const auto *const hung = faces_[f].follower(n);
    Vector3           sum;
    for (unsigned int m = 0; hung && m < hung->masters.size(); ++m)
    {
      const Vector3 normal = averaged_unit(hung->masters[m].first, f * node_shapes_.size() + n);
      if (normal == Vector3()) // beyond a sharp edge
        return normal;
      sum += hung->masters[m].second * normal;
    }
    return sum;
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
    const unsigned int own  = f * node_shapes_.size() + n;
    const Vector3      hung = interpolated_direction(f, n);
    if (hung == Vector3())
      add_unit_derivative(faces_[f].nodes[n], own, dealii::unit_symmetric_tensor<dim>(), derivative);
    else
      for (const auto &[master, weight] : faces_[f].follower(n)->masters)
        add_unit_derivative(master, own, weight * unit_derivative(hung), derivative);
  }

  void SurfaceGeometry::add_unit_derivative(const unsigned int            node,
                                            const unsigned int            own,
                                            const dealii::Tensor<2, dim> &factor,
                                            std::vector<NodeDerivative>  &derivative) const
  {
    const Vector3          sum     = sum_of_normals(node, own);
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
    add_sum_derivative(node, own, factor * to_unit, derivative);
  }

  void SurfaceGeometry::add_component_derivative(const unsigned int           at,
                                                 const Vector3               &along,
                                                 const Vector3               &direction,
                                                 std::vector<NodeDerivative> &derivative) const
  {
    const SurfaceFace &face  = faces_[at / node_shapes_.size()];
    const FaceShape   &shape = node_shapes_[at % node_shapes_.size()];
    const FaceGeometry geometry(face, shape, positions_);
    const Vector3      to_area = face.orientation * (unit_derivative(geometry.area_vector()) * along);
    for (unsigned int m = 0; m < shape.n; ++m)
      if (shape.d_xi[m] != 0. || shape.d_eta[m] != 0.)
        add(derivative,
            face.nodes[m],
            dealii::outer_product(direction,
                                  to_area * (shape.d_eta[m] * cross_matrix(geometry.d_xi) -
                                             shape.d_xi[m] * cross_matrix(geometry.d_eta))));
  }

  void SurfaceGeometry::add_sum_derivative(const unsigned int            node,
                                           const unsigned int            own,
                                           const dealii::Tensor<2, dim> &factor,
                                           std::vector<NodeDerivative>  &derivative) const
  {
    for_faces(node,
              own,
              [&](const unsigned int other, const Fading &fading)
              {
                if (fading.slope > 0.)
                {
                  const Vector3 direction = fading.slope * (factor * weighted_[other]);
                  add_component_derivative(other, unit_[own], direction, derivative);
                  add_component_derivative(own, unit_[other], direction, derivative);
                }
                const SurfaceFace &face  = faces_[other / node_shapes_.size()];
                const FaceShape   &shape = node_shapes_[other % node_shapes_.size()];
                const FaceGeometry geometry(face, shape, positions_);
                const Vector3     &a = geometry.d_xi, &b = geometry.d_eta;
                const double scale = fading.part * face.normal_share[other % node_shapes_.size()] * face.orientation /
                                     (a.norm_square() * b.norm_square());
                const Vector3 normal = scale * geometry.area_vector();
                const auto    to_a = -scale * cross_matrix(b) - 2. / a.norm_square() * dealii::outer_product(normal, a);
                const auto    to_b = scale * cross_matrix(a) - 2. / b.norm_square() * dealii::outer_product(normal, b);
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

  Vector3 SurfaceGeometry::normal(const unsigned int f, const double xi, const double eta) const
  {
    const Vector3 area = faces_[f].orientation * at(f, xi, eta).area_vector();
    return area / area.norm();
  }

  Vector3 SurfaceGeometry::averaged_normal(const unsigned int f, const double xi, const double eta) const
  {
    return averaged_normal(f, FaceShape(degree_, xi, eta));
  }

  Vector3 SurfaceGeometry::averaged_normal(const unsigned int f, const FaceShape &shape) const
  {
    Vector3 normal;
    for (unsigned int n = 0; n < shape.n; ++n)
      normal += shape.value[n] * nodal_normal(f, n);
    return normal / normal.norm();
  }

  double SurfaceGeometry::edge_part(const double xi, const double eta, const Rim &rim)
  {
    const double distance[4] = {xi, 1. - xi, eta, 1. - eta};
    double       nearest     = edge_strip;
    for (unsigned int e = 0; e < 4; ++e)
      if (!rim[e])
        nearest = std::min(nearest, distance[e]);
    return std::min(1., 1. - nearest / edge_strip);
  }

  Vector3 SurfaceGeometry::facet_normal(const unsigned int f, const double xi, const double eta, const Rim &rim) const
  {
    const double part = edge_part(xi, eta, rim);
    if (part == 0.)
      return normal(f, xi, eta);
    const Vector3 sum = part * averaged_normal(f, xi, eta) + (1. - part) * normal(f, xi, eta);
    return sum / sum.norm();
  }
} // namespace Nodus
