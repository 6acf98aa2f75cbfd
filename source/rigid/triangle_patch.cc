#include "rigid/triangle_patch.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Normals on both sides of an edge whose sine is below this are the same.
    constexpr double same_normal = 1e-6;
    /// Both inner points of a pair are meant this near to the corner between their edges.
    constexpr double at_corner = 1e-14;

    Vector3 unit(const Vector3 &v)
    {
      return v / v.norm();
    }

    /// A function of s and t with its derivatives.
    struct Jet
    {
      double value = 0., s = 0., t = 0., ss = 0., st = 0., tt = 0.;
    };
    Jet operator*(const Jet &a, const Jet &b)
    {
      return {a.value * b.value,
              a.value * b.s + a.s * b.value,
              a.value * b.t + a.t * b.value,
              a.value * b.ss + 2. * a.s * b.s + a.ss * b.value,
              a.value * b.st + a.s * b.t + a.t * b.s + a.st * b.value,
              a.value * b.tt + 2. * a.t * b.t + a.tt * b.value};
    }
    Jet operator*(const double a, const Jet &b)
    {
      return {a * b.value, a * b.s, a * b.t, a * b.ss, a * b.st, a * b.tt};
    }
    Jet operator+(const Jet &a, const Jet &b)
    {
      return {a.value + b.value, a.s + b.s, a.t + b.t, a.ss + b.ss, a.st + b.st, a.tt + b.tt};
    }
    Jet inverse(const Jet &a)
    {
      const double r = 1. / a.value, r2 = r * r, r3 = 2. * r2 * r;
      return {
          r, -r2 * a.s, -r2 * a.t, r3 * a.s * a.s - r2 * a.ss, r3 * a.s * a.t - r2 * a.st, r3 * a.t * a.t - r2 * a.tt};
    }

    /// The control vector that an edge has at its end towards the other end, a third of the edge where that is
    /// straight.
    /// @p other: normal on the other side of the edge.
    Vector3 end_of_edge(const Vector3 &chord, const Vector3 &normal, const Vector3 &other)
    {
      const double  length = chord.norm();
      const Vector3 across = dealii::cross_product_3d(normal, other);
      Vector3       along  = chord - (chord * normal) * normal;
      if (across.norm() > same_normal) // in both tangent planes
        along = across * chord > 0. ? across : -across;
      double cosine = along * chord / (along.norm() * length);
      if (!(cosine > 0.5))
      {
        along  = chord;
        cosine = 1.;
      }
      return 2. * length / (3. * (1. + cosine)) * unit(along);
    }

    /// Edge i of a patch, from corner i to corner j, and what it wants of the inner points.
    struct Edge
    {
      Point                  R[5];      ///< of degree 4
      Vector3                W[3];      ///< a third of the derivative of the cubic
      Point                  inside[2]; ///< inner points near corner i and j
      std::array<Vector3, 2> end;       ///< control vectors

      Edge(const Point &a, const Point &b, const Vector3 &at_a, const Vector3 &at_b)
          : R{a, a + 0.75 * at_a, Point(0.5 * (Vector3(a) + at_a + Vector3(b) + at_b)), b + 0.75 * at_b, b}
          , W{at_a, b + at_b - (a + at_a), -at_b}
          , end{{at_a, at_b}}
      {
      }

      /// @p normal: at the ends; @p inner: control vectors from the ends towards the third corner (eqs. R6 and R7).
      void make_inside(const std::array<Vector3, 2> &normal, const std::array<Vector3, 2> &inner)
      {
        Vector3 A[3];
        A[0]              = unit(dealii::cross_product_3d(normal[0], W[0]));
        A[2]              = unit(dealii::cross_product_3d(normal[1], W[2]));
        const Vector3 sum = A[0] + A[2];
        A[1]              = sum.norm() > 0.1 ? unit(sum) : A[0];
        const Vector3 D0 = 0.75 * inner[0] - 0.375 * end[0], D3 = 0.75 * inner[1] - 0.375 * end[1];
        const double  lambda[2] = {D0 * W[0] / W[0].norm_square(), D3 * W[2] / W[2].norm_square()},
                     mu[2]      = {D0 * A[0], D3 * A[2]};
        const auto product      = [](const double *const f, const Vector3 *const V, const unsigned int i)
        { return i == 1 ? (f[1] * V[0] + 2. * f[0] * V[1]) / 3. : (2. * f[1] * V[1] + f[0] * V[2]) / 3.; };
        for (unsigned int i = 0; i < 2; ++i)
          inside[i] =
              Point(0.5 * (Vector3(R[1 + i]) + Vector3(R[2 + i])) + product(lambda, W, 1 + i) + product(mu, A, 1 + i));
      }
    };
  } // namespace

  Vector3 PatchPoint::normal() const
  {
    return unit(dealii::cross_product_3d(d[0], d[1]));
  }

  TrianglePatch::TrianglePatch(const TriangleMesh &mesh, const unsigned int triangle)
  {
    const TriangleMesh::Triangle &self = mesh.triangles()[triangle];
    std::vector<Edge>             edges;
    for (unsigned int i = 0; i < 3; ++i)
    {
      const unsigned int     j = (i + 1) % 3;
      const Point            a = mesh.corner(triangle, i), b = mesh.corner(triangle, j);
      std::array<Vector3, 2> other = {{self.normal[i], self.normal[j]}};
      if (self.neighbour[i] != TriangleMesh::none)
      {
        const auto &beyond = mesh.triangles()[self.neighbour[i]];
        other              = {{beyond.normal[(self.edge[i] + 1) % 3], beyond.normal[self.edge[i]]}};
      }
      edges.emplace_back(
          a, b, end_of_edge(b - a, self.normal[i], other[0]), end_of_edge(a - b, self.normal[j], other[1]));
    }
    for (unsigned int i = 0; i < 3; ++i)
    {
      const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
      edges[i].make_inside({{self.normal[i], self.normal[j]}}, {{edges[k].end[1], edges[j].end[0]}});
      for (unsigned int n = 0; n < 4; ++n)
        points_[4 * i + n] = edges[i].R[n];
    }
    for (unsigned int i = 0; i < 3; ++i) // near corner i: of the edge from it, of the edge to it
    {
      points_[12 + 2 * i]     = edges[i].inside[0];
      points_[12 + 2 * i + 1] = edges[(i + 2) % 3].inside[1];
    }
  }

  PatchPoint TrianglePatch::at(const double s, const double t) const
  {
    const Jet b[3] = {{1. - s - t, -1., -1., 0., 0., 0.}, {s, 1., 0., 0., 0., 0.}, {t, 0., 1., 0., 0., 0.}};
    std::array<Jet, n_points> weight;
    Jet                       square[3];
    for (unsigned int i = 0; i < 3; ++i)
      square[i] = b[i] * b[i];
    for (unsigned int i = 0; i < 3; ++i)
    {
      const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
      weight[4 * i]     = square[i] * square[i];
      weight[4 * i + 1] = 4. * (square[i] * (b[i] * b[j]));
      weight[4 * i + 2] = 6. * (square[i] * square[j]);
      weight[4 * i + 3] = 4. * (b[i] * (b[j] * square[j]));
      // 12 b_i^2 b_j b_k times b_j/(b_j + b_k) and b_k/(b_j + b_k): either edge has its own inner point (eq. R8)
      const Jet product = 12. * (square[i] * (b[j] * b[k]));
      Jet      &first = weight[12 + 2 * i], &second = weight[12 + 2 * i + 1];
      if (b[j].value + b[k].value > at_corner && b[j].value > 0. && b[k].value > 0.)
      {
        const Jet part = product * inverse(b[j] + b[k]);
        first          = part * b[j];
        second         = part * b[k];
      }
      else // outside the point of the edge that is nearer
      {
        const double of_first = b[j].value > b[k].value ? 1. : b[j].value < b[k].value ? 0. : 0.5;
        first                 = of_first * product;
        second                = (1. - of_first) * product;
      }
    }
    PatchPoint result;
    for (unsigned int n = 0; n < n_points; ++n)
    {
      const Jet     &w = weight[n];
      const Vector3 &x = points_[n];
      result.x += w.value * x;
      result.d[0] += w.s * x;
      result.d[1] += w.t * x;
      result.dd[0] += w.ss * x;
      result.dd[1] += w.st * x;
      result.dd[2] += w.tt * x;
    }
    return result;
  }

  std::array<Vector3, 3> TrianglePatch::edge(const unsigned int i, const double r) const
  {
    const double       q        = 1. - r;
    const Point *const first[5] = {
        &points_[4 * i], &points_[4 * i + 1], &points_[4 * i + 2], &points_[4 * i + 3], &points_[4 * ((i + 1) % 3)]};
    const double value[5] = {q * q * q * q, 4. * q * q * q * r, 6. * q * q * r * r, 4. * q * r * r * r, r * r * r * r};
    const double d[4]     = {4. * q * q * q, 12. * q * q * r, 12. * q * r * r, 4. * r * r * r};
    const double dd[3]    = {12. * q * q, 24. * q * r, 12. * r * r};
    std::array<Vector3, 3> result;
    for (unsigned int n = 0; n < 5; ++n)
      result[0] += value[n] * *first[n];
    for (unsigned int n = 0; n < 4; ++n)
      result[1] += d[n] * (*first[n + 1] - *first[n]);
    for (unsigned int n = 0; n < 3; ++n)
      result[2] += dd[n] * (Vector3(*first[n + 2]) - 2. * Vector3(*first[n + 1]) + Vector3(*first[n]));
    return result;
  }
} // namespace Nodus
