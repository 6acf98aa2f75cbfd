#include "contact/geometry_tangent.h"
#include "contact/master_normal.h"
#include "contact/varied_faces.h"

#include <algorithm>

// Projections of sites and their normals.

namespace Nodus
{
  /// Adds @p dual times the motion of the position of the site.
  void GeometryTangent::add_slave_motion(const unsigned int site, const Vector3 &dual, Motion &motion) const
  {
    if (!surfaces_.is_point(site))
    {
      motion.emplace_back(surfaces_.slave_nodes()[site].node, dual);
      return;
    }
    const SlavePoint &p    = surfaces_.point(site);
    const auto       &side = geometry_.slave[p.pair];
    const FaceShape   shape(surfaces_.degree(), p.xi, p.eta);
    const auto        part = SurfaceGeometry::offset_functions(p.xi, p.eta);
    for (unsigned int n = 0; n < shape.n; ++n)
      motion.emplace_back(side.face(p.face).nodes[n], shape.value[n] * dual);
    for (unsigned int i = 0; i < VariationSources::n_moving(side, p.face); ++i)
      motion.emplace_back(sources_.part(p.pair, false, p.face, i), part[i] * dual);
  }

  std::array<GeometryTangent::Motion, 2> GeometryTangent::projection_motion(const unsigned int site) const
  {
    std::array<Motion, 2> motion;
    const unsigned int    p = surfaces_.pair(site);
    const Point           x = geometry_.position(surfaces_, site);
    if (const RigidSurface *const rigid = geometry_.rigid[p])
    {
      const RigidPoint closest = rigid->closest(x);
      for (unsigned int i = 0; i < 2; ++i)
      {
        const Vector3 dual = closest.slide() * closest.direction[i];
        add_slave_motion(site, dual, motion[i]);
        if (const RigidCarrier *const carrier = rigid->carrier())
        {
          const RigidCarrier::Weights weights = carrier->weights(x);
          for (unsigned int n = 0; n < weights.size(); ++n)
            motion[i].emplace_back(carrier->nodes()[n], -weights[n] * dual);
        }
      }
      return motion;
    }
    const Projection &master = pairing_[site].master;
    if (!master.found())
      return motion;
    const SurfaceGeometry   &side = geometry_.master[p];
    const ProjectionGradient gradient(side, master, x);
    for (unsigned int i = 0; i < 2; ++i)
    {
      if (gradient.point[i] == Vector3())
        continue;
      add_slave_motion(site, gradient.point[i], motion[i]);
      for (unsigned int n = 0; n < side.face(master.face).nodes.size(); ++n)
        motion[i].emplace_back(side.face(master.face).nodes[n], gradient.node[i][n]);
      for (unsigned int n = 0; n < VariationSources::n_moving(side, master.face); ++n)
        motion[i].emplace_back(sources_.part(p, true, master.face, n), gradient.part[i][n]);
    }
    return motion;
  }

  /// A site with a projection of its own: the shape functions at the slave point do not change.
  void GeometryTangent::add_projection(const unsigned int           site,
                                       const std::array<Motion, 2> &motion,
                                       SiteVariation               &variation) const
  {
    const unsigned int p      = surfaces_.pair(site);
    const Projection  &master = pairing_[site].master;
    const bool         meshed = geometry_.rigid[p] == nullptr;
    const auto         note   = [&](const unsigned int node)
    { surfaces_.expand(node, 1., [&](const unsigned int free_node, double) { variation.node(free_node); }); };
    if (meshed)
      for (const unsigned int node : geometry_.master[p].face(master.face).nodes)
        note(node);
    for (const Motion &m : motion)
      for (const auto &[source, value] : m)
        variation.column(source);
    const unsigned int n_slave  = surfaces_.is_point(site)
                                      ? VariationSources::n_moving(geometry_.slave[p], surfaces_.point(site).face)
                                      : 0,
                       n_master = meshed ? VariationSources::n_moving(geometry_.master[p], master.face) : 0;
    for (unsigned int i = 0; i < n_slave; ++i)
      variation.column(sources_.part(p, false, surfaces_.point(site).face, i));
    for (unsigned int i = 0; i < n_master; ++i)
      variation.column(sources_.part(p, true, master.face, i));
    variation.allocate();

    const auto add_part = [&](const unsigned int source, const double value)
    {
      variation.add(variation.offset(),
                    variation.column(source),
                    value * dealii::Tensor<2, dim>(dealii::unit_symmetric_tensor<dim>()));
    };
    if (n_slave > 0)
    {
      const auto value = SurfaceGeometry::offset_functions(surfaces_.point(site).xi, surfaces_.point(site).eta);
      for (unsigned int i = 0; i < n_slave; ++i)
        add_part(sources_.part(p, false, surfaces_.point(site).face, i), value[i]);
    }
    if (n_master > 0)
    {
      const auto value = SurfaceGeometry::offset_functions(master.xi, master.eta);
      for (unsigned int i = 0; i < n_master; ++i)
        add_part(sources_.part(p, true, master.face, i), -value[i]);
    }
    for (unsigned int i = 0; i < 2; ++i)
      if (!motion[i].empty())
        meshed ? add_slide(site, motion[i], i, variation) : add_rigid_slide(site, motion[i], i, variation);
  }

  void GeometryTangent::add_slide(const unsigned int site,
                                  const Motion      &motion,
                                  const unsigned int coordinate,
                                  SiteVariation     &variation) const
  {
    const unsigned int p        = surfaces_.pair(site);
    const auto [f, xi, eta]     = pairing_[site].master;
    const SurfaceGeometry &side = geometry_.master[p];
    const FaceShape        shape(surfaces_.degree(), xi, eta);
    const auto            &slope  = coordinate == 0 ? shape.d_xi : shape.d_eta;
    const FaceGeometry     smooth = side.at(f, xi, eta), facet(side.face(f), shape, side.positions());
    Vector3                offset = coordinate == 0 ? smooth.d_xi - facet.d_xi : smooth.d_eta - facet.d_eta;
    for (unsigned int n = 0; n < shape.n; ++n)
    {
      const unsigned int node = side.face(f).nodes[n];
      offset += slope[n] * surfaces_.nodes()[node].offset; // of hanging nodes
      surfaces_.expand(node,
                       -slope[n],
                       [&](const unsigned int free_node, const double weight)
                       {
                         for (const auto &[source, value] : motion)
                           variation.add(variation.node(free_node), variation.column(source), weight * value);
                       });
    }
    for (const auto &[source, value] : motion)
      variation.add(variation.offset(), variation.column(source), -dealii::outer_product(offset, value));
  }

  /// The slide along a principal direction of a rigid surface (eq. G3).
  void GeometryTangent::add_rigid_slide(const unsigned int site,
                                        const Motion      &motion,
                                        const unsigned int coordinate,
                                        SiteVariation     &variation) const
  {
    const RigidSurface &rigid   = *geometry_.rigid[surfaces_.pair(site)];
    const RigidPoint    closest = rigid.closest(geometry_.position(surfaces_, site));
    const Vector3       along   = closest.direction[coordinate];
    if (const RigidCarrier *const carrier = rigid.carrier())
    {
      for (unsigned int n = 0; n < carrier->nodes().size(); ++n)
        for (const auto &[source, value] : motion)
          variation.add(variation.node(carrier->nodes()[n]),
                        variation.column(source),
                        -(carrier->gradients()[n] * along) * value);
      return;
    }
    const Vector3 moved = rigid.part(closest.x + along).moved - rigid.part(closest.x).moved; // linear in the point
    for (const auto &[source, value] : motion)
    {
      variation.add(variation.offset(), variation.column(source), -dealii::outer_product(along, value));
      variation.add(variation.moved(), variation.column(source), dealii::outer_product(moved, value));
    }
  }

  std::vector<NodeDerivative> GeometryTangent::slave_normal_derivative(const unsigned int site) const
  {
    const unsigned int          p    = surfaces_.pair(site);
    const SurfaceGeometry      &side = geometry_.slave[p];
    std::vector<NodeDerivative> derivative;
    if (surfaces_.is_point(site))
    {
      const SlavePoint &point = surfaces_.point(site);
      side.averaged_normal_derivative(point.face, point.xi, point.eta, derivative);
      return derivative;
    }
    Vector3 sum; // of the faces at the node, as Pairing has it
    for (unsigned int f = 0; f < side.n_faces(); ++f)
    {
      const auto &nodes = side.face(f).nodes;
      const auto  at    = std::find(nodes.begin(), nodes.end(), surfaces_.slave_nodes()[site].node);
      if (at == nodes.end())
        continue;
      sum += side.nodal_normal(f, at - nodes.begin());
      side.nodal_normal_derivative(f, at - nodes.begin(), derivative);
    }
    const Matrix3 to_unit = unit_derivative(sum);
    for (NodeDerivative &d : derivative)
      d.value = to_unit * d.value;
    return derivative;
  }

  std::vector<NodeDerivative> GeometryTangent::rigid_normal_derivative(const unsigned int site) const
  {
    const unsigned int          p     = surfaces_.pair(site);
    const Point                 x     = geometry_.position(surfaces_, site);
    const RigidPoint            point = geometry_.rigid[p]->closest(x);
    const Matrix3               slope = point.normal_derivative();
    std::vector<NodeDerivative> derivative;
    for (unsigned int c = 0; c < dim; ++c) // column by column: the slope is symmetric
    {
      Vector3 unit;
      unit[c] = 1.;
      Motion motion;
      add_slave_motion(site, slope * unit, motion);
      for (const auto &[source, value] : motion)
        Nodus::add(derivative, source, -dealii::outer_product(unit, value));
    }
    if (const RigidCarrier *const carrier = geometry_.rigid[p]->carrier())
    {
      const RigidCarrier::Weights weights = carrier->weights(x);
      for (unsigned int i = 0; i < weights.size(); ++i)
      {
        Matrix3 value = weights[i] * slope;
        for (unsigned int c = 0; c < dim; ++c) // the normal turns with the body
          value[c][c] -= carrier->gradients()[i] * point.normal;
        Nodus::add(derivative, carrier->nodes()[i], value);
      }
    }
    return derivative;
  }

  std::vector<NodeDerivative> GeometryTangent::normal_derivative(const unsigned int site) const
  {
    using Normal                       = ContactPairParameters::Normal;
    const unsigned int          p      = surfaces_.pair(site);
    const Projection           &master = pairing_[site].master;
    const bool                  rigid  = geometry_.rigid[p] != nullptr;
    std::vector<NodeDerivative> derivative;
    if (!rigid && !master.found())
      return derivative;
    if (pairs_[p].normal == Normal::slave)
      return slave_normal_derivative(site);
    if (rigid)
      return rigid_normal_derivative(site);

    const MasterNormal normal(geometry_, sources_, p, pairs_[p].normal);
    derivative        = normal.derivative(master);
    const auto motion = projection_motion(site);
    const auto slopes = normal.slopes(master);
    for (unsigned int alpha = 0; alpha < 2; ++alpha)
      for (const auto &[source, value] : motion[alpha])
        Nodus::add(derivative, source, dealii::outer_product(slopes[alpha], value));
    return derivative;
  }

  /// Without a projection of its own the site has the mean over its surface (eq. J3).
  std::vector<NodeDerivative> GeometryTangent::mean_normal_derivative(const unsigned int site, VariedFaces &faces) const
  {
    Vector3                     sum;
    std::vector<NodeDerivative> derivative;
    faces.for_each(site,
                   [&](const FaceVariation &face, const unsigned int a, const double part)
                   {
                     sum += part * face.normals().value(a);
                     face.normals().add_derivative(a, part, derivative);
                   });
    const Matrix3 to_unit = unit_derivative(sum);
    for (NodeDerivative &d : derivative)
      d.value = to_unit * d.value;
    return derivative;
  }
} // namespace Nodus
