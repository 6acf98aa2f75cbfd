#include <nodus/contact/surface_weights.h>

#include <deal.II/base/quadrature_lib.h>

namespace Nodus
{
  namespace
  {
    /// Points and weights whose sum over a face gives the nodal areas: the nodes themselves, or Gauss points.
    dealii::Quadrature<2> face_rule(const unsigned int degree, const ContactPairParameters::Weights weights)
    {
      if (weights != ContactPairParameters::Weights::nodal_quadrature)
        return dealii::QGauss<2>(degree + 2);
      if (degree == 1)
        return dealii::Quadrature<2>(dealii::QTrapezoid<1>());
      return dealii::Quadrature<2>(dealii::QSimpson<1>());
    }
  } // namespace

  void SurfaceWeights::compute(const std::vector<ContactPairParameters> &pairs,
                               const ContactSurfaces                    &surfaces,
                               const std::vector<Point>                 &x,
                               const std::vector<Point>                 &X)
  {
    using Weights = ContactPairParameters::Weights;
    points_.clear();
    area_.assign(surfaces.slave_nodes().size(), 0.);

    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      const auto &positions = pairs[p].surface_measure == ContactPairParameters::SurfaceMeasure::current ? x : X;
      const auto  rule      = face_rule(surfaces.degree(), pairs[p].weights);
      std::vector<FaceShape> shapes;
      for (const auto &q : rule.get_points())
        shapes.emplace_back(surfaces.degree(), q[0], q[1]);

      for (const auto &face : surfaces.slave_faces(p))
        for (unsigned int q = 0; q < rule.size(); ++q)
        {
          const double weight = rule.weight(q) * FaceGeometry(face, shapes[q], positions).area_vector().norm();
          ContactPoint point{weight, {}, {}, face.owner};
          for (unsigned int n = 0; n < face.nodes.size(); ++n)
          {
            const unsigned int k = surfaces.slave_number(face.nodes[n]);
            area_[k] += weight * shapes[q].value[n];
            if (pairs[p].weights == Weights::consistent)
            {
              point.slaves.push_back(k);
              point.shape.push_back(shapes[q].value[n]);
            }
          }
          if (pairs[p].weights == Weights::consistent)
            points_.push_back(std::move(point));
        }
    }

    for (unsigned int k = 0; k < area_.size(); ++k)
    {
      const auto &slave = surfaces.slave_nodes()[k];
      if (pairs[slave.pair].weights != Weights::consistent)
        points_.push_back({area_[k], {k}, {1.}, surfaces.nodes()[slave.node].owner});
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
