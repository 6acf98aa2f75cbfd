#include "contact/site_values.h"

#include <algorithm>

namespace Nodus
{
  namespace
  {
    using Components = std::vector<std::array<double, 2>>;

    /// A field of tangent vectors at the slave nodes, at all sites.
    Components site_friction(const ContactSurfaces &surfaces,
                             const Pairing         &pairing,
                             const SurfaceWeights  &weights,
                             const Status          &status,
                             const Components      &nodal)
    {
      // Nodes compare components in their own frames, as their weights do; points compare vectors in space.
      Components          result(surfaces.n_sites(), {{0., 0.}});
      std::vector<double> component(nodal.size());
      for (unsigned int i = 0; i < 2; ++i)
      {
        for (unsigned int k = 0; k < component.size(); ++k)
          component[k] = status.friction(k) ? nodal[k][i] : 0.;
        component = weights.weighted(component);
        for (unsigned int k = 0; k < component.size(); ++k)
          result[k][i] = component[k];
      }
      for (const ContactPoint &point : weights.points())
        if (point.site != dealii::numbers::invalid_unsigned_int)
        {
          Vector3 Lambda;
          for (unsigned int a = 0; a < point.slaves.size(); ++a)
            for (unsigned int i = 0; i < 2; ++i)
              Lambda += point.shape[a] * nodal[point.slaves[a]][i] * pairing[point.slaves[a]].tangent[i];
          for (unsigned int i = 0; i < 2; ++i)
            result[point.site][i] = Lambda * pairing[point.site].tangent[i];
        }
      return result;
    }
    /// How the elastic slip of the slave nodes has changed in the increment (eq. F4), in the scale of the slip.
    Components nodal_elastic_slip(const Pairing &pairing, const Status &status, const ContactState &state)
    {
      Components change(state.Lambda.size(), {{0., 0.}});
      for (unsigned int k = 0; k < change.size(); ++k)
        if (const double length = status.elastic_slip(k); length > 0.)
          for (unsigned int i = 0; i < 2; ++i)
            if (pairing[k].tangent_free[i])
              change[k][i] = length * state.Lambda[k][i] - state.elastic_slip[k] * pairing[k].tangent[i];
      return change;
    }
  } // namespace

  std::vector<double> site_pressure(const ContactSurfaces     &surfaces,
                                    const SurfaceWeights      &weights,
                                    const Status              &status,
                                    const std::vector<double> &lambda)
  {
    std::vector<double> pressure(surfaces.n_sites(), 0.), closed(lambda);
    for (const ContactPoint &point : weights.points())
      if (point.site != dealii::numbers::invalid_unsigned_int)
        for (unsigned int a = 0; a < point.slaves.size(); ++a)
          pressure[point.site] += point.shape[a] * lambda[point.slaves[a]];
    for (unsigned int k = 0; k < closed.size(); ++k)
      if (!status.contact(k))
        closed[k] = 0.;
    const std::vector<double> mean = weights.weighted(closed);
    for (unsigned int k = 0; k < mean.size(); ++k)
      pressure[k] = status.contact(k) ? mean[k] : 0.; // no part of its neighbours' traction acts on an open node
    surfaces.site_exchange().update(pressure);
    return pressure;
  }

  std::vector<double> friction_pressure(const ContactSurfaces  &surfaces,
                                        const Pairing          &pairing,
                                        const SurfaceWeights   &weights,
                                        const Status           &status,
                                        const ContactAssembler &assembler,
                                        const ContactState     &state)
  {
    std::vector<double> pressure = site_pressure(surfaces, weights, status, state.lambda);
    for (unsigned int s = 0; s < pressure.size(); ++s)
      if (status.projected(s))
        pressure[s] = status.contact(s) && pairing[s].found
                          ? std::min(0., pressure[s] - status.normal_augmentation(s) * assembler.distance(state, s))
                          : 0.;
    return pressure;
  }

  std::vector<double> site_overclosures(const ContactSurfaces     &surfaces,
                                        const Status              &status,
                                        const std::vector<double> &pressure,
                                        const std::vector<double> &lambda)
  {
    std::vector<double> overclosures(surfaces.n_sites(), 0.);
    for (unsigned int s = 0; s < overclosures.size(); ++s)
    {
      const double at_site = !status.contact(s) ? 0. : surfaces.is_point(s) ? pressure[s] : lambda[s];
      overclosures[s]      = closure_at(status.pressure_gap_law(s), at_site).overclosure;
    }
    return overclosures;
  }

  std::vector<std::array<double, 2>> elastic_slip_change(const ContactSurfaces &surfaces,
                                                         const Pairing         &pairing,
                                                         const SurfaceWeights  &weights,
                                                         const Status          &status,
                                                         const ContactState    &state)
  {
    if (!status.has_elastic_slip())
      return Components(surfaces.n_sites(), {{0., 0.}});
    Components change = site_friction(surfaces, pairing, weights, status, nodal_elastic_slip(pairing, status, state));
    for (unsigned int s = 0; s < change.size(); ++s)
      for (unsigned int i = 0; i < 2; ++i)
        change[s][i] = pairing[s].tangent_free[i] ? change[s][i] / pairing[s].friction_scale[i] : 0.;
    return change;
  }

  StatusInput status_input(const std::vector<ContactPairParameters> &pairs,
                           const ContactSurfaces                    &surfaces,
                           const Pairing                            &pairing,
                           const SurfaceWeights                     &weights,
                           const Status                             &status,
                           const ContactAssembler                   &assembler,
                           const ContactState                       &state)
  {
    StatusInput input;
    input.pressure = site_pressure(surfaces, weights, status, state.lambda);
    if (status.has_friction())
      input.Lambda = site_friction(surfaces, pairing, weights, status, state.Lambda);
    else
      input.Lambda.assign(surfaces.n_sites(), {{0., 0.}});
    const bool       elastic = status.has_elastic_slip();
    const Components nodal   = elastic ? nodal_elastic_slip(pairing, status, state) : Components();
    const Components at_site = elastic ? site_friction(surfaces, pairing, weights, status, nodal) : Components();
    const std::vector<double> overclosures = site_overclosures(surfaces, status, input.pressure, state.lambda);
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      const bool raw =
          !surfaces.is_point(s) && pairs[surfaces.pair(s)].status_test == ContactPairParameters::StatusTest::raw;
      if (raw)
      {
        input.pressure[s] = status.contact(s) ? state.lambda[s] : 0.;
        input.Lambda[s]   = state.Lambda[s];
      }
      // without partner or status there is no distance: keep the test on the open side
      const bool tested = pairing[s].found && surfaces.has_status(s);
      input.distance.push_back(tested ? assembler.distance(state, s) - overclosures[s] : 0.);
      input.slip.push_back(assembler.slip(state, s));
      for (unsigned int i = 0; i < 2; ++i)
      {
        input.slip.back()[i] *= pairing[s].friction_scale[i];
        if (elastic)
          input.slip.back()[i] -= raw ? nodal[s][i] : at_site[s][i];
      }
      if (!tested)
        input.pressure[s] = 0.;
    }
    return input;
  }

  Vector3 prescribed_motion(const ContactSurfaces      &surfaces,
                            const Pairing              &pairing,
                            const JumpOperator         &jump,
                            const std::vector<Vector3> &increment,
                            const unsigned int          site)
  {
    const auto &[face, xi, eta] = pairing[site].master;
    if (!pairing[site].master.found())
      return jump.jump_of_increment(site, increment);
    const auto mean = [&](const std::vector<unsigned int> &nodes, const FaceShape &shape)
    {
      Vector3 result, sum;
      for (unsigned int n = 0; n < shape.n; ++n)
        for (unsigned int c = 0; c < dim; ++c)
          if (surfaces.fixed(nodes[n], c))
          {
            result[c] += shape.value[n] * increment[nodes[n]][c];
            sum[c] += shape.value[n];
          }
      for (unsigned int c = 0; c < dim; ++c)
        result[c] /= sum[c] != 0. ? sum[c] : 1.;
      return result;
    };
    const unsigned int p      = surfaces.pair(site);
    const Vector3      master = mean(surfaces.master_faces(p)[face].nodes, FaceShape(surfaces.degree(), xi, eta));
    if (!surfaces.is_point(site))
      return increment[surfaces.slave_nodes()[site].node] - master;
    const SlavePoint &at = surfaces.point(site);
    return mean(surfaces.slave_faces(p)[at.face].nodes, FaceShape(surfaces.degree(), at.xi, at.eta)) - master;
  }
} // namespace Nodus
