#include "contact/face_rule.h"
#include "contact/friction_limit.h"
#include "contact/surface.h"
#include "mesh/sides.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>

// The sites of the slave side: nodes and points, their numbers, and what surfaces must not have in common.

namespace Nodus
{
  namespace
  {
    /// Sites are numbered by face and place on the face; no rule has as many points.
    constexpr DoFIndex places_on_face = 1024;
    /// Slave surfaces of two pairs may meet at an edge whose sides are turned by 30 degrees or more.
    constexpr double smooth_seam_cosine = 0.866;
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
      unsigned int  pair, body;
      const double *X;
    };
    std::vector<Place> places;
    for (const FaceRecord &record : records)
    {
      const auto add = [&](const DoFIndex dof, const double *const X) {
        places.push_back({directory_.owner(dof) != rank_, dof, record.pair, record.body, X});
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
                     { return std::tie(a.ghost, a.dof, a.pair) < std::tie(b.ghost, b.dof, b.pair); });
    for (const Place &place : places)
    {
      const bool new_node = nodes_.empty() || nodes_.back().dofs[0] != place.dof;
      if (!new_node && sites_.nodes.back().pair == place.pair)
        continue;
      if (new_node)
      {
        sites_.first_of_node.push_back(sites_.nodes.size());
        add_node(place.dof, place.X, place.body);
      }
      sites_.nodes.push_back({static_cast<unsigned int>(nodes_.size() - 1), place.pair});
      sites_.n_owned_nodes += !place.ghost;
    }
    sites_.first_of_node.push_back(sites_.nodes.size());
    for (const FaceRecord &record : records)
      add_nodes(record);
    link_followers(records);
    for (const FaceRecord &record : records)
      slave_faces_[record.pair].push_back(make_face(record));
  }

  unsigned int ContactSurfaces::slave_number(const unsigned int pair, const unsigned int node) const
  {
    if (node + 1 < sites_.first_of_node.size())
      for (unsigned int k = sites_.first_of_node[node]; k < sites_.first_of_node[node + 1]; ++k)
        if (sites_.nodes[k].pair == pair)
          return k;
    return dealii::numbers::invalid_unsigned_int;
  }

  bool ContactSurfaces::shares_node(const unsigned int slave) const
  {
    const unsigned int node = sites_.nodes[slave].node;
    return sites_.first_of_node[node + 1] - sites_.first_of_node[node] > 1;
  }

  unsigned int ContactSurfaces::n_faces(const unsigned int pair, const SurfaceSide side) const
  {
    return directory_.size(pair, side);
  }

  unsigned int
  ContactSurfaces::own_cell(const unsigned int pair, const SurfaceSide side, const unsigned int number) const
  {
    const auto &own = directory_.own(pair, side);
    return own[number - own[0].number].cell;
  }

  unsigned int ContactSurfaces::n_layers() const
  {
    return sites_.layers.empty() ? 1 : 1 + *std::max_element(sites_.layers.begin(), sites_.layers.end());
  }

  /// The first layer for each pair that no earlier pair that it meets has.
  void ContactSurfaces::find_layers()
  {
    std::vector<unsigned int> meet(n_pairs() * n_pairs(), 0);
    for (unsigned int k = 1; k < sites_.nodes.size(); ++k)
      for (unsigned int l = k; l-- > 0 && sites_.nodes[l].node == sites_.nodes[k].node;)
        meet[sites_.nodes[k].pair * n_pairs() + sites_.nodes[l].pair] = 1;
    dealii::Utilities::MPI::max(meet, communicator_, meet);
    for (unsigned int p = 0; p < n_pairs(); ++p)
    {
      std::set<unsigned int> taken;
      for (unsigned int q = 0; q < p; ++q)
        if (meet[p * n_pairs() + q] + meet[q * n_pairs() + p] > 0)
          taken.insert(sites_.layers[q]);
      unsigned int layer = 0;
      while (taken.count(layer) == 1)
        ++layer;
      sites_.layers.push_back(layer);
    }
  }

  /// Their nodes are among those of every rank.
  void ContactSurfaces::take_carriers(const Bodies &bodies, const dealii::DoFHandler<dim> &dof_handler)
  {
    for (unsigned int p = 0; p < n_pairs(); ++p)
    {
      if (!pairs_[p].has_carried_master())
        continue;
      RigidCarrier                                    carrier(bodies, pairs_[p].master.first_body() - 1, dof_handler);
      std::array<unsigned int, RigidCarrier::n_nodes> nodes;
      for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        add_node(carrier.dof(i), &carrier.X(i)[0], pairs_[p].master.first_body());
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
          if (const unsigned int k = slave_number(p, face.nodes[n]); k != dealii::numbers::invalid_unsigned_int)
            sites_.order[k] = std::min(sites_.order[k], first + n);
        for (unsigned int q = 0; q < n_points; ++q)
          sites_.order[site++] = first + q;
      }
      first_face += directory_.size(p, slave_side);
    }

    std::vector<DoFIndex>     key;
    std::vector<unsigned int> owner;
    DoFIndex                  largest = 0;
    for (const SlaveNode &slave : sites_.nodes)
    {
      key.push_back(nodes_[slave.node].dofs[0] / dim * n_layers() + layers()[slave.pair]);
      owner.push_back(nodes_[slave.node].owner);
      largest = std::max(largest, key.back());
    }
    sites_.node_exchange = GhostExchange(key, owner, communicator_);
    largest              = dealii::Utilities::MPI::max(largest, communicator_);
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
      layout_.slave_nodes.push_back(nodes_[sites_.nodes[k].node].dofs[0] / dim);
    layout_.owned[0] = owned_dofs;
    layout_.owned[1].set_size(n);
    layout_.owned[1].add_range(first, first + sites_.n_owned_nodes);
    layout_.owned[2].set_size(2 * n);
    layout_.owned[2].add_range(2 * first, 2 * (first + sites_.n_owned_nodes));
  }

  void ContactSurfaces::measure_faces()
  {
    const std::vector<Point> X         = positions(std::vector<Vector3>(nodes_.size()));
    const auto               mean_size = [&](const std::vector<std::vector<SurfaceFace>> &faces, const SurfaceSide side)
    {
      std::vector<double> sizes(n_pairs(), 0.);
      for (unsigned int p = 0; p < n_pairs(); ++p)
        for (const auto &face : faces[p])
          if (face.owner == rank_)
            sizes[p] += std::sqrt(FaceGeometry(face, FaceShape(degree_, 0.5, 0.5), X).area_vector().norm());
      dealii::Utilities::MPI::sum(sizes, communicator_, sizes);
      for (unsigned int p = 0; p < n_pairs(); ++p)
        sizes[p] /= std::max(directory_.size(p, side), 1u);
      return sizes;
    };
    face_size_        = mean_size(slave_faces_, slave_side);
    master_face_size_ = mean_size(master_faces_, master_side);
    for (unsigned int p = 0; p < n_pairs(); ++p)
      if (rigid_masters_[p])
        master_face_size_[p] = face_size_[p];
  }

  void ContactSurfaces::gather(const Vector               &u,
                               const std::vector<Vector3> &shortenings,
                               std::vector<Vector3>       &displacements) const
  {
    gather(u, displacements);
    for (unsigned int n = 0; n < held_.section.size(); ++n)
      if (held_.section[n] != dealii::numbers::invalid_unsigned_int)
        displacements[n] -= shortenings[held_.section[n]];
  }

  void ContactSurfaces::set_sections(const std::vector<unsigned int> &of_pairs, const std::vector<Vector3> &axes)
  {
    held_.section_of_pair = of_pairs;
    held_.axes            = axes;
    find_sections();
  }

  /// The nodes of their slave sides, hanging ones and those that these follow included.
  void ContactSurfaces::find_sections()
  {
    held_.section.clear();
    for (unsigned int p = 0; p < held_.section_of_pair.size(); ++p)
    {
      if (held_.section_of_pair[p] == dealii::numbers::invalid_unsigned_int)
        continue;
      held_.section.resize(nodes_.size(), dealii::numbers::invalid_unsigned_int);
      for (const SurfaceFace &face : slave_faces_[p])
        for (const unsigned int node : face.nodes)
        {
          held_.section[node] = held_.section_of_pair[p];
          expand(node,
                 1.,
                 [&](const unsigned int free_node, double) { held_.section[free_node] = held_.section_of_pair[p]; });
        }
    }
  }

  /// Message for a face of this rank that is slave in two pairs, or nothing.
  std::string ContactSurfaces::repeated_slave_face() const
  {
    const unsigned int n_face_nodes = (degree_ + 1) * (degree_ + 1);
    using Ends                      = std::pair<DoFIndex, DoFIndex>; // of a diagonal
    std::map<Ends, unsigned int> pair_of_face;
    for (unsigned int p = 0; p < n_pairs(); ++p)
      if (!pairs_[p].self_contact) // what touches itself may touch others as well
        for (const FaceRecord &face : directory_.own(p, slave_side))
          if (const unsigned int other =
                  pair_of_face.emplace(Ends(face.dofs[0][0], face.dofs[n_face_nodes - 1][0]), p).first->second;
              other != p)
            return pair_label(pairs_, other) + " and " + pair_label(pairs_, p) + " overlap: the face at node " +
                   coordinates(Point(face.X[0][0], face.X[0][1], face.X[0][2])) +
                   " is slave in both; make the slave regions disjoint with 'Slave where', join the pairs, or give one "
                   "pair both masters, as in 'Master body = 2, 3'";
    return "";
  }

  /// Message for a node of this rank where the slave surfaces of two pairs must not meet, or nothing: without an edge
  /// the two constraints would say the same, and where nodes share points, friction could not be told from them.
  std::string ContactSurfaces::refused_meeting() const
  {
    const std::vector<Point> X = reference_positions();
    std::vector<Vector3>     normal(sites_.nodes.size());
    for (unsigned int p = 0; p < n_pairs(); ++p)
      for (const SurfaceFace &face : slave_faces_[p])
      {
        const Vector3 area = face.orientation * FaceGeometry(face, FaceShape(degree_, 0.5, 0.5), X).area_vector();
        for (const unsigned int k : face.slaves)
          normal[k] += area;
      }
    const auto rubs_in_points = [&](const unsigned int slave)
    {
      const ContactPairParameters &pair = pairs_[sites_.nodes[slave].pair];
      return FrictionLimit(pair, 0.).exists() && (pair.scheme == ContactPairParameters::Scheme::integration_point ||
                                                  pair.weights == ContactPairParameters::Weights::consistent);
    };
    for (unsigned int k = 1; k < sites_.n_owned_nodes; ++k)
      for (unsigned int l = k; l-- > 0 && sites_.nodes[l].node == sites_.nodes[k].node;)
      {
        const bool self = pairs_[sites_.nodes[k].pair].self_contact ||
                          pairs_[sites_.nodes[l].pair].self_contact; // never at one place
        const bool smooth = !self && normal[k] * normal[l] > smooth_seam_cosine * normal[k].norm() * normal[l].norm();
        if (!smooth && !rubs_in_points(k) && !rubs_in_points(l))
          continue;
        return pair_label(pairs_, sites_.nodes[l].pair) + " and " + pair_label(pairs_, sites_.nodes[k].pair) +
               " meet at node " + coordinates(nodes_[sites_.nodes[k].node].X) + ", which is slave in both, " +
               (smooth ? "without an edge there; join the pairs, give one pair both masters, as in 'Master body = 2, "
                         "3', or leave faces between them out with 'Slave where'"
                       : "where friction with 'Scheme = integration point' or 'Weights = consistent' cannot be told "
                         "from the other constraint; set 'Scheme = averaged' with other weights");
      }
    return "";
  }

  /// Message for a face of this rank that is slave and master of the same pair, or nothing.
  std::string ContactSurfaces::repeated_face() const
  {
    const unsigned int n_face_nodes = (degree_ + 1) * (degree_ + 1);
    for (unsigned int p = 0; p < n_pairs(); ++p)
      for (const FaceRecord &face : directory_.own(p, master_side))
      {
        bool slave = !pairs_[p].self_contact;
        for (unsigned int n = 0; n < n_face_nodes && slave; ++n)
        {
          const auto at = node_of_dof_.find(face.dofs[n][0]);
          slave         = at != node_of_dof_.end() &&
                  (face.hangs(n) || slave_number(p, at->second) != dealii::numbers::invalid_unsigned_int);
        }
        if (slave)
          return pair_label(pairs_, p) +
                 ": a face is both slave and master; give the two sides different boundary ids or bodies";
      }
    return "";
  }

  std::vector<SurfaceFace> ContactSurfaces::faces_that_are_master_alone(const unsigned int pair) const
  {
    std::vector<SurfaceFace> faces;
    for (const SurfaceFace &face : master_faces_[pair])
      if (is_master_alone(pair, face))
        faces.push_back(face);
    return faces;
  }
} // namespace Nodus
