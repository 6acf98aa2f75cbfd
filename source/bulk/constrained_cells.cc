#include "bulk/constrained_cells.h"
#include "base/deal_ii_versions.h"
#include "parallel/all_gather.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace Nodus
{
  namespace
  {
    constexpr int tag = 4712;

    /// Adds the upper blocks of a group where they are stored.
    void scatter(const std::vector<BlockCsrMatrix::Position> &positions, const double *K, BlockCsrMatrix &tangent)
    {
      for (const BlockCsrMatrix::Position position : positions)
      {
        if (position.stored())
        {
          double *const to = tangent.block(position.block());
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int k = 0; k < dim; ++k)
              to[position.transposed() ? dim * k + i : dim * i + k] += K[dim * i + k];
        }
        K += dim * dim;
      }
    }
  } // namespace

  ConstrainedCells::ConstrainedCells(const dealii::DoFHandler<dim> &dof_handler)
      : communicator_(communicator_of(dof_handler))
      , hanging_(dof_handler)
  {
    if (!exist())
      return;
    // Owners see all hanging nodes of their cells; the neighbours take their word for it.
    constrained_.assign(dof_handler.get_triangulation().n_active_cells(), 0);
    std::vector<DoFIndex> dofs(dof_handler.get_fe().n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        cell->get_dof_indices(dofs);
        constrained_[cell->active_cell_index()] = std::any_of(
            dofs.begin(), dofs.end(), [&](const DoFIndex dof) { return hanging_.masters(dof / dim) != nullptr; });
      }
    dealii::GridTools::exchange_cell_data_to_ghosts<char>(
        dof_handler,
        [&](const auto &cell) { return constrained_[cell->active_cell_index()]; },
        [&](const auto &cell, const char value) { constrained_[cell->active_cell_index()] = value; });
  }

  void
  ConstrainedCells::add(const unsigned int number, const std::vector<DoFIndex> &nodes, std::vector<DoFIndex> &ghosts)
  {
    index_.resize(number + 1, dealii::numbers::invalid_unsigned_int);
    index_[number] = cells_.size();
    cells_.emplace_back();
    Cell      &cell  = cells_.back();
    const auto share = [&](const DoFIndex node, const double weight)
    {
      const unsigned int A = std::find(cell.global.begin(), cell.global.end(), node) - cell.global.begin();
      if (A == cell.global.size())
        cell.global.push_back(node);
      cell.shares.push_back({A, weight});
    };
    cell.start.push_back(0);
    for (unsigned int a = 0; a < nodes.size(); ++a)
    {
      if (const auto *const masters = hanging_.masters(nodes[a]))
      {
        cell.hanging.emplace_back(a, 0);
        for (const auto &[master, weight] : *masters)
        {
          AssertThrow(!hanging_.masters(master), dealii::ExcMessage("a hanging node follows another one"));
          share(master, weight);
        }
      }
      else
        share(nodes[a], 1.);
      cell.start.push_back(cell.shares.size());
    }
    ghosts.insert(ghosts.end(), cell.global.begin(), cell.global.end());
    for (auto &[a, node] : cell.hanging)
      node = nodes[a]; // global, until publish()
  }

  std::shared_ptr<const NodeMap> ConstrainedCells::publish(const std::shared_ptr<const NodeMap> &base)
  {
    if (!exist())
      return base;
    n_owned_                   = base->n_owned();
    const unsigned int    rank = dealii::Utilities::MPI::this_mpi_process(communicator_);
    std::vector<DoFIndex> end_of_rank;
    for (const DoFIndex n : all_gather(communicator_, DoFIndex(n_owned_)))
      end_of_rank.push_back(n + (end_of_rank.empty() ? 0 : end_of_rank.back()));
    const auto owner = [&](const DoFIndex node) -> unsigned int
    { return std::upper_bound(end_of_rank.begin(), end_of_rank.end(), node) - end_of_rank.begin(); };

    std::map<unsigned int, std::vector<std::vector<DoFIndex>>> outgoing;
    std::vector<std::set<unsigned int>>                        owners(cells_.size());
    for (unsigned int c = 0; c < cells_.size(); ++c)
    {
      for (const DoFIndex node : cells_[c].global)
        owners[c].insert(owner(node));
      owners[c].erase(rank);
      for (const unsigned int other : owners[c])
        outgoing[other].push_back(cells_[c].global);
    }
    std::map<unsigned int, Neighbour> neighbours;
    std::vector<DoFIndex>             foreign;
    for (const auto &[other, groups] : sparse_exchange(communicator_, outgoing))
      for (const auto &group : groups)
      {
        neighbours[other].cells.emplace_back();
        neighbours[other].cells.back().global = group;
        foreign.insert(foreign.end(), group.begin(), group.end());
      }
    for (const auto &sent : outgoing)
      neighbours[sent.first];
    for (auto &[other, neighbour] : neighbours)
    {
      neighbour.rank = other;
      for (unsigned int c = 0; c < cells_.size(); ++c)
        if (owners[c].count(other) == 1)
        {
          cells_[c].destinations.push_back(neighbours_.size());
          neighbour.n_outgoing += n_numbers(cells_[c], true);
        }
      neighbours_.push_back(std::move(neighbour));
    }

    foreign.erase(std::remove_if(foreign.begin(), foreign.end(), [&](const DoFIndex n) { return owner(n) == rank; }),
                  foreign.end());
    const auto map   = std::make_shared<const NodeMap>(*base, std::move(foreign));
    const auto local = [&](Cell &cell)
    {
      for (const DoFIndex node : cell.global)
        cell.free.push_back(map->local(node));
    };
    for (Cell &cell : cells_)
    {
      local(cell);
      for (auto &[a, node] : cell.hanging)
        node = map->local(node);
      cell.hanging.erase(std::remove_if(cell.hanging.begin(),
                                        cell.hanging.end(),
                                        [&](const auto &node) { return node.second >= n_owned_; }),
                         cell.hanging.end());
    }
    for (Neighbour &neighbour : neighbours_)
      for (Cell &cell : neighbour.cells)
        local(cell);
    return map;
  }

  void ConstrainedCells::add_groups(std::vector<unsigned int> &nodes, std::vector<std::size_t> &end) const
  {
    const auto add = [&](const Cell &cell)
    {
      nodes.insert(nodes.end(), cell.free.begin(), cell.free.end());
      end.push_back(nodes.size());
    };
    std::for_each(cells_.begin(), cells_.end(), add);
    for (const Neighbour &neighbour : neighbours_)
      std::for_each(neighbour.cells.begin(), neighbour.cells.end(), add);
  }

  void ConstrainedCells::find_positions(const BlockCsrMatrix &tangent)
  {
    const auto find = [&](Cell &cell)
    {
      cell.positions.clear();
      for (unsigned int A = 0; A < cell.free.size(); ++A)
        for (unsigned int B = A; B < cell.free.size(); ++B)
          cell.positions.push_back(tangent.position(cell.free[A], cell.free[B]));
    };
    std::for_each(cells_.begin(), cells_.end(), find);
    for (Neighbour &neighbour : neighbours_)
      std::for_each(neighbour.cells.begin(), neighbour.cells.end(), find);
  }

  std::size_t ConstrainedCells::n_numbers(const Cell &cell, const bool with_tangent)
  {
    const std::size_t n = cell.global.size();
    return 3 * dim * n + (with_tangent ? dim * dim * n * (n + 1) / 2 : 0);
  }

  /// Only the upper half is kept: a pair of nodes brings its block and the transposed one, of which one is above the
  /// diagonal, or both are on it.
  void ConstrainedCells::condense(const Cell &cell, const double *K)
  {
    const auto add = [&](const std::size_t block, const double weight, const bool transposed)
    {
      double *const to = blocks_.data() + block;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int k = 0; k < dim; ++k)
          to[dim * i + k] += weight * (transposed ? K[dim * k + i] : K[dim * i + k]);
    };
    blocks_.assign(dim * dim * n_free_ * (n_free_ + 1) / 2, 0.);
    for (unsigned int a = 0; a < cell.n_nodes(); ++a)
      for (unsigned int b = a; b < cell.n_nodes(); ++b, K += dim * dim)
        for (const Share *A = cell.begin(a); A != cell.end(a); ++A)
          for (const Share *B = cell.begin(b); B != cell.end(b); ++B)
          {
            const double weight = A->weight * B->weight;
            if (A->node <= B->node)
              add(block(A->node, B->node), weight, false);
            if (A->node >= B->node && a != b)
              add(block(B->node, A->node), weight, true);
          }
  }

  void ConstrainedCells::eliminate_prescribed(const Cell                &cell,
                                              const std::vector<char>   &is_prescribed,
                                              const std::vector<double> &prescribed)
  {
    for (unsigned int A = 0; A < n_free_; ++A)
      for (unsigned int i = 0; i < dim; ++i)
      {
        const unsigned int dof = dim * cell.free[A] + i;
        if (!is_prescribed[dof])
          continue;
        const double diagonal = std::abs(entry(A, i, A, i));
        for (unsigned int B = 0; B < n_free_; ++B)
          for (unsigned int k = 0; k < dim; ++k)
          {
            double &K = entry(B, k, A, i);
            force_[2][dim * B + k] -= K * prescribed[dof];
            K = 0.;
            if (A == B) // stored in full
              entry(A, i, A, k) = 0.;
          }
        entry(A, i, A, i) = diagonal;
      }
  }

  void ConstrainedCells::add(const unsigned int         index,
                             const std::vector<double> &internal,
                             const std::vector<double> &external,
                             const std::vector<char>   &is_prescribed,
                             const std::vector<double> &prescribed,
                             const std::vector<double> &stiffness,
                             BlockCsrMatrix            *tangent,
                             const NodalForces         &sums)
  {
    const Cell &cell = cells_[index];
    n_free_          = cell.free.size();
    for (auto &force : force_)
      force.assign(dim * n_free_, 0.);
    for (unsigned int a = 0; a < cell.n_nodes(); ++a)
      for (const Share *A = cell.begin(a); A != cell.end(a); ++A)
        for (unsigned int i = 0; i < dim; ++i)
        {
          force_[0][dim * A->node + i] += A->weight * internal[dim * a + i];
          force_[1][dim * A->node + i] += A->weight * external[dim * a + i];
        }
    if (tangent)
    {
      condense(cell, stiffness.data());
      eliminate_prescribed(cell, is_prescribed, prescribed);
      scatter(cell.positions, blocks_.data(), *tangent);
      for (const auto &[a, node] : cell.hanging) // a positive diagonal
        for (unsigned int i = 0; i < dim; ++i)
        {
          const unsigned int pair = a * cell.n_nodes() - a * (a + 1) / 2 + a;
          tangent->add_to_diagonal(dim * node + i, std::abs(stiffness[(pair * dim + i) * dim + i]));
        }
    }
    std::vector<double> *const to[3] = {&sums.internal, &sums.external, &sums.rhs};
    for (unsigned int part = 0; part < 3; ++part)
      for (unsigned int A = 0; A < n_free_; ++A)
        for (unsigned int i = 0; i < dim; ++i)
          (*to[part])[dim * cell.free[A] + i] += force_[part][dim * A + i];
    for (const unsigned int d : cell.destinations)
    {
      std::vector<double> &outgoing = neighbours_[d].outgoing;
      outgoing.reserve(neighbours_[d].n_outgoing);
      for (const auto &force : force_)
        outgoing.insert(outgoing.end(), force.begin(), force.end());
      if (tangent)
        outgoing.insert(outgoing.end(), blocks_.begin(), blocks_.end());
    }
  }

  void ConstrainedCells::exchange(const bool failed, BlockCsrMatrix *tangent, const NodalForces &sums)
  {
    if (!exist())
      return;
    if (dealii::Utilities::MPI::max(failed ? 1 : 0, communicator_) == 1)
    {
      for (Neighbour &neighbour : neighbours_)
        neighbour.outgoing.clear();
      return;
    }
    std::vector<MPI_Request> requests;
    requests.reserve(2 * neighbours_.size());
    for (Neighbour &neighbour : neighbours_)
    {
      std::size_t n = 0;
      for (const Cell &cell : neighbour.cells)
        n += n_numbers(cell, tangent);
      neighbour.incoming.resize(n);
      if (n > 0)
      {
        requests.emplace_back();
        MPI_Irecv(neighbour.incoming.data(), n, MPI_DOUBLE, neighbour.rank, tag, communicator_, &requests.back());
      }
      if (!neighbour.outgoing.empty())
      {
        requests.emplace_back();
        MPI_Isend(neighbour.outgoing.data(),
                  neighbour.outgoing.size(),
                  MPI_DOUBLE,
                  neighbour.rank,
                  tag,
                  communicator_,
                  &requests.back());
      }
    }
    MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    std::vector<double> *const to[3] = {&sums.internal, &sums.external, &sums.rhs};
    for (Neighbour &neighbour : neighbours_)
    {
      const double *numbers = neighbour.incoming.data();
      for (const Cell &cell : neighbour.cells)
      {
        const unsigned int n = cell.free.size();
        for (std::vector<double> *const sum : to)
          for (unsigned int A = 0; A < n; ++A, numbers += dim)
            for (unsigned int i = 0; i < dim && cell.free[A] < n_owned_; ++i)
              (*sum)[dim * cell.free[A] + i] += numbers[i];
        if (!tangent)
          continue;
        scatter(cell.positions, numbers, *tangent);
        numbers += dim * dim * n * (n + 1) / 2;
      }
      neighbour.outgoing.clear();
    }
  }
} // namespace Nodus
