#include "contact/surface_weights.h"
#include "contact/averaged_jump.h"
#include "contact/face_rule.h"

#include <deal.II/base/quadrature_lib.h>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int no_site = dealii::numbers::invalid_unsigned_int;

    /// Rule whose sum over a face gives the nodal areas: the nodes themselves, Gauss points, or the rule of the pair.
    dealii::Quadrature<2> area_rule(const unsigned int degree, const ContactPairParameters &pair)
    {
      if (pair.weights == ContactPairParameters::Weights::consistent)
        return face_rule(pair, degree);
      if (pair.weights == ContactPairParameters::Weights::dual)
        return dealii::QGauss<2>(degree + 2);
      if (degree == 1)
        return dealii::Quadrature<2>(dealii::QTrapezoid<1>());
      return dealii::Quadrature<2>(dealii::QSimpson<1>());
    }
  } // namespace

  void SurfaceWeights::compute(const std::vector<ContactPairParameters> &pairs,
                               const ContactSurfaces                    &surfaces,
                               const AveragedJump                       &averaged,
                               const std::vector<Point>                 &x,
                               const std::vector<Point>                 &X,
                               const std::vector<bool>                  &lumped)
  {
    using Scheme          = ContactPairParameters::Scheme;
    const auto consistent = [&](const unsigned int p)
    { return pairs[p].weights == ContactPairParameters::Weights::consistent && (lumped.empty() || !lumped[p]); };
    const auto &slaves = surfaces.slave_nodes();
    points_.clear();
    area_.assign(slaves.size(), 0.);

    const auto measure = [&](const unsigned int p) -> const std::vector<Point> &
    { return pairs[p].surface_measure == ContactPairParameters::SurfaceMeasure::current ? x : X; };
    // Adds a point of a face to the nodal areas and, at a site or as it is, to the points, with all nodes of the face.
    const auto add = [&](const SurfaceFace &face,
                         const FaceShape   &shape,
                         const double       weight,
                         const unsigned int p,
                         const bool         is_point,
                         const unsigned int site)
    {
      const double area   = weight * FaceGeometry(face, shape, measure(p)).area_vector().norm();
      const auto   values = face.slave_values(shape.value);
      for (unsigned int j = 0; j < face.slaves.size(); ++j)
        area_[face.slaves[j]] += area * values[j];
      if (is_point)
        points_.push_back({area, face.slaves, {values.begin(), values.begin() + face.slaves.size()}, face.owner, site});
    };

    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (pairs[p].scheme == Scheme::integration_point)
        continue;
      const auto             rule = area_rule(surfaces.degree(), pairs[p]);
      std::vector<FaceShape> shapes;
      for (const auto &q : rule.get_points())
        shapes.emplace_back(surfaces.degree(), q[0], q[1]);
      for (const auto &face : surfaces.slave_faces(p))
        for (unsigned int q = 0; q < rule.size(); ++q)
          add(face, shapes[q], rule.weight(q), p, consistent(p), no_site);
    }
    for (unsigned int s = slaves.size(); s < surfaces.n_sites(); ++s)
    {
      const SlavePoint &site = surfaces.point(s);
      add(surfaces.slave_faces(site.pair)[site.face],
          FaceShape(surfaces.degree(), site.xi, site.eta),
          site.weight,
          site.pair,
          true,
          s);
    }

    surfaces.slave_exchange().update(area_);
    for (unsigned int k = 0; k < area_.size(); ++k)
    {
      const auto &pair = pairs[slaves[k].pair];
      if (pair.scheme == Scheme::averaged && averaged.covered(k))
        area_[k] = averaged.row(k).area;
      if (pair.scheme != Scheme::integration_point && !consistent(slaves[k].pair))
        points_.push_back({area_[k], {k}, {1.}, surfaces.nodes()[slaves[k].node].owner, no_site});
    }
  }

  std::vector<double> SurfaceWeights::weighted(const std::vector<double> &nodal_field) const
  {
    std::vector<double> result(nodal_field.size(), 0.);
    for (const auto &point : points_)
    {
      double value = 0.;
      for (unsigned int a = 0; a < point.slaves.size(); ++a)
        value += point.shape[a] * nodal_field[point.slaves[a]];
      for (unsigned int a = 0; a < point.slaves.size(); ++a)
        result[point.slaves[a]] += point.weight * point.shape[a] * value;
    }
    for (unsigned int k = 0; k < result.size(); ++k)
      result[k] /= area_[k];
    return result;
  }
} // namespace Nodus
