#include <nodus/mesh/mesh_share.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/cell_id.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace Nodus
{
  namespace
  {
    using Cell     = dealii::CellData<dim>;
    using Geometry = dealii::GeometryInfo<dim>;
    using Face     = std::array<unsigned int, 4>; ///< its vertices, ascending

    Face face_of(const Cell &cell, const unsigned int f)
    {
      Face face;
      for (unsigned int v = 0; v < 4; ++v)
        face[v] = cell.vertices[Geometry::face_to_cell_vertices(f, v)];
      std::sort(face.begin(), face.end());
      return face;
    }

    bool all_of_face(const std::vector<char> &flags, const Cell &cell, const unsigned int f)
    {
      for (unsigned int v = 0; v < 4; ++v)
        if (!flags[cell.vertices[Geometry::face_to_cell_vertices(f, v)]])
          return false;
      return true;
    }

    bool any_of(const std::vector<char> &flags, const Cell &cell)
    {
      return std::any_of(cell.vertices.begin(), cell.vertices.end(), [&](const unsigned int v) { return flags[v]; });
    }

    /// Faces with the vertices of each, and whether a vertex belongs to any of them.
    template <typename Value>
    struct FaceTable
    {
      explicit FaceTable(const std::size_t n_vertices)
          : has_vertex(n_vertices, 0)
      {
      }
      Value &operator[](const Face &face)
      {
        for (const unsigned int v : face)
          has_vertex[v] = 1;
        return values[face];
      }
      /// Null where it is not there.
      Value *find(const Cell &cell, const unsigned int f)
      {
        if (!all_of_face(has_vertex, cell, f))
          return nullptr;
        const auto found = values.find(face_of(cell, f));
        return found == values.end() ? nullptr : &found->second;
      }

      std::map<Face, Value> values;
      std::vector<char>     has_vertex;
    };

    /// Faces of ghosts at which the share ends, but not the mesh.
    FaceTable<unsigned int>
    cut_faces(const CoarseMesh &mesh, const std::vector<char> &is_local, const std::vector<char> &owned_vertex)
    {
      // The cell behind has no vertex of an owned cell, or it would be a ghost.
      FaceTable<unsigned int> n_cells(mesh.vertices.size()); // beside the face, among the local ones
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        for (const unsigned int f : Geometry::face_indices())
          if (const Cell &cell = mesh.cells[c]; is_local[c])
            if (const Face face = face_of(cell, f);
                std::none_of(face.begin(), face.end(), [&](const unsigned int v) { return owned_vertex[v]; }))
              ++n_cells[face];
      FaceTable<unsigned int> cut(mesh.vertices.size());
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        if (!is_local[c] && any_of(n_cells.has_vertex, mesh.cells[c]))
          for (const unsigned int f : Geometry::face_indices())
            if (n_cells.find(mesh.cells[c], f))
              cut[face_of(mesh.cells[c], f)] = 1;
      return cut;
    }
  } // namespace

  std::vector<unsigned int>
  divide(const CoarseMesh &mesh, const std::vector<unsigned int> &weights, const unsigned int n_parts)
  {
    const std::size_t         n_cells = mesh.cells.size();
    std::vector<unsigned int> part(n_cells, 0);
    if (n_parts == 1)
      return part;
    constexpr int      bits = 21; // per direction, in 64
    std::vector<Point> centres;
    for (const Cell &cell : mesh.cells)
    {
      Point centre;
      for (const unsigned int v : cell.vertices)
        centre += mesh.vertices[v] / 8.;
      centres.push_back(centre);
    }
    const auto               curve = dealii::Utilities::inverse_Hilbert_space_filling_curve<dim>(centres, bits);
    std::vector<std::size_t> order(n_cells);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(),
              order.end(),
              [&](const std::size_t a, const std::size_t b)
              {
                const auto body_a = mesh.cells[a].material_id, body_b = mesh.cells[b].material_id;
                return body_a != body_b ? body_a < body_b : curve[a] != curve[b] ? curve[a] < curve[b] : a < b;
              });
    const double total  = std::accumulate(weights.begin(), weights.end(), 0.);
    double       before = 0.;
    for (const std::size_t c : order)
    {
      part[c] = std::min(static_cast<unsigned int>((before + .5 * weights[c]) * n_parts / total), n_parts - 1);
      before += weights[c];
    }
    return part;
  }

  dealii::TriangulationDescription::Description<dim, dim> share_of(const CoarseMesh                &mesh,
                                                                   const std::vector<unsigned int> &owner,
                                                                   const dealii::types::boundary_id cut_id,
                                                                   const MPI_Comm                   communicator)
  {
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
    const std::size_t  n    = mesh.cells.size();
    std::vector<char>  owned_vertex(mesh.vertices.size(), 0), is_local(n, 0);
    for (std::size_t c = 0; c < n; ++c)
      if (owner[c] == rank)
        for (const unsigned int v : mesh.cells[c].vertices)
          owned_vertex[v] = 1;
    for (std::size_t c = 0; c < n; ++c)
      is_local[c] = any_of(owned_vertex, mesh.cells[c]);

    FaceTable<dealii::types::boundary_id> labels(mesh.vertices.size());
    for (const auto &quad : mesh.boundary.boundary_quads)
    {
      Face face = {{quad.vertices[0], quad.vertices[1], quad.vertices[2], quad.vertices[3]}};
      std::sort(face.begin(), face.end());
      labels[face] = quad.boundary_id;
    }
    FaceTable<unsigned int> cut = cut_faces(mesh, is_local, owned_vertex);

    dealii::TriangulationDescription::Description<dim, dim> share;
    share.comm      = communicator;
    share.settings  = dealii::TriangulationDescription::default_setting;
    share.smoothing = dealii::Triangulation<dim>::none;
    share.cell_infos.resize(1);
    std::vector<unsigned int> number(mesh.vertices.size(), dealii::numbers::invalid_unsigned_int);
    for (std::size_t c = 0; c < n; ++c)
      if (is_local[c])
      {
        const Cell &cell = mesh.cells[c];
        share.coarse_cells.push_back(cell);
        for (unsigned int &v : share.coarse_cells.back().vertices)
        {
          if (number[v] == dealii::numbers::invalid_unsigned_int)
          {
            number[v] = share.coarse_cell_vertices.size();
            share.coarse_cell_vertices.push_back(mesh.vertices[v]);
          }
          v = number[v];
        }
        share.coarse_cell_index_to_coarse_cell_id.push_back(c);

        auto &info        = share.cell_infos[0].emplace_back();
        info.id           = dealii::CellId(c, std::vector<std::uint8_t>()).to_binary<dim>();
        info.subdomain_id = info.level_subdomain_id = owner[c];
        info.manifold_id                            = dealii::numbers::flat_manifold_id;
        info.manifold_line_ids.fill(dealii::numbers::flat_manifold_id);
        info.manifold_quad_ids.fill(dealii::numbers::flat_manifold_id);
        for (const unsigned int f : Geometry::face_indices())
          if (const auto *const id = labels.find(cell, f))
            info.boundary_ids.emplace_back(f, *id);
          else if (cut.find(cell, f))
            info.boundary_ids.emplace_back(f, cut_id);
      }
    return share;
  }
} // namespace Nodus
