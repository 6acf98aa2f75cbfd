// A mesh from files that will not be refined: each rank builds its cells and those that touch them. Measures, boundary
// ids, unknowns and the numbers of coarse cells are those of the mesh that p4est divides; faces at which a share ends
// are no boundary; the shares weigh the same, and slave faces count. Cuts are where they pass few nodes, unless few
// ranks would have the contact.

#include "../cases.h"

#include "mesh/bodies.h"
#include "mesh/mesh_share.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>

using namespace Cases;

namespace
{
  /// A cube with @p n cells along each edge, of which only the bottom has an id: the other faces have 0.
  void write_cube(const std::string &file, const unsigned int n)
  {
    std::ofstream out(file);
    const auto    node = [n](const unsigned int i, const unsigned int j, const unsigned int k)
    { return 1 + i + (n + 1) * (j + (n + 1) * k); };
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << (n + 1) * (n + 1) * (n + 1) << '\n';
    for (unsigned int k = 0; k <= n; ++k)
      for (unsigned int j = 0; j <= n; ++j)
        for (unsigned int i = 0; i <= n; ++i)
          out << node(i, j, k) << ' ' << double(i) / n << ' ' << double(j) / n << ' ' << double(k) / n << '\n';
    out << "$EndNodes\n$Elements\n" << n * n * (n + 1) << '\n';
    unsigned int number = 0;
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
        out << ++number << " 3 2 7 1 " << node(i, j, 0) << ' ' << node(i + 1, j, 0) << ' ' << node(i + 1, j + 1, 0)
            << ' ' << node(i, j + 1, 0) << '\n';
    for (unsigned int k = 0; k < n; ++k)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
        {
          out << ++number << " 5 2 1 1";
          for (const unsigned int l : {k, k + 1})
            out << ' ' << node(i, j, l) << ' ' << node(i + 1, j, l) << ' ' << node(i + 1, j + 1, l) << ' '
                << node(i, j + 1, l);
          out << '\n';
        }
    out << "$EndElements\n";
  }

  /// Adds nx by ny by nz cells above z = @p bottom, with vertices of their own.
  void
  add_box(CoarseMesh &mesh, const unsigned int nx, const unsigned int ny, const unsigned int nz, const double bottom)
  {
    const unsigned int first  = mesh.vertices.size();
    const auto         vertex = [&](const unsigned int i, const unsigned int j, const unsigned int k)
    { return first + i + (nx + 1) * (j + (ny + 1) * k); };
    for (unsigned int k = 0; k <= nz; ++k)
      for (unsigned int j = 0; j <= ny; ++j)
        for (unsigned int i = 0; i <= nx; ++i)
          mesh.vertices.emplace_back(i, j, bottom + k);
    for (unsigned int k = 0; k < nz; ++k)
      for (unsigned int j = 0; j < ny; ++j)
        for (unsigned int i = 0; i < nx; ++i)
        {
          auto &cell = mesh.cells.emplace_back();
          for (unsigned int v = 0; v < 8; ++v)
            cell.vertices[v] = vertex(i + v % 2, j + v / 2 % 2, k + v / 4);
        }
  }

  /// Two equal boxes on each other, the upper one with a slave face below each of its lowest cells, in two parts:
  /// @returns how many slave faces the part with more of them has.
  unsigned int slave_faces_of_one(const unsigned int nx, const unsigned int ny, const unsigned int nz)
  {
    CoarseMesh mesh;
    add_box(mesh, nx, ny, nz, 0.);
    add_box(mesh, nx, ny, nz, nz);
    std::vector<unsigned int> slave_faces(mesh.cells.size(), 0);
    std::fill_n(slave_faces.begin() + nx * ny * nz, nx * ny, 1);
    const std::vector<unsigned int> part     = divide(mesh, slave_faces, 1, 0, 2);
    unsigned int                    faces[2] = {0, 0};
    for (unsigned int c = 0; c < part.size(); ++c)
      faces[part[c]] += slave_faces[c];
    return std::max(faces[0], faces[1]);
  }

  /// The cut of a bar is across it.
  unsigned int vertices_at_cut_of_bar()
  {
    CoarseMesh mesh;
    add_box(mesh, 3, 12, 3, 0.);
    const std::vector<unsigned int> part = divide(mesh, std::vector<unsigned int>(mesh.cells.size(), 0), 1, 0, 2);
    std::vector<unsigned int>       touches(mesh.vertices.size(), 0);
    for (unsigned int c = 0; c < part.size(); ++c)
      for (const unsigned int v : mesh.cells[c].vertices)
        touches[v] |= 1U << part[c];
    return std::count(touches.begin(), touches.end(), 3U);
  }

  /// Centres, as keys.
  std::array<long, 3> key(const Point &x)
  {
    return {{std::lround(1e6 * x[0]), std::lround(1e6 * x[1]), std::lround(1e6 * x[2])}};
  }

  void compare(const std::string &title, const std::vector<BodyParameters> &parameters, const unsigned int weighty)
  {
    std::vector<RegionParameters> slaves(1);
    slaves[0].bodies       = {1};
    slaves[0].boundary_ids = {weighty};
    Bodies whole(parameters, world()), shares(parameters, world(), false, slaves);
    check(title + ": p4est refines the one, not the other", whole.refinable() && !shares.refinable());
    check(title + ": cells",
          shares.triangulation().n_global_active_cells(),
          whole.triangulation().n_global_active_cells(),
          0.);
    dealii::FE_Q<dim>       fe(2);
    dealii::DoFHandler<dim> of_whole(whole.triangulation()), of_shares(shares.triangulation());
    of_whole.distribute_dofs(fe);
    of_shares.distribute_dofs(fe);
    check(title + ": unknowns", of_shares.n_dofs(), of_whole.n_dofs(), 0.);

    // every rank holds the whole mesh here, artificial cells included
    std::map<std::array<long, 3>, dealii::types::boundary_id> boundary;
    std::map<std::array<long, 3>, unsigned int>               number;
    for (const auto &cell : whole.triangulation().cell_iterators_on_level(0))
    {
      number[key(cell->center())] = whole.coarse_cell(cell);
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          boundary[key(face->center())] = face->boundary_id();
    }
    unsigned int wrong_numbers = 0, wrong_faces = 0, n_cut = 0, too_far = 0;
    double       volume = 0., weight = 0.;
    for (const auto &cell : shares.triangulation().active_cell_iterators())
    {
      wrong_numbers += shares.coarse_cell(cell) != number.at(key(cell->center()));
      bool touches = cell->is_locally_owned();
      for (const unsigned int f : cell->face_indices())
      {
        const auto face = cell->face(f);
        const auto id   = boundary.find(key(face->center()));
        const bool cut  = face->at_boundary() && face->boundary_id() == Bodies::no_boundary;
        n_cut += cut;
        wrong_faces += id != boundary.end()  ? !(face->at_boundary() && face->boundary_id() == id->second)
                       : face->at_boundary() ? !(cut && cell->is_ghost())
                                             : 0;
        if (cell->is_locally_owned() && face->at_boundary() && cell->material_id() == 0)
          weight += face->boundary_id() == weighty ? Bodies::slave_face_weight : 0;
      }
      if (cell->is_locally_owned())
      {
        volume += cell->measure();
        weight += Bodies::cell_weight;
      }
      else
        for (const auto &other : shares.triangulation().active_cell_iterators())
          for (const unsigned int v : other->vertex_indices())
            for (const unsigned int w : cell->vertex_indices())
              touches = touches || (other->is_locally_owned() && other->vertex_index(v) == cell->vertex_index(w));
      too_far += !touches;
    }
    const auto sum   = [](const auto value) { return dealii::Utilities::MPI::sum(value, world()); };
    double     exact = 0.;
    for (const auto &cell : whole.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        exact += cell->measure();
    check(title + ": volume", sum(volume), sum(exact), 1e-12);
    check(title + ": numbers of coarse cells", sum(wrong_numbers), 0., 0., 1.);
    check(title + ": boundary ids of owned cells and ghosts", sum(wrong_faces), 0., 0., 1.);
    check(title + ": ghosts touch owned cells", sum(too_far), 0., 0., 1.);
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(world());
    check(title + ": shares end at ghosts", sum(n_cut) > 0 || n_ranks == 1);
    for (unsigned int b = 0; b < whole.size(); ++b)
      check(title + ": the same ids present", whole.boundary_ids(b) == shares.boundary_ids(b));
    const double largest = dealii::Utilities::MPI::max(weight, world()), mean = sum(weight) / n_ranks;
    check(title + ": the heaviest share exceeds the mean by a cell",
          largest - mean <= Bodies::cell_weight + 2 * Bodies::slave_face_weight);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  if (dealii::Utilities::MPI::this_mpi_process(world()) == 0)
  {
    write_cube("cube.msh", 6);
    write_cube("cell.msh", 1);
  }
  MPI_Barrier(world());
  BodyParameters lower;
  lower.mesh_file      = "cube.msh";
  BodyParameters upper = lower;
  upper.translation[2] = 1.5;
  compare("one cube", {lower}, 7);
  compare("two cubes", {lower, upper}, 7);

  BodyParameters cylinder;
  cylinder.mesh_file = SOURCE_DIR "/../meshes/cylinder_27_2.msh";
  compare("second order", {cylinder}, 3);

  check("a bar is cut across", vertices_at_cut_of_bar(), 16., 0.);
  check("blocks are cut between the bodies", slave_faces_of_one(6, 6, 6), 36., 0.);
  check("plates are cut across the contact", slave_faces_of_one(12, 12, 1), 72., 0.);

  BodyParameters cell;
  cell.mesh_file = "cell.msh";
  check_equal("more ranks than cells", Bodies({cell}, world(), false).triangulation().n_global_active_cells(), 1);
}
