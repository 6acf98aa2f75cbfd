// Nodes of degree 2 lie in the middle of the corners that they are counted with, on a mesh with hanging nodes, on any
// number of ranks; corners are numbered once, and are the vertices of the cells.

#include "bulk/cell_corners.h"
#include "parallel/all_gather.h"

#include <deal.II/base/conditional_ostream.h>
#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>

#include <boost/serialization/map.hpp>
#include <boost/serialization/set.hpp>

#include <algorithm>
#include <iostream>
#include <map>
#include <set>

using namespace dealii;
using Nodus::dim;

namespace
{
  void run(const unsigned int degree, const ConditionalOStream &out)
  {
    parallel::distributed::Triangulation<dim> mesh(MPI_COMM_WORLD);
    GridGenerator::subdivided_hyper_rectangle(mesh, {2, 1, 1}, Point<dim>(0, 0, 0), Point<dim>(2, 1, 1));
    mesh.refine_global(1);
    for (unsigned int round = 0; round < 2; ++round)
    {
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned() && cell->center().norm() < 0.9)
          cell->set_refine_flag();
      mesh.execute_coarsening_and_refinement();
    }
    const FESystem<dim> fe(FE_Q<dim>(degree), dim);
    DoFHandler<dim>     dofs(mesh);
    dofs.distribute_dofs(fe);
    const Nodus::CellCorners corners = Nodus::cell_corners(dofs);
    out << "degree " << degree << ": " << (corners.pairs.empty() ? "none" : "corners") << std::endl;
    if (corners.pairs.empty())
      return;

    std::map<types::global_dof_index, Point<dim>> support;
    DoFTools::map_dofs_to_support_points(MappingQ1<dim>(), dofs, support);
    const IndexSet &owned = dofs.locally_owned_dofs();
    const auto      place = [&](const unsigned int node) { return support.at(owned.nth_index_in_set(dim * node)); };
    std::map<Nodus::DoFIndex, Point<dim>> own, all;
    const Nodus::DoFIndex                 first = 2 * corners.pairs[Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)];
    for (unsigned int k = 0; k < corners.nodes.size(); ++k)
      own[first + k] = place(corners.nodes[k]);
    for (const auto &of_rank : Nodus::all_gather(MPI_COMM_WORLD, own))
      all.insert(of_rank.begin(), of_rank.end());

    double       farthest  = 0.;
    unsigned int counts[9] = {};
    for (unsigned int i = 0; i + 1 < corners.start.size(); ++i)
    {
      const unsigned int n = corners.start[i + 1] - corners.start[i];
      Tensor<1, dim>     middle;
      for (unsigned int k = corners.start[i]; k < corners.start[i + 1]; ++k)
        middle += Tensor<1, dim>(all.at(corners.corners[k])) / n;
      farthest = std::max(farthest, (middle - Tensor<1, dim>(place(i))).norm());
      ++counts[n];
    }
    std::set<std::vector<double>> vertices;
    for (const auto &cell : mesh.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          vertices.insert(std::vector<double>{cell->vertex(v)[0], cell->vertex(v)[1], cell->vertex(v)[2]});
    std::set<std::vector<double>> all_vertices;
    for (const auto &of_rank : Nodus::all_gather(MPI_COMM_WORLD, vertices))
      all_vertices.insert(of_rank.begin(), of_rank.end());
    out << "corners: " << all.size() << ", vertices: " << all_vertices.size() << std::endl;
    for (const unsigned int n : {1, 2, 4, 8})
      out << "nodes with " << n << ": " << Utilities::MPI::sum(counts[n], MPI_COMM_WORLD) << std::endl;
    out << "farthest from the middle of its corners, within 1e-14: "
        << (Utilities::MPI::max(farthest, MPI_COMM_WORLD) < 1e-14 ? "yes" : "NO") << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const ConditionalOStream         out(std::cout, Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);
  for (const unsigned int degree : {1, 2})
    run(degree, out);
}
