#include "contact/face_rule.h"
#include "contact/surface.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

// The sites of the slave side: nodes and points, and their numbers.

namespace Nodus
{
  namespace
  {
    /// Sites are numbered by face and place on the face; no rule has as many points.
    constexpr DoFIndex places_on_face = 1024;
  } // namespace

  void ContactSurfaces::take_slave_faces()
  {
    std::vector<FaceRecord> records;
    for (unsigned int p = 0; p < n_pairs(); ++p)
      records.insert(records.end(), directory_.own(p, slave_side).begin(), directory_.own(p, slave_side).end());
    directory_.add_layer(records);
    for (const FaceRecord &record : directory_.at_own_nodes())
      if (record.side == slave_side)
        records.push_back(record);
    make_unique(records);

    // Own nodes first; their degrees of freedom are a range of the global ones.
    struct Place
    {
      bool          ghost;
      DoFIndex      dof;
      unsigned int  pair;
      const double *X;
    };
    std::vector<Place> places;
    for (const FaceRecord &record : records)
    {
      const auto add = [&](const DoFIndex dof, const double *const X) {
        places.push_back({directory_.owner(dof) != rank_, dof, record.pair, X});
      };
      for (unsigned int n = 0; n < (degree_ + 1) * (degree_ + 1); ++n)
        if (!record.hangs(n))
          add(record.dofs[n][0], record.X[n]);
      for (const auto &follower : record.followers)
        if (follower.share != 0.)
          add(follower.dof, follower.X);
    }
    std::stable_sort(places.begin(),
                     places.end(),
                     [](const Place &a, const Place &b)
                     { return std::make_pair(a.ghost, a.dof) < std::make_pair(b.ghost, b.dof); });
    for (const Place &place : places)
      if (nodes_.empty() || nodes_.back().dofs[0] != place.dof)
      {
        sites_.nodes.push_back({static_cast<unsigned int>(nodes_.size()), place.pair});
        add_node(place.dof, place.X);
        sites_.n_owned_nodes += !place.ghost;
      }
    for (const FaceRecord &record : records)
      add_nodes(record);
    link_followers(records);
    for (const FaceRecord &record : records)
      slave_faces_[record.pair].push_back(make_face(record));
  }

  /// Their nodes are among those of every rank.
  void ContactSurfaces::take_carriers(const Bodies &bodies, const dealii::DoFHandler<dim> &dof_handler)
  {
    for (unsigned int p = 0; p < n_pairs(); ++p)
    {
      if (!pairs_[p].has_carried_master())
        continue;
      RigidCarrier                                    carrier(bodies, pairs_[p].master.body - 1, dof_handler);
      std::array<unsigned int, RigidCarrier::n_nodes> nodes;
      for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        add_node(carrier.dof(i), &carrier.X(i)[0]);
        nodes[i] = node(carrier.dof(i));
      }
      carrier.set_nodes(nodes);
      rigid_masters_[p]->set_carrier(carrier);
    }
    n_slave_side_nodes_ = nodes_.size();
  }

  void ContactSurfaces::make_points()
  {
    for (unsigned int p = 0; p < n_pairs(); ++p)
    {
      if (!sites_.has_points[p])
        continue;
      const dealii::Quadrature<2> rule = face_rule(pairs_[p], degree_);
      for (unsigned int f = 0; f < slave_faces_[p].size(); ++f)
        for (unsigned int q = 0; q < rule.size(); ++q)
          sites_.points.push_back({p, f, rule.point(q)[0], rule.point(q)[1], rule.weight(q)});
    }
  }

  void ContactSurfaces::number_sites()
  {
    sites_.order.assign(n_sites(), std::numeric_limits<DoFIndex>::max());
    DoFIndex     first_face = 0;
    unsigned int site       = sites_.nodes.size();
    for (unsigned int p = 0; p < n_pairs(); ++p)
    {
      const unsigned int n_points = sites_.has_points[p] ? face_rule(pairs_[p], degree_).size() : 0;
      for (const SurfaceFace &face : slave_faces_[p])
      {
        const DoFIndex first = (first_face + face.number) * places_on_face;
        for (unsigned int n = 0; n < face.nodes.size(); ++n)
          if (const unsigned int k = slave_number(face.nodes[n]); k != dealii::numbers::invalid_unsigned_int)
            sites_.order[k] = std::min(sites_.order[k], first + n);
        for (unsigned int q = 0; q < n_points; ++q)
          sites_.order[site++] = first + q;
      }
      first_face += directory_.size(p, slave_side);
    }

    std::vector<DoFIndex>     key;
    std::vector<unsigned int> owner;
    for (const SlaveNode &slave : sites_.nodes)
    {
      key.push_back(nodes_[slave.node].dofs[0]);
      owner.push_back(nodes_[slave.node].owner);
    }
    sites_.node_exchange = GhostExchange(key, owner, communicator_);
    DoFIndex largest     = 0;
    for (const SlaveNode &slave : sites_.nodes)
      largest = std::max(largest, nodes_[slave.node].dofs[0]);
    largest = dealii::Utilities::MPI::max(largest, communicator_);
    for (unsigned int s = sites_.nodes.size(); s < n_sites(); ++s)
    {
      key.push_back(largest + 1 + sites_.order[s]);
      owner.push_back(site_owner(s));
    }
    sites_.exchange = GhostExchange(key, owner, communicator_);
  }

  void ContactSurfaces::make_layout(const dealii::IndexSet &owned_dofs)
  {
    const auto counts = all_gather(communicator_, sites_.n_owned_nodes);
    DoFIndex   first = 0, n = 0;
    for (unsigned int r = 0; r < counts.size(); ++r)
    {
      first += r < rank_ ? counts[r] : 0;
      n += counts[r];
    }
    sites_.multiplier.assign(sites_.nodes.size(), 0);
    for (unsigned int k = 0; k < sites_.n_owned_nodes; ++k)
      sites_.multiplier[k] = first + k;
    sites_.node_exchange.update(sites_.multiplier);

    layout_.communicator  = communicator_;
    layout_.n_u           = owned_dofs.size();
    layout_.n_slave_nodes = n;
    for (unsigned int k = 0; k < sites_.n_owned_nodes; ++k)
      layout_.slave_nodes.push_back(nodes_[k].dofs[0] / dim);
    layout_.owned[0] = owned_dofs;
    layout_.owned[1].set_size(n);
    layout_.owned[1].add_range(first, first + sites_.n_owned_nodes);
    layout_.owned[2].set_size(2 * n);
    layout_.owned[2].add_range(2 * first, 2 * (first + sites_.n_owned_nodes));
  }
} // namespace Nodus
