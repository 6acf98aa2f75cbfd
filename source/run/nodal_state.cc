#include "run/nodal_state.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

// The committed state as vectors of the nodes, which a checkpoint and a new mesh take over.

namespace Nodus
{
  /// Of the slave nodes; those of the integration point scheme have the mean of the points around them. Right at own
  /// nodes. Collective.
  std::vector<SiteState> ContactProblem::Implementation::node_states() const
  {
    std::vector<SiteState> states(surfaces->slave_nodes().size(), SiteState{});
    std::vector<double>    sums((n_site + 1) * states.size(), 0.);
    const unsigned int     rank = dealii::Utilities::MPI::this_mpi_process(communicator);
    for (const ContactPoint &point : weights.points())
      if (point.site != dealii::numbers::invalid_unsigned_int && point.owner == rank)
      {
        const SiteState here =
            site_state(status->kept(point.site), committed_site_force[point.site], committed_site_jump[point.site]);
        for (unsigned int a = 0; a < point.slaves.size(); ++a)
        {
          double *const sum  = sums.data() + (n_site + 1) * point.slaves[a];
          const double  part = point.weight * std::abs(point.shape[a]);
          for (unsigned int i = 0; i < n_site; ++i)
            sum[i] += part * here[i];
          sum[n_site] += part;
        }
      }
    surfaces->slave_exchange().sum(sums, n_site + 1);
    for (unsigned int k = 0; k < states.size(); ++k)
      if (surfaces->has_status(k))
        states[k] = site_state(status->kept(k), committed_site_force[k], committed_site_jump[k]);
      else if (const double *const sum = sums.data() + (n_site + 1) * k; sum[n_site] > 0.)
        for (unsigned int i = 0; i < n_site; ++i)
          states[k][i] = sum[i] / sum[n_site];
    return states;
  }

  /// The states of integration points on a new mesh, from those of the slave nodes as nodal_state() has them.
  std::vector<SiteState> ContactProblem::Implementation::interpolated_sites(const std::vector<Vector> &vectors) const
  {
    std::vector<SiteState> sites(surfaces->n_sites(), SiteState{});
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
      for (unsigned int i = 0; i < n_site; ++i)
        sites[k][i] = vectors[n_displacement_vectors + i / dim](surfaces->nodes()[k].dofs[i % dim]);
    std::vector<SiteState> nodes(sites.begin(), sites.begin() + surfaces->slave_nodes().size());
    surfaces->slave_exchange().update(nodes);
    for (unsigned int s = nodes.size(); s < sites.size(); ++s)
    {
      const SlavePoint  &point = surfaces->point(s);
      const SurfaceFace &face  = surfaces->slave_faces(point.pair)[point.face];
      const auto         shape = face.slave_values(FaceShape(surfaces->degree(), point.xi, point.eta).value);
      for (unsigned int a = 0; a < face.slaves.size(); ++a)
        for (unsigned int i = 0; i < n_site; ++i)
          sites[s][i] += shape[a] * nodes[face.slaves[a]][i];
    }
    return sites;
  }

  /// The committed state as vectors like the displacement, which is the first of them: what a checkpoint and a new mesh
  /// take over. States of integration points are not among it. @p in_space: friction multipliers are vectors in space,
  /// to be interpolated; otherwise components, to be kept to the last digit.
  std::vector<Vector> ContactProblem::Implementation::nodal_state(const bool in_space) const
  {
    std::vector<Vector> vectors = {committed.block(0), reaction, committed_applied};
    for (unsigned int n = 0; n < n_node_vectors; ++n)
      vectors.emplace_back(surfaces->layout().owned[0], communicator);
    const std::vector<SiteState> means = in_space ? node_states() : std::vector<SiteState>();
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
    {
      NodeState       state{};
      const SiteState site =
          in_space ? means[k] : site_state(status->kept(k), committed_site_force[k], committed_site_jump[k]);
      const DoFIndex multiplier = surfaces->multiplier(k);
      double        *value      = std::copy(site.begin(), site.end(), state.begin());
      *value++                  = committed.block(1)(multiplier);
      Vector3 Lambda;
      for (unsigned int i = 0; i < 2; ++i)
        if (const double component = committed.block(2)(2 * multiplier + i); in_space)
          Lambda += component * committed_pairing[k].tangent[i];
        else
          Lambda[i] = component;
      value    = std::copy(Lambda.begin_raw(), Lambda.end_raw(), value);
      *value++ = committed_area.empty() ? 0. : committed_area[k];
      for (const Vector3 &tangent : committed_pairing[k].tangent)
        value = std::copy(tangent.begin_raw(), tangent.end_raw(), value);
      for (unsigned int i = 0; i < state.size(); ++i)
        vectors[n_displacement_vectors + i / dim](surfaces->nodes()[k].dofs[i % dim]) = state[i];
    }
    for (unsigned int n = 0; n < n_node_vectors; ++n)
      vectors[n_displacement_vectors + n].compress(dealii::VectorOperation::insert);
    return vectors;
  }

  /// Takes back what nodal_state() gave, and the states of integration points among @p sites (number of all sites).
  void ContactProblem::Implementation::set_nodal_state(const std::vector<Vector> &vectors,
                                                       const bool                 in_space,
                                                       std::vector<SiteState>     sites)
  {
    committed.block(0) = vectors[0];
    reaction           = vectors[1];
    committed_applied  = vectors[2];
    std::vector<std::array<Vector3, 2>> tangents(surfaces->n_sites());
    committed_area.assign(surfaces->slave_nodes().size(), 0.);
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
    {
      NodeState state;
      for (unsigned int i = 0; i < state.size(); ++i)
        state[i] = vectors[n_displacement_vectors + i / dim](surfaces->nodes()[k].dofs[i % dim]);
      if (!in_space || surfaces->has_status(k))
        std::copy_n(state.begin(), n_site, sites[k].begin());
      else
        sites[k] = SiteState{}; // the points have taken it over
      const double  *value           = state.data() + n_site;
      const DoFIndex multiplier      = surfaces->multiplier(k);
      committed.block(1)(multiplier) = *value++;
      Vector3 Lambda;
      for (unsigned int c = 0; c < dim; ++c)
        Lambda[c] = *value++;
      committed_area[k] = *value++;
      for (Vector3 &tangent : tangents[k])
        for (unsigned int c = 0; c < dim; ++c)
          tangent[c] = *value++;
      for (unsigned int i = 0; i < 2; ++i)
      {
        if (!in_space)
        {
          committed.block(2)(2 * multiplier + i) = Lambda[i];
          continue;
        }
        // on a new mesh the tangents lie between those of other nodes
        if (i == 1)
          tangents[k][1] -= (tangents[k][1] * tangents[k][0]) * tangents[k][0];
        if (const double norm = tangents[k][i].norm(); norm > 0.)
          tangents[k][i] /= norm;
        committed.block(2)(2 * multiplier + i) = Lambda * tangents[k][i];
      }
    }
    for (unsigned int b = 1; b < 3; ++b)
      committed.block(b).compress(dealii::VectorOperation::insert);
    const double largest =
        committed_area.empty() ? 0. : *std::max_element(committed_area.begin(), committed_area.end());
    if (dealii::Utilities::MPI::max(largest, communicator) == 0.)
      committed_area.clear(); // pressures on a mesh that has not seen equilibrium
    committed_pairing.set_tangents(tangents);
    // between sites in contact alone, which have a partner
    const auto                  is_one = [](const double value) { return std::abs(value - 1.) < 1e-6; };
    std::vector<Status::Record> records(sites.size());
    mesh_is_new = in_space;
    jump_known.assign(sites.size(), false);
    for (unsigned int s = 0; s < sites.size(); ++s)
    {
      std::copy_n(sites[s].begin(), n_status, records[s].begin());
      std::copy_n(sites[s].begin() + n_status, dim, committed_site_force[s].begin_raw());
      std::copy_n(sites[s].begin() + n_status + dim, dim, committed_site_jump[s].begin_raw());
      jump_known[s] = is_one(sites[s][0]);
    }
    kept_jump = committed_site_jump;
    status->restore(records);
  }
} // namespace Nodus
