#include "contact/face_directory.h"
#include "base/deal_ii_versions.h"
#include "mesh/bodies.h"
#include "mesh/region.h"
#include "parallel/all_gather.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace Nodus
{
  namespace
  {
    /// Weights of a quadratic edge are multiples of 1/8.
    constexpr double smallest_share = 0.1;
  } // namespace

  FaceDirectory::FaceDirectory(const dealii::DoFHandler<dim> &dof_handler, const unsigned int n_pairs)
      : dof_handler_(dof_handler)
      , hanging_(dof_handler)
      , rank_(dealii::Utilities::MPI::this_mpi_process(communicator_of(dof_handler)))
      , n_face_nodes_((dof_handler.get_fe().degree + 1) * (dof_handler.get_fe().degree + 1))
      , own_(2 * n_pairs)
      , size_(2 * n_pairs, 0)
  {
    const DoFIndex n_owned = dof_handler.locally_owned_dofs().n_elements();
    for (const DoFIndex n : all_gather(communicator_of(dof_handler), n_owned))
      end_of_rank_.push_back(n + (end_of_rank_.empty() ? 0 : end_of_rank_.back()));
  }

  void FaceDirectory::collect(const Region                         &region,
                              const Bodies                         &bodies,
                              const dealii::Mapping<dim>           &mapping,
                              const unsigned int                    pair,
                              const unsigned int                    side,
                              const std::map<unsigned int, Region> &elsewhere)
  {
    const auto        &fe             = dof_handler_.get_fe();
    const auto        &base           = fe.base_element(0);
    const auto        &support_points = base.get_unit_support_points();
    const unsigned int n_1d           = fe.degree + 1;

    if (hanging_.exist() && followed_.empty())
      followed_ = hanging_.followed(dof_handler_, mapping);
    std::vector<DoFIndex> cell_dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler_.active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (region.selects_face(mapping, cell, f))
          {
            cell->get_dof_indices(cell_dofs);
            const unsigned int normal = f / 2, a = normal == 0 ? 1 : 0, b = normal == 2 ? 1 : 2;
            FaceRecord         record{};
            // e_a x e_b = -e_normal for normal = y
            std::fill(std::begin(record.normal_share), std::end(record.normal_share), 1.);
            record.orientation = (normal == 1 ? -1. : 1.) * (f % 2 == 1 ? 1. : -1.);
            record.pair        = pair;
            record.side        = side;
            record.rank        = rank_;
            record.cell        = cell->active_cell_index();
            record.body        = cell->material_id() + 1;
            record.refined     = std::max(0, cell->level() - static_cast<int>(bodies.level(cell->material_id())));
            for (const auto &[number, other] : elsewhere)
              if (other.selects_face(mapping, cell, f))
                record.elsewhere.push_back(number);
            for (unsigned int i = 0; i < base.n_dofs_per_cell(); ++i)
            {
              const auto position = [&](const unsigned int axis)
              { return static_cast<unsigned int>(std::lround(support_points[i][axis] * fe.degree)); };
              if (position(normal) == (1 - f % 2) * fe.degree && position(a) % fe.degree + position(b) % fe.degree == 0)
              {
                const unsigned int corner = (position(a) + 2 * position(b)) / fe.degree;
                const Point        X      = mapping.transform_unit_to_real_cell(cell, support_points[i]);
                record.across[corner]     = cell_dofs[fe.component_to_system_index(0, i)];
                for (unsigned int c = 0; c < dim; ++c)
                  record.X_across[corner][c] = X[c];
              }
              else if (position(normal) == f % 2 * fe.degree)
              {
                const unsigned int n = position(a) + n_1d * position(b);
                const Point        X = mapping.transform_unit_to_real_cell(cell, support_points[i]);
                for (unsigned int c = 0; c < dim; ++c)
                {
                  record.dofs[n][c] = cell_dofs[fe.component_to_system_index(c, i)];
                  record.X[n][c]    = X[c];
                }
              }
            }
            for (unsigned int n = 0; n < n_face_nodes_; ++n)
              if (const auto *const masters = hanging_.masters(record.dofs[n][0] / dim))
                for (const auto &[master, weight] : *masters)
                {
                  const Point &X = followed_.at(master);
                  if (masters->size() == 1) // the node in the middle of a larger cell's edge is the same node
                    for (unsigned int c = 0; c < dim; ++c)
                    {
                      record.dofs[n][c] = dim * master + c;
                      record.X[n][c]    = X[c];
                    }
                  else
                    record.followers.push_back({n, dim * master, {X[0], X[1], X[2]}, weight, 0.});
                }
            own_[2 * pair + side].push_back(record);
          }
  }

  std::vector<DoFIndex> FaceDirectory::support(const FaceRecord &face) const
  {
    std::vector<DoFIndex> nodes;
    for (unsigned int n = 0; n < n_face_nodes_; ++n)
      if (!face.hangs(n))
        nodes.push_back(face.dofs[n][0]);
    for (const auto &follower : face.followers)
      if (follower.share != 0. && std::find(nodes.begin(), nodes.end(), follower.dof) == nodes.end())
        nodes.push_back(follower.dof);
    return nodes;
  }

  /// The multiplier at a hanging node follows those of its masters on this side, with weights of sum one: uniform
  /// pressures remain uniform where one of the masters lies beyond the edge of the region.
  void FaceDirectory::share_multipliers()
  {
    if (!hanging_.exist())
      return;
    const MPI_Comm                               communicator = communicator_of(dof_handler_);
    std::map<unsigned int, std::vector<NodeKey>> nodes, questions;
    for (unsigned int i = 0; i < own_.size(); ++i)
      for (const FaceRecord &face : own_[i])
      {
        for (unsigned int n = 0; n < n_face_nodes_; ++n)
          if (!face.hangs(n))
            nodes[owner(face.dofs[n][0])].emplace_back(i, face.dofs[n][0]);
        for (const auto &follower : face.followers)
          questions[owner(follower.dof)].emplace_back(i, follower.dof);
      }
    std::set<NodeKey> present;
    for (const auto &[other, keys] : sparse_exchange(communicator, nodes))
      present.insert(keys.begin(), keys.end());
    std::map<unsigned int, std::vector<NodeKey>> answers;
    for (const auto &[other, keys] : sparse_exchange(communicator, questions))
      for (const NodeKey &key : keys)
        if (present.count(key) == 1)
          answers[other].push_back(key);
    std::set<NodeKey> on_side;
    for (const auto &[other, keys] : sparse_exchange(communicator, answers))
      on_side.insert(keys.begin(), keys.end());
    for (unsigned int i = 0; i < own_.size(); ++i)
      for (FaceRecord &face : own_[i])
        for (auto &follower : face.followers)
        {
          double sum = 0.;
          for (const auto &other : face.followers)
            if (other.n == follower.n && on_side.count({i, other.dof}) == 1)
              sum += other.weight;
          follower.share =
              on_side.count({i, follower.dof}) == 1 && std::abs(sum) > smallest_share ? follower.weight / sum : 0.;
        }
  }

  void FaceDirectory::publish()
  {
    // The ranks' cells follow each other on the space-filling curve: so do their faces.
    const MPI_Comm            communicator = communicator_of(dof_handler_);
    std::vector<unsigned int> counts;
    for (const auto &faces : own_)
      counts.push_back(faces.size());
    const auto all = all_gather(communicator, counts);
    for (unsigned int i = 0; i < own_.size(); ++i)
    {
      unsigned int first = 0;
      for (unsigned int r = 0; r < all.size(); ++r)
      {
        if (r < rank_)
          first += all[r][i];
        size_[i] += all[r][i];
      }
      for (FaceRecord &face : own_[i])
        face.number = first++;
    }

    share_multipliers();
    std::map<unsigned int, std::vector<FaceRecord>> outgoing;
    for (const auto &faces : own_)
      for (const FaceRecord &face : faces)
      {
        std::set<unsigned int> ranks;
        for (const DoFIndex dof : support(face))
          ranks.insert(owner(dof));
        for (const unsigned int r : ranks)
          outgoing[r].push_back(face);
      }
    for (const auto &[other, faces] : sparse_exchange(communicator, outgoing))
      at_own_nodes_.insert(at_own_nodes_.end(), faces.begin(), faces.end());
    std::sort(at_own_nodes_.begin(),
              at_own_nodes_.end(),
              [](const FaceRecord &a, const FaceRecord &b)
              { return std::tie(a.pair, a.side, a.number) < std::tie(b.pair, b.side, b.number); });
    for (unsigned int f = 0; f < at_own_nodes_.size(); ++f)
    {
      const FaceRecord &face = at_own_nodes_[f];
      for (const DoFIndex dof : support(face))
        if (owner(dof) == rank_)
          incident_[{2 * face.pair + face.side, dof}].push_back(f);
    }
    if (dof_handler_.get_fe().degree == 1)
      share_normals();
  }

  void FaceDirectory::add_layer(std::vector<FaceRecord> &faces) const
  {
    const MPI_Comm                                  communicator = communicator_of(dof_handler_);
    std::map<unsigned int, std::set<NodeKey>>       nodes;
    std::map<unsigned int, std::vector<NodeKey>>    questions;
    std::map<unsigned int, std::vector<FaceRecord>> answers;
    for (const FaceRecord &face : faces)
      for (const DoFIndex dof : support(face))
        nodes[owner(dof)].insert({2 * face.pair + face.side, dof});
    for (const auto &[other, keys] : nodes)
      questions[other].assign(keys.begin(), keys.end());
    for (const auto &[other, keys] : sparse_exchange(communicator, questions))
    {
      std::set<unsigned int> indices;
      for (const NodeKey &key : keys)
        if (const auto at = incident_.find(key); at != incident_.end())
          indices.insert(at->second.begin(), at->second.end());
      for (const unsigned int i : indices)
        if (at_own_nodes_[i].rank != other) // who has its own faces already
          answers[other].push_back(at_own_nodes_[i]);
    }
    for (const auto &[other, found] : sparse_exchange(communicator, answers))
      faces.insert(faces.end(), found.begin(), found.end());
    make_unique(faces);
  }

  unsigned int FaceDirectory::owner(const DoFIndex dof) const
  {
    return std::upper_bound(end_of_rank_.begin(), end_of_rank_.end(), dof) - end_of_rank_.begin();
  }

  void make_unique(std::vector<FaceRecord> &faces)
  {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(),
                            faces.end(),
                            [](const FaceRecord &a, const FaceRecord &b) { return !(a < b) && !(b < a); }),
                faces.end());
  }
} // namespace Nodus
