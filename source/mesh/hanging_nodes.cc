#include "mesh/hanging_nodes.h"
#include "base/deal_ii_versions.h"
#include "parallel/all_gather.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe.h>

#include <algorithm>
#include <map>

namespace Nodus
{
  HangingNodes::HangingNodes(const dealii::DoFHandler<dim> &dof_handler)
      : exist_(dof_handler.get_triangulation().has_hanging_nodes())
  {
    if (!exist_)
      return;
    const MPI_Comm          communicator = communicator_of(dof_handler);
    const dealii::IndexSet &owned        = dof_handler.locally_owned_dofs();
    auto                    lines        = no_constraints(dof_handler);
    dealii::DoFTools::make_hanging_node_constraints(dof_handler, lines);
    for (const auto &line : lines.get_lines())
      if (line.index % dim == 0)
      {
        Masters &masters = masters_[line.index / dim];
        for (const auto &[dof, weight] : line.entries)
          masters.emplace_back(dof / dim, weight);
        std::sort(masters.begin(), masters.end());
      }
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1)
      return;

    std::vector<DoFIndex> end_of_rank;
    for (const DoFIndex n : all_gather(communicator, owned.n_elements()))
      end_of_rank.push_back(n + (end_of_rank.empty() ? 0 : end_of_rank.back()));
    const auto owner = [&](const DoFIndex node)
    { return std::upper_bound(end_of_rank.begin(), end_of_rank.end(), dim * node) - end_of_rank.begin(); };

    // Whoever knows of a hanging node tells its owner, and asks the owners about all others.
    using Lines = std::vector<std::pair<DoFIndex, Masters>>;
    std::map<unsigned int, Lines>                 found, answers;
    std::map<unsigned int, std::vector<DoFIndex>> questions;
    for (const auto &[node, masters] : masters_)
      if (!owned.is_element(dim * node))
        found[owner(node)].emplace_back(node, masters);
    for (const DoFIndex dof : dealii::DoFTools::extract_locally_relevant_dofs(dof_handler))
      if (dof % dim == 0 && !owned.is_element(dof))
        questions[owner(dof / dim)].push_back(dof / dim);
    for (const auto &[rank, received] : sparse_exchange(communicator, found))
      for (const auto &[node, masters] : received)
        masters_.emplace(node, masters);
    for (const auto &[rank, nodes] : sparse_exchange(communicator, questions))
      for (const DoFIndex node : nodes)
        if (const Masters *const known = masters(node))
          answers[rank].emplace_back(node, *known);
    for (const auto &[rank, received] : sparse_exchange(communicator, answers))
      for (const auto &[node, masters] : received)
        masters_[node] = masters;
  }

  std::unordered_map<DoFIndex, Point> HangingNodes::followed(const dealii::DoFHandler<dim> &dof_handler,
                                                             const dealii::Mapping<dim>    &mapping) const
  {
    std::unordered_map<DoFIndex, Point> positions;
    for (const auto &[node, masters] : masters_)
      for (const auto &[master, weight] : masters)
        positions[master];
    if (positions.empty())
      return positions;
    const auto           &fe = dof_handler.get_fe();
    std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
      {
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < dofs.size(); ++i)
          if (fe.system_to_component_index(i).first == 0)
            if (const auto found = positions.find(dofs[i] / dim); found != positions.end())
              found->second = mapping.transform_unit_to_real_cell(
                  cell, fe.base_element(0).unit_support_point(fe.system_to_component_index(i).second));
      }
    return positions;
  }

  void HangingNodes::add_to(dealii::AffineConstraints<double> &constraints) const
  {
    for (const auto &[node, masters] : masters_)
      for (unsigned int c = 0; c < dim; ++c)
        if (const DoFIndex dof = dim * node + c; constraints.can_store_line(dof))
        {
          constraints.add_line(dof);
          for (const auto &[master, weight] : masters)
            constraints.add_entry(dof, dim * master + c, weight);
        }
  }

  dealii::AffineConstraints<double> hanging_constraints(const dealii::DoFHandler<dim> &dof_handler)
  {
    auto constraints = no_constraints(dof_handler);
    HangingNodes(dof_handler).add_to(constraints);
    constraints.close();
    return constraints;
  }

  Vector sums_over_cells(const dealii::DoFHandler<dim>           &dof_handler,
                         const dealii::AffineConstraints<double> &constraints)
  {
    dealii::IndexSet      ghosts = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
    std::vector<DoFIndex> beyond; // added all at once: one by one they would be sorted in each time
    for (const auto &line : constraints.get_lines())
      for (const auto &[dof, weight] : line.entries)
        if (!ghosts.is_element(dof))
          beyond.push_back(dof);
    std::sort(beyond.begin(), beyond.end());
    ghosts.add_indices(beyond.begin(), beyond.end());
    return Vector(dof_handler.locally_owned_dofs(), ghosts, communicator_of(dof_handler));
  }
} // namespace Nodus
