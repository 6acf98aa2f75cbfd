#include "contact/variation_sources.h"

#include <cmath>

namespace Nodus
{
  VariationSources::VariationSources(const ContactSurfaces &surfaces, const ContactGeometry &geometry)
      : geometry_(geometry)
      , n_nodes_(surfaces.nodes().size())
      , size_(n_nodes_)
  {
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
      for (const SurfaceGeometry *const side : {&geometry.slave[p], &geometry.master[p]})
      {
        first_.push_back(size_);
        size_ += n_parts * side->n_faces();
      }
  }

  const std::vector<NodeDerivative> &VariationSources::derivative(const unsigned int source) const
  {
    const auto [at, is_new] = cache_.try_emplace(source);
    if (is_new)
    {
      unsigned int side = 0;
      while (side + 1 < first_.size() && first_[side + 1] <= source)
        ++side;
      const unsigned int number = source - first_[side];
      at->second = (side % 2 == 0 ? geometry_.slave : geometry_.master)[side / 2].offset_derivative(number / n_parts,
                                                                                                    number % n_parts);
    }
    return at->second;
  }

  FaceCurvature::FaceCurvature(const unsigned int degree, const double xi, const double eta)
  {
    double       value1[2][3], d[2][3];
    const double dd[3] = {4., -8., 4.};
    for (unsigned int direction = 0; direction < 2; ++direction)
    {
      const double s = direction == 0 ? xi : eta;
      if (degree == 1)
      {
        value1[direction][0] = 1 - s;
        value1[direction][1] = s;
        d[direction][0]      = -1;
        d[direction][1]      = 1;
        continue;
      }
      value1[direction][0] = (2 * s - 1) * (s - 1);
      value1[direction][1] = 4 * s * (1 - s);
      value1[direction][2] = s * (2 * s - 1);
      d[direction][0]      = 4 * s - 3;
      d[direction][1]      = 4 - 8 * s;
      d[direction][2]      = 4 * s - 1;
    }
    for (unsigned int j = 0, k = 0; j <= degree; ++j)
      for (unsigned int i = 0; i <= degree; ++i, ++k)
      {
        value[0][k] = degree == 1 ? 0. : dd[i] * value1[1][j];
        value[1][k] = d[0][i] * d[1][j];
        value[2][k] = degree == 1 ? 0. : value1[0][i] * dd[j];
      }
  }

  std::array<Vector3, 3> FaceCurvature::of(const Point *const points, const unsigned int n) const
  {
    std::array<Vector3, 3> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int k = 0; k < n; ++k)
        result[i] += value[i][k] * points[k];
    return result;
  }

  ProjectionGradient::ProjectionGradient(const SurfaceGeometry &master, const Projection &projection, const Point &p)
  {
    const auto [f, xi, eta]         = projection;
    const unsigned int shape_degree = master.shape_degree();
    const FaceGeometry x            = master.at(f, xi, eta);
    const auto         second =
        FaceCurvature(shape_degree, xi, eta).of(master.shape_points(f), (shape_degree + 1) * (shape_degree + 1));
    const Vector3 tangent[2] = {x.d_xi, x.d_eta}, gap = p - x.x;
    const bool    held[2] = {xi <= 0. || xi >= 1., eta <= 0. || eta >= 1.};

    // (x_a . x_b - gap . x_ab) delta xi^b = x_a . delta (p - x) + gap . delta x_a
    const double a = tangent[0] * tangent[0] - gap * second[0], b = tangent[0] * tangent[1] - gap * second[1],
                 c       = tangent[1] * tangent[1] - gap * second[2];
    double inverse[2][2] = {{0., 0.}, {0., 0.}};
    if (!held[0] && !held[1])
    {
      const double det = a * c - b * b;
      inverse[0][0]    = c / det;
      inverse[1][1]    = a / det;
      inverse[0][1] = inverse[1][0] = -b / det;
    }
    else if (!held[0])
      inverse[0][0] = 1. / a;
    else if (!held[1])
      inverse[1][1] = 1. / c;

    const FaceShape                    shape(master.degree(), xi, eta);
    const std::array<double, 9> *const d_shape[2] = {&shape.d_xi, &shape.d_eta};
    const FaceShape                    quadratic(2, xi, eta);
    const unsigned int                 n_parts    = VariationSources::n_moving(master, f);
    const auto                         parts      = SurfaceGeometry::offset_functions(quadratic.value);
    const std::array<double, 8>        d_parts[2] = {SurfaceGeometry::offset_functions(quadratic.d_xi),
                                                     SurfaceGeometry::offset_functions(quadratic.d_eta)};
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int j = 0; j < 2; ++j)
      {
        point[i] += inverse[i][j] * tangent[j];
        for (unsigned int n = 0; n < shape.n; ++n)
          node[i][n] += inverse[i][j] * ((*d_shape[j])[n] * gap - shape.value[n] * tangent[j]);
        for (unsigned int n = 0; n < n_parts; ++n)
          part[i][n] += inverse[i][j] * (d_parts[j][n] * gap - parts[n] * tangent[j]);
      }
  }
} // namespace Nodus
