#include "contact/surface_geometry.h"

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

// Faces of degree 1 as quadratic ones whose edges are circular arcs.

namespace Nodus
{
  namespace
  {
    /// Corners of the edges of a face, and their middles as nodes of the quadratic face.
    constexpr unsigned int edges[4][3] = {{0, 1, 1}, {0, 2, 3}, {1, 3, 5}, {2, 3, 7}};
    /// The corners as nodes of the quadratic face.
    constexpr unsigned int corners[4] = {0, 2, 6, 8};

    /// The arc over a chord that meets these normals at its ends: it turns by asin(rise / length) to either end's
    /// tangent.
    struct Arc
    {
      Arc(const Vector3 &chord_, const Vector3 &normal_a, const Vector3 &normal_b)
          : chord(chord_)
          , sum(normal_a + normal_b)
          , bend(normal_b - normal_a)
          , length(chord.norm())
          , sine(std::clamp(0.5 * (chord * bend) / length, -0.7, 0.7))
          , angle(std::asin(sine))
          , half_tangent(std::tan(0.5 * angle))
          // sagitta = length/2 tan(angle/2), sin(angle) = q/length, q = chord . bend / 2
          , sagitta(0.5 * length * half_tangent)
      {
      }
      /// How the middle rises above the chord.
      Vector3 rise() const
      {
        return sagitta * (sum / sum.norm());
      }
      Vector3 chord, sum, bend;
      double  length, sine, angle, half_tangent, sagitta;
    };

    /// Derivatives of the rise.
    struct VariedArc
    {
      explicit VariedArc(const Arc &arc)
      {
        const Vector3 m         = arc.sum / arc.sum.norm();
        const double  to_q      = 0.25 * (1. + arc.half_tangent * arc.half_tangent) / std::cos(arc.angle);
        const double  to_length = 0.5 * arc.half_tangent - to_q * arc.sine;
        to_chord                = dealii::outer_product(m, 0.5 * to_q * arc.bend + to_length / arc.length * arc.chord);
        const auto turn         = arc.sagitta * unit_derivative(arc.sum);
        const auto bending      = 0.5 * to_q * dealii::outer_product(m, arc.chord);
        to_normal_a             = turn - bending;
        to_normal_b             = turn + bending;
      }
      dealii::Tensor<2, dim> to_chord, to_normal_a, to_normal_b;
    };

    const dealii::Tensor<2, dim> identity = dealii::unit_symmetric_tensor<dim>();
  } // namespace

  const SurfaceFace::Follower *SurfaceGeometry::on_larger_edge(const unsigned int f, const unsigned int n) const
  {
    const auto *const hung = faces_[f].follower(n);
    return hung && hung->masters.size() == 2 ? hung : nullptr;
  }

  Vector3 SurfaceGeometry::end_normal(const unsigned int f, const unsigned int n, const unsigned int master) const
  {
    const Vector3 normal = averaged_unit(master, 4 * f + n);
    return normal == Vector3() ? unit_[4 * f + n] : normal;
  }

  Vector3 SurfaceGeometry::corner_offset(const unsigned int f, const unsigned int n) const
  {
    const auto *const hung = on_larger_edge(f, n);
    if (!hung)
      return Vector3();
    const unsigned int a = hung->masters[0].first, b = hung->masters[1].first;
    return Arc(positions_[b] - positions_[a], end_normal(f, n, a), end_normal(f, n, b)).rise();
  }

  bool SurfaceGeometry::is_half(const unsigned int f, const unsigned int end, const unsigned int other) const
  {
    const auto *const hung = on_larger_edge(f, end);
    return hung &&
           (hung->masters[0].first == faces_[f].nodes[other] || hung->masters[1].first == faces_[f].nodes[other]);
  }

  /// Half an edge of a larger face is half of that edge's parabola.
  Vector3 SurfaceGeometry::middle_offset(const unsigned int f, const unsigned int a, const unsigned int b) const
  {
    for (const auto &[end, other] : {std::make_pair(a, b), std::make_pair(b, a)})
      if (is_half(f, end, other))
        return 0.75 * corner_offset(f, end);
    if (faces_[f].hanging.empty() && nodal_normal(f, a) == nodal_normal(f, b)) // as on most of what is flat
      return Vector3();
    const Vector3 offset_a = corner_offset(f, a), offset_b = corner_offset(f, b);
    const Vector3 chord = positions_[faces_[f].nodes[b]] + offset_b - positions_[faces_[f].nodes[a]] - offset_a;
    return 0.5 * (offset_a + offset_b) + Arc(chord, nodal_normal(f, a), nodal_normal(f, b)).rise();
  }

  void SurfaceGeometry::smooth()
  {
    points_.resize(9 * faces_.size());
    offsets_.reserve(faces_.size());
    std::vector<FaceShape> facet; // at the nine points
    for (unsigned int n = 0; n < 9; ++n)
      facet.emplace_back(degree_, 0.5 * (n % 3), 0.5 * (n / 3));
    for (unsigned int f = 0; f < faces_.size(); ++f)
    {
      Point      *x     = points_.data() + 9 * f;
      const auto &nodes = faces_[f].nodes;
      for (unsigned int n = 0; n < 4; ++n)
        x[corners[n]] = positions_[nodes[n]] + corner_offset(f, n);
      for (const auto &[a, b, m] : edges)
        x[m] = positions_[nodes[a]] + 0.5 * (positions_[nodes[b]] - positions_[nodes[a]]) + middle_offset(f, a, b);
      // eight-node face
      x[4] = Point(0.5 * (Vector3(x[1]) + Vector3(x[3]) + Vector3(x[5]) + Vector3(x[7])) -
                   0.25 * (Vector3(x[0]) + Vector3(x[2]) + Vector3(x[6]) + Vector3(x[8])));
      offsets_.emplace_back(
          2, [&](const unsigned int n) { return x[n] - FaceGeometry(faces_[f], facet[n], positions_).x; });
    }
  }

  std::array<double, 8> SurfaceGeometry::offset_functions(const std::array<double, 9> &shape)
  {
    std::array<double, 8> value; // the centre takes half of each middle, less a quarter of each corner
    for (unsigned int n = 0; n < 4; ++n)
    {
      value[n]     = shape[edges[n][2]] + 0.5 * shape[4];
      value[4 + n] = shape[corners[n]] - 0.25 * shape[4];
    }
    return value;
  }

  void SurfaceGeometry::corner_offset_derivative(const unsigned int            f,
                                                 const unsigned int            n,
                                                 const dealii::Tensor<2, dim> &factor,
                                                 std::vector<NodeDerivative>  &derivative) const
  {
    const auto *const hung = on_larger_edge(f, n);
    if (!hung)
      return;
    const unsigned int own = 4 * f + n, a = hung->masters[0].first, b = hung->masters[1].first;
    const VariedArc    arc({positions_[b] - positions_[a], end_normal(f, n, a), end_normal(f, n, b)});
    add(derivative, b, factor * arc.to_chord);
    add(derivative, a, -factor * arc.to_chord);
    if (averaged_unit(a, own) != Vector3())
      add_unit_derivative(a, own, factor * arc.to_normal_a, derivative);
    if (averaged_unit(b, own) != Vector3())
      add_unit_derivative(b, own, factor * arc.to_normal_b, derivative);
  }

  std::vector<NodeDerivative> SurfaceGeometry::offset_derivative(const unsigned int f, const unsigned int part) const
  {
    std::vector<NodeDerivative> derivative;
    if (part >= 4)
    {
      corner_offset_derivative(f, part - 4, identity, derivative);
      return derivative;
    }
    const unsigned int a = edges[part][0], b = edges[part][1], node_a = faces_[f].nodes[a], node_b = faces_[f].nodes[b];
    for (const auto &[end, other] : {std::make_pair(a, b), std::make_pair(b, a)})
      if (is_half(f, end, other))
      {
        corner_offset_derivative(f, end, 0.75 * identity, derivative);
        return derivative;
      }
    const Vector3   chord = positions_[node_b] + corner_offset(f, b) - positions_[node_a] - corner_offset(f, a);
    const VariedArc arc({chord, nodal_normal(f, a), nodal_normal(f, b)});
    add(derivative, node_b, arc.to_chord);
    add(derivative, node_a, -arc.to_chord);
    corner_offset_derivative(f, a, 0.5 * identity - arc.to_chord, derivative);
    corner_offset_derivative(f, b, 0.5 * identity + arc.to_chord, derivative);
    for (const auto &[n, factor] : {std::make_pair(a, arc.to_normal_a), std::make_pair(b, arc.to_normal_b)})
    {
      std::vector<NodeDerivative> normal;
      nodal_normal_derivative(f, n, normal);
      for (const NodeDerivative &d : normal)
        add(derivative, d.node, factor * d.value);
    }
    return derivative;
  }

  Vector3 SurfaceGeometry::offset(const unsigned int f, const double xi, const double eta) const
  {
    if (shape_degree_ == degree_)
      return Vector3();
    return FacePowers::vector(offsets_[f].tangents<2>(xi, eta).x);
  }
} // namespace Nodus
