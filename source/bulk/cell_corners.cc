#include "bulk/cell_corners.h"
#include "base/deal_ii_versions.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_lattice = 27;

    /// Places of the corners that a place of the lattice of degree 2 lies between.
    std::vector<unsigned int> corners_around(const unsigned int place)
    {
      std::vector<unsigned int> corners = {0};
      for (unsigned int d = 0, step = 1, rest = place; d < dim; ++d, step *= 3, rest /= 3)
      {
        const std::vector<unsigned int> before = corners;
        corners.clear();
        for (const unsigned int end : {0U, 2U})
          if (rest % 3 == 1 || rest % 3 == end)
            for (const unsigned int corner : before)
              corners.push_back(corner + end * step);
      }
      return corners;
    }

    /// Calls f(nodes in the order of the lattice) for the cells that this rank knows.
    template <typename Function>
    void for_cells(const DoFHandler<dim> &dof_handler, const Function &f)
    {
      const auto                     &fe         = dof_handler.get_fe();
      const std::vector<unsigned int> to_lattice = FETools::lexicographic_to_hierarchic_numbering<dim>(2);
      std::vector<DoFIndex>           dofs(fe.n_dofs_per_cell());
      std::array<DoFIndex, n_lattice> nodes;
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
        {
          cell->get_dof_indices(dofs);
          for (unsigned int place = 0; place < n_lattice; ++place)
            nodes[place] = dofs[fe.component_to_system_index(0, to_lattice[place])];
          f(nodes);
        }
    }
  } // namespace

  CellCorners cell_corners(const DoFHandler<dim> &dof_handler)
  {
    CellCorners result;
    if (dof_handler.get_fe().degree != 2)
      return result;
    std::array<std::vector<unsigned int>, n_lattice> around;
    for (unsigned int place = 0; place < n_lattice; ++place)
      around[place] = corners_around(place);

    // Owned corners, in the order in which cells have them, so that those of a pair are mostly neighbours.
    const IndexSet   &owned = dof_handler.locally_owned_dofs();
    std::vector<char> is_corner(owned.n_elements() / dim, 0);
    const auto        node_of = [&](const DoFIndex dof) { return owned.index_within_set(dof) / dim; };
    for_cells(dof_handler,
              [&](const std::array<DoFIndex, n_lattice> &nodes)
              {
                for (const unsigned int corner : around[n_lattice / 2])
                  if (owned.is_element(nodes[corner]) && !is_corner[node_of(nodes[corner])])
                  {
                    is_corner[node_of(nodes[corner])] = 1;
                    result.nodes.push_back(node_of(nodes[corner]));
                  }
              });
    const MPI_Comm     comm    = communicator_of(dof_handler);
    const unsigned int n_pairs = (result.nodes.size() + 1) / 2;
    result.pairs.assign(1, 0);
    for (const unsigned int n : all_gather(comm, n_pairs))
      result.pairs.push_back(result.pairs.back() + n);

    // Their numbers, at the first degree of freedom of each.
    const DoFIndex first = 2 * result.pairs[Utilities::MPI::this_mpi_process(comm)];
    Vector         number(owned, DoFTools::extract_locally_relevant_dofs(dof_handler), comm);
    for (unsigned int k = 0; k < result.nodes.size(); ++k)
      number(owned.nth_index_in_set(dim * result.nodes[k])) = first + k;
    number.update_ghost_values();

    std::vector<std::vector<DoFIndex>> of_node(is_corner.size());
    for_cells(dof_handler,
              [&](const std::array<DoFIndex, n_lattice> &nodes)
              {
                for (unsigned int place = 0; place < n_lattice; ++place)
                  if (owned.is_element(nodes[place]))
                  {
                    std::vector<DoFIndex> &corners = of_node[node_of(nodes[place])];
                    if (is_corner[node_of(nodes[place])])
                      corners.assign(1, static_cast<DoFIndex>(number(nodes[place])));
                    else if (corners.empty())
                      for (const unsigned int corner : around[place])
                        corners.push_back(static_cast<DoFIndex>(number(nodes[corner])));
                  }
              });
    result.start.assign(1, 0);
    for (const auto &corners : of_node)
    {
      result.corners.insert(result.corners.end(), corners.begin(), corners.end());
      result.start.push_back(result.corners.size());
    }
    return result;
  }
} // namespace Nodus
