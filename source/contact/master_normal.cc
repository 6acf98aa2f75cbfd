#include "contact/master_normal.h"

namespace Nodus
{
  MasterNormal::MasterNormal(const ContactGeometry              &geometry,
                             const VariationSources             &sources,
                             const unsigned int                  pair,
                             const ContactPairParameters::Normal kind)
      : surface_(geometry.master[pair])
      , search_(geometry.search[pair])
      , sources_(sources)
      , pair_(pair)
      , averaged_(kind == ContactPairParameters::Normal::averaged)
  {
  }

  Vector3 MasterNormal::at(const unsigned int face, const double xi, const double eta) const
  {
    return averaged_ ? -surface_.averaged_normal(face, xi, eta)
                     : -surface_.facet_normal(face, xi, eta, search_.rim(face));
  }

  std::array<Vector3, 2> MasterNormal::slopes(const Projection &point) const
  {
    constexpr double step  = 1e-5; // the normal is smooth in the face
    const auto       slope = [&](const double dx, const double dy)
    {
      return (at(point.face, point.xi + dx, point.eta + dy) - at(point.face, point.xi - dx, point.eta - dy)) /
             (2. * step);
    };
    return {{slope(step, 0.), slope(0., step)}};
  }

  std::vector<NodeDerivative> MasterNormal::derivative(const Projection &point) const
  {
    const double part = averaged_ ? 1. : SurfaceGeometry::edge_part(point.xi, point.eta, search_.rim(point.face));
    std::vector<NodeDerivative> result;
    if (part == 1.)
      surface_.averaged_normal_derivative(point.face, point.xi, point.eta, result);
    else
      add_facet(point, part, result);
    for (NodeDerivative &d : result)
      d.value = -d.value;
    return result;
  }

  void MasterNormal::add_facet(const Projection            &point,
                               const double                 averaged_part,
                               std::vector<NodeDerivative> &derivative) const
  {
    const auto [f, xi, eta] = point;
    const FaceShape    shape(2, xi, eta);
    const FaceGeometry x               = surface_.at(f, xi, eta);
    const auto         d_xi            = SurfaceGeometry::offset_functions(shape.d_xi),
               d_eta                   = SurfaceGeometry::offset_functions(shape.d_eta);
    const dealii::Tensor<2, dim> cross = surface_.face(f).orientation * unit_derivative(x.area_vector());
    surface_.normal_derivative(f, xi, eta, derivative);
    for (unsigned int i = 0; i < VariationSources::n_moving(surface_, f); ++i)
      add(derivative,
          sources_.part(pair_, true, f, i),
          cross * (d_eta[i] * cross_matrix(x.d_xi) - d_xi[i] * cross_matrix(x.d_eta)));
    if (averaged_part == 0.)
      return;

    const dealii::Tensor<2, dim> to_unit = unit_derivative(averaged_part * surface_.averaged_normal(f, xi, eta) +
                                                           (1. - averaged_part) * surface_.normal(f, xi, eta));
    for (NodeDerivative &d : derivative)
      d.value = (1. - averaged_part) * to_unit * d.value;
    std::vector<NodeDerivative> averaged;
    surface_.averaged_normal_derivative(f, xi, eta, averaged);
    for (const NodeDerivative &d : averaged)
      add(derivative, d.node, averaged_part * to_unit * d.value);
  }
} // namespace Nodus
