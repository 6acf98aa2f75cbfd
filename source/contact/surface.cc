#include "contact/surface.h"
#include "base/deal_ii_versions.h"
#include "contact/master_request.h"
#include "contact/walls.h"
#include "mesh/region.h"
#include "parallel/owned_values.h"
#include "parallel/sparse_exchange.h"
#include "parallel/throw_everywhere.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe.h>

#include <algorithm>
#include <set>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Master faces are fetched anew when a node has moved by this part of the smallest mean slave face size.
    constexpr double relative_moves = 0.2;
    /// Walls thicker than so many mean faces are as good as this: surfaces look for themselves half as far.
    constexpr double wall_reach = 4.;

    Region side_region(const std::vector<ContactPairParameters> &pairs,
                       const unsigned int                        pair,
                       const SurfaceSide                         side,
                       const Bodies                             &bodies)
    {
      const bool slave = side == slave_side;
      return Region(slave ? pairs[pair].slave : pairs[pair].master,
                    bodies,
                    pair_label(pairs, pair) + (slave ? ", slave" : ", master"));
    }

    /// The sides of what comes before a pair that touches itself, numbered as in FaceRecord::elsewhere: of pairs that
    /// do not and of later ones; behind the pairs, of bodies that it excludes.
    std::map<unsigned int, Region>
    sides_before(const std::vector<ContactPairParameters> &pairs, const unsigned int pair, const Bodies &bodies)
    {
      std::map<unsigned int, Region> sides;
      if (!pairs[pair].self_contact)
        return sides;
      for (unsigned int q = 0; q < pairs.size(); ++q)
        if (!pairs[q].has_rigid_master() && (!pairs[q].self_contact || q > pair))
          for (const SurfaceSide side : {slave_side, master_side})
            sides.emplace(2 * q + side, side_region(pairs, q, side, bodies));
      unsigned int number = 2 * pairs.size();
      for (const auto &[one, other] : pairs[pair].excluded_bodies)
        for (const unsigned int body : {one, other})
          sides.emplace(number++, Region({{body}, {}, "1"}, bodies, pair_label(pairs, pair) + ", excluded"));
      return sides;
    }
  } // namespace

  ContactSurfaces::ContactSurfaces(const std::vector<ContactPairParameters> &pairs,
                                   const Bodies                             &bodies,
                                   const dealii::DoFHandler<dim>            &dof_handler,
                                   const dealii::Mapping<dim>               &mapping,
                                   std::vector<double>                       stiffness)
      : pairs_(pairs)
      , communicator_(communicator_of(dof_handler))
      , degree_(dof_handler.get_fe().degree)
      , rank_(dealii::Utilities::MPI::this_mpi_process(communicator_))
      , directory_(dof_handler, pairs.size())
      , slave_faces_(pairs.size())
      , master_faces_(pairs.size())
      , acting_(pairs.size(), true)
      , stiffness_(std::move(stiffness))
  {
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      const std::map<unsigned int, Region> elsewhere = sides_before(pairs, p, bodies);
      sites_.has_points.push_back(pairs[p].scheme == ContactPairParameters::Scheme::integration_point);
      directory_.collect(side_region(pairs, p, slave_side, bodies), bodies, mapping, p, slave_side, elsewhere);
      rigid_masters_.push_back(
          pairs[p].has_rigid_master()
              ? std::make_unique<RigidSurface>(pairs[p].master_surface,
                                               pair_label(pairs, p),
                                               pairs[p].surface == ContactPairParameters::Surface::smoothed)
              : nullptr);
      if (!rigid_masters_[p])
        directory_.collect(side_region(pairs, p, master_side, bodies), bodies, mapping, p, master_side, elsewhere);
    }
    directory_.publish();
    throw_everywhere<InputError>(repeated_slave_face(), communicator_);
    for (unsigned int p = 0; p < pairs.size(); ++p)
      for (const auto side : {slave_side, master_side})
        if (directory_.size(p, side) == 0 && (side == slave_side || !rigid_masters_[p]))
          throw InputError(pair_label(pairs, p) + ": the " + (side == slave_side ? "slave" : "master") +
                           " side has no face; check '" + (side == slave_side ? "Slave" : "Master") +
                           " boundary ids' and '" + (side == slave_side ? "Slave" : "Master") + " where'");

    take_slave_faces();
    throw_everywhere<InputError>(refused_meeting(), communicator_);
    find_layers();
    take_carriers(bodies, dof_handler);
    make_points();
    throw_everywhere<InputError>(repeated_face(), communicator_);
    number_sites();
    make_layout(dof_handler.locally_owned_dofs());

    held_.mask.reinit(layout_.owned[0], communicator_);
    fetched_at_.reinit(layout_.owned[0], communicator_);
    std::vector<FaceRecord> own;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      own.insert(own.end(), directory_.own(p, master_side).begin(), directory_.own(p, master_side).end());
    directory_.add_layer(own); // for the normals
    take_master_faces(own);
    measure_faces();
    if (std::any_of(pairs.begin(), pairs.end(), [](const auto &pair) { return pair.self_contact; }))
    {
      walls_ = wall_thickness(*this, wall_reach);
      gather_walls();
    }
    if (dealii::Utilities::MPI::n_mpi_processes(communicator_) > 1 && n_pairs() > 0)
      fetch(std::vector<Vector3>(nodes_.size()));
  }

  /// Unless it is there.
  void ContactSurfaces::add_node(const DoFIndex dof, const double *const X, const unsigned int body)
  {
    if (!node_of_dof_.emplace(dof, nodes_.size()).second)
      return;
    nodes_.emplace_back();
    SurfaceNode &node = nodes_.back();
    for (unsigned int c = 0; c < dim; ++c)
    {
      node.dofs[c] = dof + c;
      node.X[c]    = X[c];
    }
    node.owner = directory_.owner(dof);
    node.body  = body;
  }

  void ContactSurfaces::add_nodes(const FaceRecord &record)
  {
    for (unsigned int n = 0; n < (degree_ + 1) * (degree_ + 1); ++n)
      add_node(record.dofs[n][0], record.X[n], record.body);
    for (const FaceRecord::Follower &follower : record.followers)
      add_node(follower.dof, follower.X, record.body);
    if (pairs_[record.pair].self_contact)
      for (unsigned int n = 0; n < 4; ++n)
        add_node(record.across[n], record.X_across[n], record.body);
  }

  void ContactSurfaces::link_followers(const std::vector<FaceRecord> &records)
  {
    for (const FaceRecord &record : records)
    {
      std::set<unsigned int> linked;
      for (const auto &follower : record.followers)
      {
        const unsigned int hanging = node(record.dofs[follower.n][0]);
        if (linked.insert(hanging).second)
        {
          nodes_[hanging].masters.clear();
          nodes_[hanging].offset = Vector3(nodes_[hanging].X);
        }
        nodes_[hanging].masters.emplace_back(node(follower.dof), follower.weight);
        nodes_[hanging].offset -= follower.weight * Vector3(follower.X);
      }
    }
  }

  SurfaceFace ContactSurfaces::make_face(const FaceRecord &record) const
  {
    SurfaceFace face;
    for (unsigned int n = 0; n < (degree_ + 1) * (degree_ + 1); ++n)
      face.nodes.push_back(node(record.dofs[n][0]));
    face.orientation = record.orientation;
    face.owner       = record.rank;
    face.number      = record.number;
    face.cell        = record.cell;
    face.body        = record.body;
    face.refined     = record.refined;
    if (pairs_[record.pair].self_contact)
      for (unsigned int n = 0; n < 4; ++n)
        face.across[n] = node(record.across[n]);
    face.elsewhere = record.elsewhere;
    if (degree_ == 1)
      std::copy(std::begin(record.normal_share), std::end(record.normal_share), face.normal_share.begin());
    for (const auto &follower : record.followers)
    {
      if (face.hanging.empty() || face.hanging.back().n != follower.n)
        face.hanging.push_back({follower.n, {}});
      face.hanging.back().masters.emplace_back(node(follower.dof), follower.weight);
    }
    if (record.side == master_side)
      return face;

    for (unsigned int n = 0; n < face.nodes.size(); ++n)
      if (!record.hangs(n))
        face.slaves.push_back(slave_number(record.pair, face.nodes[n]));
    if (record.followers.empty())
      return face;
    for (const auto &follower : record.followers)
      if (const unsigned int k = slave_number(record.pair, node(follower.dof));
          follower.share != 0. && std::find(face.slaves.begin(), face.slaves.end(), k) == face.slaves.end())
        face.slaves.push_back(k);
    const auto column = [&](const unsigned int k)
    { return std::find(face.slaves.begin(), face.slaves.end(), k) - face.slaves.begin(); };
    AssertThrow(face.slaves.size() <= face.nodes.size(), dealii::ExcMessage("a face with too many hanging nodes"));
    face.basis.assign(face.nodes.size() * face.slaves.size(), 0.);
    for (unsigned int n = 0; n < face.nodes.size(); ++n)
      if (!record.hangs(n))
        face.basis[n * face.slaves.size() + column(slave_number(record.pair, face.nodes[n]))] = 1.;
    for (const auto &follower : record.followers)
      if (follower.share != 0.)
        face.basis[follower.n * face.slaves.size() + column(slave_number(record.pair, node(follower.dof)))] =
            follower.share;
    return face;
  }

  bool ContactSurfaces::has_rigid_masters() const
  {
    return std::any_of(rigid_masters_.begin(), rigid_masters_.end(), [](const auto &master) { return bool(master); });
  }

  bool ContactSurfaces::touches_itself(const unsigned int pair) const
  {
    return pairs_[pair].self_contact;
  }

  bool ContactSurfaces::is_master_alone(const unsigned int pair, const SurfaceFace &face) const
  {
    return !pairs_[pair].slave.has_body(face.body);
  }

  void ContactSurfaces::move_rigid_masters(const double begin, const double end)
  {
    for (auto &master : rigid_masters_)
      if (master)
        master->set_increment(begin, end);
  }

  void ContactSurfaces::place_carried_masters(const std::vector<Point> &positions)
  {
    for (auto &master : rigid_masters_)
      if (master)
        master->follow_carrier(positions);
  }

  bool ContactSurfaces::fetch_masters(const Vector &u, const std::vector<Vector3> &shortenings)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(communicator_) == 1 || n_pairs() == 0)
      return false;
    std::vector<Vector3> now, before;
    if (fetched_tightened_.empty())
      fetched_tightened_.resize(shortenings.size());
    gather(u, shortenings, now);
    gather(fetched_at_, fetched_tightened_, before);
    double moves = 0.;
    for (unsigned int i = 0; i < nodes_.size(); ++i)
      moves = std::max(moves, (now[i] - before[i]).norm());
    moves = dealii::Utilities::MPI::max(moves, communicator_);
    if (moves <= relative_moves * *std::min_element(face_size_.begin(), face_size_.end()))
      return false;
    fetched_at_        = u;
    fetched_tightened_ = shortenings;
    fetch(now);
    return true;
  }

  void ContactSurfaces::fetch(const std::vector<Vector3> &u)
  {
    const double moves = relative_moves * *std::min_element(face_size_.begin(), face_size_.end());
    std::map<unsigned int, std::vector<FaceRecord>> outgoing;
    for (const auto &[other, wanted] : wanted_masters(pairs_, *this, positions(u), moves))
      for (unsigned int p = 0; p < n_pairs(); ++p)
        for (const unsigned int f : wanted[p])
        {
          const auto &own = directory_.own(p, master_side);
          outgoing[other].push_back(own[master_faces_[p][f].number - own[0].number]);
        }
    std::vector<FaceRecord> records;
    for (unsigned int p = 0; p < n_pairs(); ++p)
      records.insert(records.end(), directory_.own(p, master_side).begin(), directory_.own(p, master_side).end());
    for (const auto &[other, faces] : sparse_exchange(communicator_, outgoing))
      records.insert(records.end(), faces.begin(), faces.end());
    directory_.add_layer(records);
    take_master_faces(records);
  }

  void ContactSurfaces::take_master_faces(const std::vector<FaceRecord> &records)
  {
    for (unsigned int i = n_slave_side_nodes_; i < nodes_.size(); ++i)
      node_of_dof_.erase(nodes_[i].dofs[0]);
    nodes_.resize(n_slave_side_nodes_);
    for (auto &faces : master_faces_)
      faces.clear();
    for (const FaceRecord &record : records)
    {
      add_nodes(record);
      master_faces_[record.pair].push_back(make_face(record));
    }
    link_followers(records);

    std::vector<DoFIndex> numbers;
    for (const SurfaceNode &node : nodes_)
      numbers.push_back(node.dofs[0] / dim);
    gather_.reinit(numbers, layout_.owned[0].n_elements() / dim, communicator_);
    gather_fixed();
    gather_walls();
  }

  Point ContactSurfaces::site_position(const unsigned int site) const
  {
    if (!is_point(site))
      return nodes_[sites_.nodes[site].node].X;
    const SlavePoint &p = point(site);
    const FaceShape   shape(degree_, p.xi, p.eta);
    Point             X;
    for (unsigned int n = 0; n < shape.n; ++n)
      X += shape.value[n] * nodes_[slave_faces_[p.pair][p.face].nodes[n]].X;
    return X;
  }

  void ContactSurfaces::set_fixed(const dealii::AffineConstraints<double> &constraints)
  {
    const OwnedValues mask(held_.mask);
    for (const auto i : layout_.owned[0])
      mask(i) = is_prescribed(constraints, i) ? 1. : 0.;
    gather_fixed();
  }

  void ContactSurfaces::gather_fixed()
  {
    std::vector<Vector3> nodal;
    gather(held_.mask, nodal);
    held_.fixed.resize(nodes_.size());
    for (unsigned int i = 0; i < nodes_.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        held_.fixed[i][c] = nodal[i][c] > 0.5;
    find_rigid_nodes();
    find_sections();
  }

  void ContactSurfaces::gather_walls()
  {
    if (walls_.size() == 0)
      return;
    std::vector<Vector3> walls;
    gather(walls_, walls);
    for (unsigned int i = 0; i < nodes_.size(); ++i)
      nodes_[i].wall = walls[i][0];
  }

  void ContactSurfaces::set_rigid_bodies(const std::vector<unsigned int> &numbers, const unsigned int n)
  {
    held_.rigid_number = numbers;
    layout_.n_rigid    = n;
    find_rigid_nodes();
  }

  void ContactSurfaces::find_rigid_nodes()
  {
    if (layout_.n_rigid == 0)
      return;
    held_.rigid_body.assign(nodes_.size(), dealii::numbers::invalid_unsigned_int);
    const auto take = [&](const auto &nodes, const unsigned int body)
    {
      for (const unsigned int node : nodes)
        expand(node,
               1.,
               [&](const unsigned int free_node, double)
               { held_.rigid_body[free_node] = held_.rigid_number[body - 1]; });
    };
    for (unsigned int p = 0; p < pairs_.size(); ++p)
    {
      for (const SurfaceFace &face : slave_faces_[p])
        take(face.nodes, face.body);
      for (const SurfaceFace &face : master_faces_[p])
        take(face.nodes, face.body);
      if (const RigidCarrier *const carrier = rigid_masters_[p] ? rigid_masters_[p]->carrier() : nullptr)
        take(carrier->nodes(), pairs_[p].master.first_body());
    }
  }

  std::vector<Point> ContactSurfaces::positions(const std::vector<Vector3> &u) const
  {
    std::vector<Point> x(nodes_.size());
    for (unsigned int i = 0; i < nodes_.size(); ++i)
      x[i] = nodes_[i].X + u[i];
    return x;
  }

  std::vector<Point> ContactSurfaces::reference_positions() const
  {
    return positions(std::vector<Vector3>(nodes_.size()));
  }
} // namespace Nodus
