#include "contact/mean_normals.h"

namespace Nodus
{
  MeanNormals::MeanNormals(const ContactGeometry              &geometry,
                           const VariationSources             &sources,
                           const unsigned int                  pair,
                           const unsigned int                  face,
                           const ContactPairParameters::Normal kind)
      : slave_(geometry.slave[pair])
      , face_(face)
      , of_slave_(kind == ContactPairParameters::Normal::slave)
      , master_(geometry, sources, pair, kind)
      , value_(slave_.face(face).slaves.size())
      , derivative_(value_.size())
  {
  }

  void MeanNormals::add(const MortarPoint                &point,
                        const double                      weight,
                        const Nodal                      &hat,
                        const Nodal                      *d_hat,
                        const Eigen::Ref<const Gradient> &gradient,
                        const std::vector<unsigned int>  &nodes)
  {
    Vector3                     normal, slope[4];
    std::vector<NodeDerivative> fixed; // at fixed local coordinates
    if (of_slave_)
    {
      constexpr double step = 1e-5; // the normal is smooth in the face
      const auto       at   = [&](const double dx, const double dy)
      { return slave_.averaged_normal(face_, point.xi + dx, point.eta + dy); };
      normal   = at(0., 0.);
      slope[0] = (at(step, 0.) - at(-step, 0.)) / (2. * step);
      slope[1] = (at(0., step) - at(0., -step)) / (2. * step);
      slave_.averaged_normal_derivative(face_, point.xi, point.eta, fixed);
    }
    else
    {
      const auto &[f, xi, eta] = point.master;
      normal                   = master_.at(f, xi, eta);
      const auto slopes        = master_.slopes(point.master);
      slope[2]                 = slopes[0];
      slope[3]                 = slopes[1];
      fixed                    = master_.derivative(point.master);
    }
    for (unsigned int a = 0; a < value_.size(); ++a)
    {
      const double part = weight * hat[a];
      value_[a] += part * normal;
      for (const NodeDerivative &d : fixed)
        Nodus::add(derivative_[a], d.node, part * d.value);
      const Vector3 by_coordinate[5] = {part * normal,
                                        part * slope[0] + weight * d_hat[0][a] * normal,
                                        part * slope[1] + weight * d_hat[1][a] * normal,
                                        part * slope[2],
                                        part * slope[3]};
      for (unsigned int n = 0; n < nodes.size(); ++n)
      {
        dealii::Tensor<2, dim> value;
        for (unsigned int i = 0; i < 5; ++i)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int d = 0; d < dim; ++d)
              value[c][d] += by_coordinate[i][c] * gradient(i, 3 * n + d);
        Nodus::add(derivative_[a], nodes[n], value);
      }
    }
  }

  void
  MeanNormals::add_derivative(const unsigned int a, const double part, std::vector<NodeDerivative> &derivative) const
  {
    for (const NodeDerivative &d : derivative_[a])
      Nodus::add(derivative, d.node, part * d.value);
  }
} // namespace Nodus
