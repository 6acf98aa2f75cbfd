#include "contact/geometry_tangent.h"
#include "contact/varied_faces.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int no_site = dealii::numbers::invalid_unsigned_int;

    Eigen::RowVector3d eigen(const Vector3 &v)
    {
      return {v[0], v[1], v[2]};
    }
    Eigen::Matrix3d eigen(const dealii::Tensor<2, dim> &m)
    {
      Eigen::Matrix3d result;
      for (unsigned int i = 0; i < dim; ++i)
        result.row(i) = eigen(m[i]);
      return result;
    }
    dealii::Tensor<2, dim> identity()
    {
      return dealii::unit_symmetric_tensor<dim>();
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
      , sources_(surfaces, geometry)
      , gap_rows_(surfaces.n_sites())
      , weight_(surfaces.n_sites(), 0.)
  {
    for (const ContactPoint &point : weights_.points())
    {
      if (point.site == no_site && point.slaves.size() == 1)
        weight_[point.slaves[0]] = point.weight;
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
  }

  void GeometryTangent::vary(const unsigned int     site,
                             const ContactState    &state,
                             const ContactResidual &residual,
                             const bool             follows,
                             VariedFaces           &faces,
                             SiteVariation         &variation,
                             GeometryCouplings     &couplings) const
  {
    variation.clear();
    for (const JumpOperator::Entry *e = jump_.begin(site); e != jump_.end(site); ++e)
    {
      variation.node(e->node);
      variation.column(e->node);
    }
    const std::vector<NodeDerivative> normal =
        has_mean_normal(site) ? mean_normal_derivative(site, faces) : normal_derivative(site);
    for (const NodeDerivative &d : normal)
      variation.column(d.node);
    if (averages(site))
    {
      faces.for_each(site, [&](const FaceVariation &face, unsigned int, double) { variation.number(surfaces_, face); });
      variation.allocate();
      faces.for_each(site,
                     [&](const FaceVariation &face, const unsigned int a, const double part)
                     {
                       variation.add_face(surfaces_, face, a, part);
                       add_parts(site, face, a, part, couplings);
                     });
      variation.take_means(averaged_.row(site));
      faces.done(site);
    }
    else
    {
      const auto motion = projection_motion(site);
      add_projection(site, motion, variation);
    }
    for (const NodeDerivative &d : normal)
      variation.add(variation.normal(), variation.column(d.node), d.value);

    const Eigen::RowVectorXd gap = gap_variation(site, state, variation);
    for (const auto &[k, coefficient] : gap_rows_[site])
      couplings.add_gap(k, variation.columns(), coefficient * gap);
    if (weight_[site] > 0. && status_.contact(site))
      if (const double compliance = closure_at(status_.pressure_gap_law(site), state.lambda[site]).compliance;
          compliance > 0.) // the pressure of a force that is kept
        couplings.add_gap(
            site, variation.columns(), compliance * state.lambda[site] * variation.rows().row(variation.area()));
    if (jump_.middle(site) != jump_.end(site))
    {
      const unsigned int p = surfaces_.pair(site);
      variation.balance(jump_, surfaces_, site, geometry_.master[p], pairing_[site], geometry_.slave[p].positions());
    }
    couple(site, state, residual, law(site, state, residual, follows), variation, couplings);
  }

  void GeometryTangent::add_parts(const unsigned int   site,
                                  const FaceVariation &face,
                                  const unsigned int   a,
                                  const double         part,
                                  GeometryCouplings   &couplings) const
  {
    Matrix gap(1, 3 * face.parts().size());
    for (unsigned int i = 0; i < face.parts().size(); ++i)
      gap.middleCols<3>(3 * i) =
          part * face.part_weight(a, i) / averaged_.row(site).area * eigen(pairing_[site].normal);
    for (const auto &[k, coefficient] : gap_rows_[site])
      couplings.add_gap(k, face.parts(), coefficient * gap);
  }

  Eigen::RowVectorXd GeometryTangent::gap_variation(const unsigned int   site,
                                                    const ContactState  &state,
                                                    const SiteVariation &variation) const
  {
    const Vector3      n    = pairing_[site].normal;
    const Matrix      &rows = variation.rows();
    Vector3            jump = jump_.jump(site, state.x);
    Eigen::RowVectorXd gap  = eigen(n) * rows.middleRows<3>(variation.offset());
    for (unsigned int e = 0; e < variation.nodes().size(); ++e)
      gap += n * state.x[variation.nodes()[e]] * rows.row(e);
    if (jump_.middle(site) != jump_.end(site)) // last term of eq. G13: at fixed geometry the weights are balanced ones
    {
      Vector3 beside;
      for (const JumpOperator::Entry *e = jump_.begin(site); e != jump_.end(site); ++e)
      {
        const double change = e->unbalanced - e->weight;
        beside += change * (state.x[e->node] - state.x[jump_.begin(site)->node]);
        gap.segment<3>(3 * variation.place_of_source(e->node)) += change * eigen(n);
      }
      jump += beside - (n * beside) * n;
    }
    gap += eigen(jump) * rows.middleRows<3>(variation.normal());
    return gap;
  }

  void GeometryTangent::couple(const unsigned int     site,
                               const ContactState    &state,
                               const ContactResidual &residual,
                               const Law             &law,
                               const SiteVariation   &variation,
                               GeometryCouplings     &couplings) const
  {
    const Matrix &rows = variation.rows();
    const auto    area = rows.row(variation.area());
    Matrix        slip = -rows.middleRows<3>(variation.moved());
    for (unsigned int e = 0; e < variation.nodes().size(); ++e)
      slip += eigen(state.increment[variation.nodes()[e]]).transpose() * rows.row(e);
    const auto   normal = rows.middleRows<3>(variation.normal());
    const bool   turns  = status_.has_friction(surfaces_.pair(site)) && jump_.middle(site) != jump_.end(site);
    const Matrix lever  = turns ? lever_variation(site, state, variation) : Matrix();
    const auto   turn   = [&](const JumpOperator::Entry *const e) -> Matrix // times lever
    {
      Matrix result = eigen(e->turn).transpose() * lever;
      if (jump_.lever(site) != 0.)
        result += jump_.lever(site) * variation.turns().middleRows<3>(3 * (e - jump_.middle(site)));
      return result;
    };
    for (const JumpOperator::Entry *e = jump_.middle(site); e != jump_.end(site) && turns; ++e)
      slip += pairing_[site].normal * state.increment[e->node] * turn(e) +
              jump_.lever(site) * eigen(e->turn).transpose() * (eigen(state.increment[e->node]) * normal);

    const Matrix turned =
        eigen(law.force_normal) * normal + eigen(law.force_slip) * slip + eigen(law.force_area).transpose() * area;
    const Eigen::Vector3d                    force = eigen(residual.jump[site]).transpose();
    const Eigen::Vector3d                    along = eigen(pairing_[site].normal).transpose();
    std::vector<const JumpOperator::Entry *> entry(variation.nodes().size(), nullptr);
    for (const JumpOperator::Entry *e = jump_.begin(site); e != jump_.end(site); ++e)
      entry[variation.place_of_node(e->node)] = e;
    Matrix block(dim, rows.cols());
    for (unsigned int i = 0; i < variation.nodes().size(); ++i)
    {
      block = force * rows.row(i);
      if (const JumpOperator::Entry *const e = entry[i])
      {
        block += e->weight * turned;
        if (turns && e >= jump_.middle(site))
          block += along * (jump_.lever(site) * eigen(e->turn) * turned + force.transpose() * turn(e)) +
                   jump_.lever(site) * (e->turn * residual.jump[site]) * normal;
      }
      couplings.add_force(variation.nodes()[i], variation.columns(), block);
    }
    if (weight_[site] > 0. && status_.friction(site))
    {
      Matrix friction(2, rows.cols());
      for (unsigned int i = 0; i < 2; ++i)
        friction.row(i) = eigen(law.row_normal[i]) * normal + eigen(law.row_slip[i]) * slip + law.row_area[i] * area;
      couplings.add_friction(site, variation.columns(), friction);
    }
  }

  /// Variation of the lever of a site (eq. G33).
  GeometryTangent::Matrix GeometryTangent::lever_variation(const unsigned int   site,
                                                           const ContactState  &state,
                                                           const SiteVariation &variation) const
  {
    const Vector3 &n      = pairing_[site].normal;
    const Point   &origin = state.x[jump_.begin(site)->node];
    const Matrix  &rows   = variation.rows();
    Matrix         lever  = Matrix::Zero(1, rows.cols());
    Vector3        apart;
    for (unsigned int e = 0; e < variation.nodes().size(); ++e)
      lever += n * (state.x[variation.nodes()[e]] - origin) * rows.row(e);
    for (const JumpOperator::Entry *e = jump_.begin(site); e != jump_.end(site); ++e)
    {
      lever.middleCols<3>(3 * variation.place_of_source(e->node)) += e->weight * eigen(n);
      apart += e->weight * (state.x[e->node] - origin);
    }
    lever += eigen(apart) * rows.middleRows<3>(variation.normal());
    return lever;
  }

  /// With the rule of Pairing: the first tangent is the projection of a fixed direction, or lies across the held one.
  std::array<dealii::Tensor<2, dim>, 2> GeometryTangent::tangent_derivatives(const unsigned int site) const
  {
    const SitePairing     &frame = pairing_[site];
    const auto            &pair  = pairs_[surfaces_.pair(site)];
    const Vector3         &n = frame.normal, &t = frame.tangent[0], &s = frame.tangent[1];
    std::array<Matrix3, 2> result;
    if (!frame.tangent_free[0])
      return result;
    if (!frame.tangent_free[1])
    {
      const Vector3 in_plane = dealii::cross_product_3d(t, s);
      result[0]              = -1. / (n * in_plane) * dealii::outer_product(in_plane, t);
      return result;
    }
    Vector3 along;
    along[std::abs(n[0]) > 0.999 ? 2 : 0] = 1.;
    if (pair.second_friction_coefficient > 0.)
    {
      const Vector3 direction = pair.friction_direction / pair.friction_direction.norm();
      if ((direction - (direction * n) * n).norm() > 1e-6)
        along = direction;
    }
    const double spin = (along * n) / (along - (along * n) * n).norm();
    result[0]         = -dealii::outer_product(n, t) - spin * dealii::outer_product(s, s);
    result[1]         = -dealii::outer_product(n, s) + spin * dealii::outer_product(t, s);
    return result;
  }

  namespace
  {
    /// The part of @p v along the tangents that carry friction.
    Vector3 in_plane(const SitePairing &frame, const Vector3 &v)
    {
      Vector3 result;
      for (unsigned int i = 0; i < 2; ++i)
        if (frame.tangent_free[i])
          result += (v * frame.tangent[i]) * frame.tangent[i];
      return result;
    }

    /// How the sum of scale_i (v . t_i) t_i follows the normal, with which the tangents turn (eq. G14).
    dealii::Tensor<2, dim> turning(const SitePairing                           &frame,
                                   const std::array<double, 2>                 &scale,
                                   const std::array<dealii::Tensor<2, dim>, 2> &turn,
                                   const Vector3                               &v)
    {
      dealii::Tensor<2, dim> result;
      for (unsigned int i = 0; i < 2; ++i)
        if (frame.tangent_free[i])
          result +=
              scale[i] * (dealii::outer_product(frame.tangent[i], v * turn[i]) + (v * frame.tangent[i]) * turn[i]);
      return result;
    }
  } // namespace

  GeometryTangent::Law GeometryTangent::law(const unsigned int     site,
                                            const ContactState    &state,
                                            const ContactResidual &residual,
                                            const bool             follows) const
  {
    const Vector3 n = pairing_[site].normal, r = residual.jump[site];
    Law           law;
    law.force_normal = (r * n) * identity();
    if (weight_[site] > 0. && status_.friction(site))
      add_friction(site, state, follows, law);
    else // delta r = (r.n) delta n - n (r_tau . delta n)
      law.force_normal -= dealii::outer_product(n, r - (r * n) * n);
    return law;
  }

  /// How the contact law (contact_law.cc) of a point with one node follows normal, slip and area (eqs. G14-G16).
  void
  GeometryTangent::add_friction(const unsigned int site, const ContactState &state, const bool follows, Law &law) const
  {
    const SitePairing           &frame     = pairing_[site];
    const std::array<Matrix3, 2> turn      = tangent_derivatives(site);
    const double                 threshold = status_.threshold(site), area = weight_[site], factor = area * threshold;
    const auto                  &Lambda = state.Lambda[site];
    const Vector3                jump   = jump_.jump_of_increment(site, state.increment);
    Vector3                      direction;         // Lambda as a vector in space
    Matrix3                      projector, turned; // turned: how the caller turns it with the frame
    for (unsigned int i = 0; i < 2; ++i)
      if (frame.tangent_free[i])
      {
        direction += Lambda[i] * frame.tangent[i];
        projector += frame.friction_scale[i] * dealii::outer_product(frame.tangent[i], frame.tangent[i]);
        turned += Lambda[i] * turn[i];
      }
    if (frame.tangent_free[1])
      turned += dealii::outer_product(Lambda[1] * frame.tangent[0] - Lambda[0] * frame.tangent[1],
                                      frame.tangent[1] * turn[0]);
    const Vector3 &before    = state.elastic_slip[site]; // adds to the slip (eq. F4)
    const double   elastic   = status_.elastic_slip(site);
    const Vector3  memory    = in_plane(frame, before);
    const auto     projected = [&](const Vector3 &v) { return turning(frame, frame.friction_scale, turn, v); };

    if (status_.stick(site))
    {
      law.force_normal -= factor * (projected(direction) + projector * turned);
      law.force_area = -threshold * (projector * direction);
      for (unsigned int i = 0; i < 2; ++i)
        if (frame.tangent_free[i])
        {
          law.row_slip[i]   = -factor * frame.friction_scale[i] * frame.tangent[i];
          law.row_normal[i] = -factor * (frame.friction_scale[i] * (jump * turn[i]) + before * turn[i]);
          if (elastic > 0. && frame.tangent_free[1 - i]) // components that are carried over with the frame
            law.row_normal[i] += factor * elastic * (i == 0 ? 1. : -1.) * Lambda[1 - i] * (frame.tangent[1] * turn[0]);
        }
      return;
    }
    const double followed = follows ? status_.threshold_slope(site) * state.lambda[site] : 0.;
    const double h        = status_.tangential_augmentation(site, threshold);
    const bool   held     = status_.holds_friction(site);
    Vector3      pi       = direction;
    Matrix3      K_B;
    if (!held)
    {
      const Vector3 w    = direction + h * (projector * jump + memory);
      const double  norm = w.norm();
      K_B                = identity();
      pi                 = w;
      if (norm >= 1. - 1e-7) // as in the contact law (eq. 48)
      {
        pi  = w / norm;
        K_B = unit_derivative(w);
      }
    }
    // pi follows Lambda, the slip and h, which is inverse to the threshold
    const Matrix3 by_normal =
        held ? turned : Matrix3(K_B * (turned + h * (projected(jump) + turning(frame, {{1., 1.}}, turn, before))));
    const Matrix3 by_slip = h * K_B * projector;
    const Vector3 by_area = h * followed / (threshold * area) * (K_B * (projector * jump + memory));
    law.force_normal -= factor * (projected(pi) + projector * by_normal);
    law.force_slip = -factor * projector * by_slip;
    law.force_area = -(threshold - followed) * (projector * pi) - factor * (projector * by_area);
    for (unsigned int i = 0; i < 2 && !held; ++i)
      if (frame.tangent_free[i])
      {
        law.row_normal[i] = factor / h * ((direction - pi) * turn[i] + frame.tangent[i] * (turned - by_normal));
        law.row_slip[i]   = -factor / h * (frame.tangent[i] * by_slip);
        law.row_area[i]   = -factor / h * (frame.tangent[i] * by_area);
      }
  }

  void GeometryTangent::add(const ContactState &state, const ContactResidual &residual, LinearSystem &system) const
  {
    using Wanted = VariedFaces::Wanted;
    std::vector<Wanted> active(surfaces_.n_sites(), Wanted::nothing);
    for (unsigned int s = 0; s < active.size(); ++s)
      if (surfaces_.is_owned(s) && pairing_[s].found && residual.jump[s].norm_square() > 0. &&
          (averages(s) || geometry_.rigid[surfaces_.pair(s)] != nullptr || pairing_[s].master.found()))
        active[s] = has_mean_normal(s) ? Wanted::row_and_normal : Wanted::row;
    const bool        follows = !system.symmetric;
    VariedFaces       faces(pairs_, surfaces_, geometry_, averaged_, sources_, active);
    SiteVariation     variation(surfaces_.nodes().size(), sources_.size());
    GeometryCouplings couplings(surfaces_, sources_);
    for (unsigned int s = 0; s < active.size(); ++s)
      if (active[s] != Wanted::nothing)
        vary(s, state, residual, follows, faces, variation, couplings);
    couplings.write(state, system);
  }
} // namespace Nodus
