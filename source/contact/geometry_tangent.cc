#include "contact/geometry_tangent.h"

#include <algorithm>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int no_site = dealii::numbers::invalid_unsigned_int;

    void add_shape(const SurfaceFace                &face,
                   const std::array<double, 9>      &value,
                   const double                      sign,
                   std::vector<JumpOperator::Entry> &entries)
    {
      for (unsigned int n = 0; n < face.nodes.size(); ++n)
        if (std::abs(value[n]) > 1e-15)
          entries.push_back({face.nodes[n], sign * value[n]});
    }
  } // namespace

  GeometryTangent::GeometryTangent(const std::vector<ContactPairParameters> &pairs,
                                   const ContactSurfaces                    &surfaces,
                                   const ContactGeometry                    &geometry,
                                   const AveragedJump                       &averaged,
                                   const Pairing                            &pairing,
                                   const JumpOperator                       &jump,
                                   const SurfaceWeights                     &weights,
                                   const Status                             &status)
      : pairs_(pairs)
      , surfaces_(surfaces)
      , geometry_(geometry)
      , averaged_(averaged)
      , pairing_(pairing)
      , jump_(jump)
      , weights_(weights)
      , status_(status)
      , gap_rows_(surfaces.n_sites())
  {
    for (const ContactPoint &point : weights_.points())
      for (unsigned int a = 0; a < point.slaves.size(); ++a)
        if (point.site != no_site)
        {
          if (status_.contact(point.site))
            gap_rows_[point.site].emplace_back(point.slaves[a], -point.weight * point.shape[a]);
        }
        else if (status_.contact(point.slaves[a]))
          for (unsigned int b = 0; b < point.slaves.size(); ++b)
            if (status_.contact(point.slaves[b]))
              gap_rows_[point.slaves[b]].emplace_back(point.slaves[a], -point.weight * point.shape[a] * point.shape[b]);
  }

  GeometryTangent::ProjectedPoint GeometryTangent::slave_point(const unsigned int site) const
  {
    ProjectedPoint point;
    if (surfaces_.is_point(site))
    {
      const SlavePoint &p = surfaces_.point(site);
      add_shape(
          surfaces_.slave_faces(p.pair)[p.face], FaceShape(surfaces_.degree(), p.xi, p.eta).value, 1., point.motion);
    }
    else
      point.motion.push_back({surfaces_.slave_nodes()[site].node, 1.});
    return point;
  }

  void GeometryTangent::project(const unsigned int pair, const Projection &master, ProjectedPoint &point) const
  {
    const SurfaceGeometry &surface = geometry_.master[pair];
    const SurfaceFace     &face    = surface.face(master.face);
    const FaceShape        shape(surfaces_.degree(), master.xi, master.eta);
    add_shape(face, shape.value, -1., point.motion);
    add_shape(face, shape.d_xi, 1., point.shape[0]);
    add_shape(face, shape.d_eta, 1., point.shape[1]);

    const FaceGeometry x = surface.at(master.face, master.xi, master.eta);
    point.tangent[0]     = x.d_xi;
    point.tangent[1]     = x.d_eta;
    const bool   held[2] = {master.xi <= 0. || master.xi >= 1., master.eta <= 0. || master.eta >= 1.};
    const double a = x.d_xi * x.d_xi, b = x.d_xi * x.d_eta, c = x.d_eta * x.d_eta, det = a * c - b * b;
    if (!held[0])
      point.dual[0] = held[1] ? x.d_xi / a : (c * x.d_xi - b * x.d_eta) / det;
    if (!held[1])
      point.dual[1] = held[0] ? x.d_eta / c : (a * x.d_eta - b * x.d_xi) / det;
  }

  /// The point moves on the surface along the principal directions.
  void GeometryTangent::project_on_rigid(const RigidSurface &master, const Point &p, ProjectedPoint &point) const
  {
    const RigidPoint closest = master.closest(p);
    for (unsigned int alpha = 0; alpha < 2; ++alpha)
    {
      point.tangent[alpha] = closest.direction[alpha];
      point.dual[alpha]    = closest.slide() * closest.direction[alpha];
    }
    if (const RigidCarrier *const carrier = master.carrier())
    {
      const RigidCarrier::Weights weights = carrier->weights(p);
      for (unsigned int i = 0; i < weights.size(); ++i)
      {
        point.motion.push_back({carrier->nodes()[i], -weights[i]});
        for (unsigned int alpha = 0; alpha < 2; ++alpha)
          point.shape[alpha].push_back({carrier->nodes()[i], carrier->gradients()[i] * point.tangent[alpha]});
      }
    }
  }

  std::vector<NodeDerivative> GeometryTangent::normal_derivative(const unsigned int site) const
  {
    using Normal = ContactPairParameters::Normal;
    std::vector<NodeDerivative> derivative;
    const unsigned int          p      = surfaces_.pair(site);
    const Projection           &master = pairing_[site].master;
    if (pairs_[p].normal == Normal::slave)
      return derivative;
    if (geometry_.rigid[p] != nullptr)
    {
      const Point      x     = geometry_.position(surfaces_, site);
      const RigidPoint point = geometry_.rigid[p]->closest(x);
      for (const Entry &e : slave_point(site).motion)
        Nodus::add(derivative, e.node, -e.weight * point.normal_derivative());
      if (const RigidCarrier *const carrier = geometry_.rigid[p]->carrier())
      {
        const RigidCarrier::Weights weights = carrier->weights(x);
        for (unsigned int i = 0; i < weights.size(); ++i)
        {
          Matrix3 value = weights[i] * point.normal_derivative();
          for (unsigned int c = 0; c < dim; ++c) // the normal turns with the body
            value[c][c] -= carrier->gradients()[i] * point.normal;
          Nodus::add(derivative, carrier->nodes()[i], value);
        }
      }
      return derivative;
    }
    if (!master.found())
      return derivative;

    const SurfaceGeometry &surface   = geometry_.master[p];
    const bool             averaging = pairs_[p].normal == Normal::averaged;
    if (averaging)
      surface.averaged_normal_derivative(master.face, master.xi, master.eta, derivative);
    else
      surface.normal_derivative(master.face, master.xi, master.eta, derivative);
    for (NodeDerivative &d : derivative)
      d.value = -d.value;

    ProjectedPoint point = slave_point(site);
    project(p, master, point);
    for (unsigned int alpha = 0; alpha < 2; ++alpha)
    {
      constexpr double step = 1e-5; // the normal is smooth in the face
      const double     dx = alpha == 0 ? step : 0., dy = alpha == 1 ? step : 0.;
      const auto       normal = [&](const double sign)
      {
        const double xi = master.xi + sign * dx, eta = master.eta + sign * dy;
        return averaging ? surface.averaged_normal(master.face, xi, eta) : surface.normal(master.face, xi, eta);
      };
      const Vector3 slope = (normal(-1.) - normal(1.)) / (2. * step);
      for (const Entry &e : point.motion)
        Nodus::add(derivative, e.node, e.weight * dealii::outer_product(slope, point.dual[alpha]));
    }
    return derivative;
  }

  void GeometryTangent::add_point(const ProjectedPoint &point, const ContactResidual &residual, Blocks &blocks) const
  {
    Vector3 force;
    for (const auto &[site, weight] : point.sites)
      force += weight * residual.jump[site];
    unsigned int column[2 * 9];
    for (unsigned int e = 0; e < point.motion.size(); ++e)
      column[e] = blocks.node(point.motion[e].node);
    for (unsigned int alpha = 0; alpha < 2; ++alpha)
    {
      if (point.dual[alpha] == Vector3())
        continue;
      const Matrix3 slide = dealii::outer_product(force, point.dual[alpha]);
      for (const Entry &row : point.shape[alpha])
      {
        const unsigned int first = blocks.node(row.node) * blocks.stride;
        for (unsigned int e = 0; e < point.motion.size(); ++e)
          blocks.force[first + column[e]] -= row.weight * point.motion[e].weight * slide;
      }
      for (const auto &[site, weight] : point.sites)
        for (const auto &[k, coefficient] : gap_rows_[site])
        {
          const unsigned int first = blocks.slave(k) * blocks.stride;
          const double       slope = -coefficient * weight * (pairing_[site].normal * point.tangent[alpha]);
          for (unsigned int e = 0; e < point.motion.size(); ++e)
            blocks.gap[first + column[e]] += slope * point.motion[e].weight * point.dual[alpha];
        }
    }
  }

  void GeometryTangent::add_offset(const unsigned int    side,
                                   const unsigned int    face,
                                   const double          xi,
                                   const double          eta,
                                   const ProjectedPoint &point,
                                   Blocks               &blocks) const
  {
    const unsigned int pair = surfaces_.pair(point.sites[0].first);
    if (!(side == 0 ? geometry_.slave : geometry_.master)[pair].smoothed())
      return;
    const double                sign  = side == 0 ? 1. : -1.;
    const std::array<double, 8> value = SurfaceGeometry::offset_functions(xi, eta);
    for (const auto &[site, weight] : point.sites)
      for (const auto &[k, coefficient] : gap_rows_[site])
      {
        auto at = std::find_if(blocks.offsets.begin(),
                               blocks.offsets.end(),
                               [&, slave = k](const auto &e)
                               { return e.slave == slave && e.side == side && e.face == face; });
        if (at == blocks.offsets.end())
          at = blocks.offsets.insert(at, {k, side, face, {}});
        for (unsigned int part = 0; part < value.size(); ++part)
          at->normal[part] += coefficient * weight * sign * value[part] * pairing_[site].normal;
      }
  }

  void GeometryTangent::finish_offsets(const unsigned int pair, Blocks &blocks) const
  {
    for (unsigned int i = 0; i < blocks.offsets.size(); ++i)
    {
      const unsigned int side = blocks.offsets[i].side, face = blocks.offsets[i].face;
      const auto         same = [&](const unsigned int j)
      { return blocks.offsets[j].side == side && blocks.offsets[j].face == face; };
      bool done = false;
      for (unsigned int j = 0; j < i; ++j)
        done = done || same(j);
      for (unsigned int part = 0; part < blocks.offsets[i].normal.size() && !done; ++part)
      {
        const auto derivative = (side == 0 ? geometry_.slave : geometry_.master)[pair].offset_derivative(face, part);
        for (unsigned int j = i; j < blocks.offsets.size(); ++j)
          if (same(j))
            for (const NodeDerivative &d : derivative)
            {
              const unsigned int column = blocks.node(d.node), row = blocks.slave(blocks.offsets[j].slave);
              blocks.gap[row * blocks.stride + column] += blocks.offsets[j].normal[part] * d.value;
            }
      }
    }
    blocks.offsets.clear();
  }

  void GeometryTangent::add_face(const AveragedJump::Face &face,
                                 const ContactResidual    &residual,
                                 ProjectedPoint           &point,
                                 Blocks                   &blocks) const
  {
    const SurfaceFace        &surface_face = surfaces_.slave_faces(face.pair)[face.face];
    const auto               &slaves       = surface_face.slaves;
    const unsigned int        n            = slaves.size();
    const RigidSurface *const rigid        = geometry_.rigid[face.pair];
    for (unsigned int q = 0; q < face.points.size(); ++q)
    {
      point.clear();
      for (unsigned int a = 0; a < n; ++a)
        if (const unsigned int k = slaves[a]; averaged_.covered(k) && is_active(residual, k))
          point.sites.emplace_back(k, face.psi[n * q + a] / averaged_.row(k).area);
      if (point.sites.empty())
        continue;
      const MortarPoint &p = face.points[q];
      add_shape(surface_face, FaceShape(surfaces_.degree(), p.xi, p.eta).value, 1., point.motion);
      if (rigid != nullptr)
        project_on_rigid(*rigid, geometry_.slave[face.pair].at(face.face, p.xi, p.eta).x, point);
      else
        project(face.pair, p.master, point);
      add_point(point, residual, blocks);
      add_offset(0, face.face, p.xi, p.eta, point, blocks);
      if (rigid == nullptr)
        add_offset(1, p.master.face, p.master.xi, p.master.eta, point, blocks);
    }
    finish_offsets(face.pair, blocks);
  }

  void GeometryTangent::add_site(const unsigned int site, const ContactResidual &residual, Blocks &blocks) const
  {
    const unsigned int        p      = surfaces_.pair(site);
    const RigidSurface *const rigid  = geometry_.rigid[p];
    const Projection         &master = pairing_[site].master;
    ProjectedPoint            point  = slave_point(site);
    if (rigid != nullptr)
      project_on_rigid(*rigid, geometry_.position(surfaces_, site), point);
    else
      project(p, master, point);
    point.sites.emplace_back(site, 1.);
    add_point(point, residual, blocks);
    if (surfaces_.is_point(site))
      add_offset(0, surfaces_.point(site).face, surfaces_.point(site).xi, surfaces_.point(site).eta, point, blocks);
    if (rigid == nullptr)
      add_offset(1, master.face, master.xi, master.eta, point, blocks);
    finish_offsets(p, blocks);
  }

  void GeometryTangent::add_turn(const unsigned int     site,
                                 const ContactState    &state,
                                 const ContactResidual &residual,
                                 Blocks                &blocks) const
  {
    // r turns with the normal: delta r = (r.n) delta n - n (r_tau . delta n)
    const Vector3 n = pairing_[site].normal, r = residual.jump[site], jump = jump_.jump(site, state.x);
    Matrix3       turn = -dealii::outer_product(n, r - (r * n) * n);
    for (unsigned int c = 0; c < dim; ++c)
      turn[c][c] += r * n;
    for (const NodeDerivative &d : normal_derivative(site))
    {
      const Matrix3      value  = turn * d.value;
      const unsigned int column = blocks.node(d.node);
      for (const Entry *e = jump_.begin(site); e != jump_.end(site); ++e)
      {
        const unsigned int row = blocks.node(e->node);
        blocks.force[row * blocks.stride + column] += e->weight * value;
      }
      for (const auto &[k, coefficient] : gap_rows_[site])
      {
        const unsigned int row = blocks.slave(k);
        blocks.gap[row * blocks.stride + column] += coefficient * (jump * d.value);
      }
    }
  }

  void GeometryTangent::add(const ContactState &state, const ContactResidual &residual, LinearSystem &system) const
  {
    Sum            sum;
    Blocks         blocks;
    ProjectedPoint point; // kept: its lists are of the same lengths everywhere
    for (const AveragedJump::Face &face : averaged_.faces())
    {
      blocks.clear();
      add_face(face, residual, point, blocks);
      add_to(sum, blocks);
    }
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
    {
      const unsigned int p = surfaces_.pair(s);
      if (!surfaces_.is_owned(s) || !is_active(residual, s) ||
          !(geometry_.rigid[p] != nullptr || pairing_[s].master.found()))
        continue;
      blocks.clear();
      if (pairs_[p].scheme != ContactPairParameters::Scheme::averaged)
        add_site(s, residual, blocks);
      add_turn(s, state, residual, blocks);
      add_to(sum, blocks);
    }
    write(sum, state, system);
  }

} // namespace Nodus
