#include "bulk/follower_pressure.h"

namespace Nodus
{
  using dealii::cross_product_3d;
  using dealii::FullMatrix;

  FollowerPressure::FollowerPressure(const dealii::FiniteElement<dim> &fe,
                                     const FaceTable                  &table,
                                     const std::vector<LoadedPoint>   &points,
                                     const std::vector<double>        &pressure)
      : fe_(fe)
      , table_(table)
      , points_(points)
      , pressure_(pressure)
  {
  }

  FollowerPressure::Tangents FollowerPressure::tangents(const unsigned int q, const std::vector<double> &u) const
  {
    Tangents now{{points_[q].tangent[0], points_[q].tangent[1]}};
    for (unsigned int a = 0; a < table_.nodes.size(); ++a)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int s = 0; s < 2; ++s)
          now.t[s][i] += u[dof(a, i)] * table_.gradient[s][q][a];
    return now;
  }

  void FollowerPressure::add(const std::vector<double> &u,
                             dealii::Vector<double>    &external,
                             FullMatrix<double>        *tangent) const
  {
    for (unsigned int q = 0; q < points_.size(); ++q)
    {
      const Tangents now   = tangents(q, u);
      const Vector3  force = -pressure_[q] * points_[q].weight * cross_product_3d(now.t[0], now.t[1]);
      for (unsigned int a = 0; a < table_.nodes.size(); ++a)
        for (unsigned int i = 0; i < dim; ++i)
          external(dof(a, i)) += table_.value[q][a] * force[i];
      if (tangent)
        add_half(q, now, -1., *tangent);
    }
  }

  void FollowerPressure::add_unsymmetric(const std::vector<double> &u, FullMatrix<double> &tangent) const
  {
    for (unsigned int q = 0; q < points_.size(); ++q)
      add_half(q, tangents(q, u), 1., tangent);
  }

  /// The matrix of -w x du_b, w = p/2 (N_a v_b + @p sign N_b v_a): the cross product makes the half with - symmetric.
  void FollowerPressure::add_half(const unsigned int  q,
                                  const Tangents     &now,
                                  const double        sign,
                                  FullMatrix<double> &tangent) const
  {
    const unsigned int n = table_.nodes.size();
    const double       p = pressure_[q] * points_[q].weight;
    const auto         v = [&](const unsigned int a)
    { return table_.gradient[0][q][a] * now.t[1] - table_.gradient[1][q][a] * now.t[0]; };
    for (unsigned int a = 0; a < n; ++a)
    {
      const Vector3 v_a = v(a);
      for (unsigned int b = 0; b < n; ++b)
      {
        const Vector3 w = p / 2. * (table_.value[q][a] * v(b) + sign * table_.value[q][b] * v_a);
        for (unsigned int i = 0; i < dim; ++i)
        {
          const unsigned int k = (i + 1) % dim, m = (i + 2) % dim;
          tangent(dof(a, i), dof(b, k)) += w[m];
          tangent(dof(a, i), dof(b, m)) -= w[k];
        }
      }
    }
  }
} // namespace Nodus
