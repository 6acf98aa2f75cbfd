#include "mesh/mesh_share.h"
#include "parallel/throw_everywhere.h"
#include "parallel/wait_for_all.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/grid/cell_id.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

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

    bool all_of(const std::vector<char> &flags, const Cell &cell)
    {
      return std::all_of(cell.vertices.begin(), cell.vertices.end(), [&](const unsigned int v) { return flags[v]; });
    }

    /// Faces with the vertices of each, and whether a vertex belongs to any of them.
    template <typename Value>
    struct ByFace
    {
      explicit ByFace(const std::size_t n_vertices)
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
    ByFace<unsigned int>
    cut_faces(const CoarseMesh &mesh, const std::vector<char> &is_local, const std::vector<char> &owned_vertex)
    {
      // The cell behind has no vertex of an owned cell, or it would be a ghost.
      ByFace<unsigned int> n_cells(mesh.vertices.size()); // beside the face, among the local ones
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        if (const Cell &cell = mesh.cells[c]; is_local[c] && !all_of(owned_vertex, cell))
          for (const unsigned int f : Geometry::face_indices())
            if (const Face face = face_of(cell, f);
                std::none_of(face.begin(), face.end(), [&](const unsigned int v) { return owned_vertex[v]; }))
              ++n_cells[face];
      ByFace<unsigned int> cut(mesh.vertices.size());
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        if (!is_local[c] && any_of(n_cells.has_vertex, mesh.cells[c]))
          for (const unsigned int f : Geometry::face_indices())
            if (n_cells.find(mesh.cells[c], f))
              cut[face_of(mesh.cells[c], f)] = 1;
      return cut;
    }

    /// Recursive coordinate bisection of all bodies at once, where the cut is smallest and contact is shared.
    class Bisection
    {
    public:
      Bisection(const CoarseMesh                &mesh,
                const std::vector<unsigned int> &slave_faces,
                const unsigned int               cell_weight,
                const unsigned int               face_weight)
          : mesh_(mesh)
          , slave_faces_(slave_faces)
          , cell_weight_(cell_weight)
          , face_weight_(face_weight)
          , is_lower_(mesh.vertices.size(), 0)
      {
        centres_.reserve(mesh.cells.size());
        for (const Cell &cell : mesh.cells)
        {
          Point centre;
          for (const unsigned int v : cell.vertices)
            centre += mesh.vertices[v] / 8.;
          centres_.push_back(centre);
        }
      }

      std::vector<unsigned int> divide(const unsigned int n_parts) const
      {
        struct Piece
        {
          Cells        cells;
          unsigned int first_part, n_parts;
        };
        Cells all(centres_.size());
        std::iota(all.begin(), all.end(), 0);
        std::vector<unsigned int> part(all.size(), 0);
        for (std::vector<Piece> pieces = {{std::move(all), 0, n_parts}}; !pieces.empty();)
        {
          const Piece piece = std::move(pieces.back());
          pieces.pop_back();
          if (piece.n_parts == 1)
          {
            for (const unsigned int c : piece.cells)
              part[c] = piece.first_part;
            continue;
          }
          const unsigned int n_lower = piece.n_parts / 2;
          const double       share   = double(n_lower) / piece.n_parts;
          Cut                best    = cut(piece.cells, 0, share);
          for (unsigned int d = 1; d < dim; ++d)
            if (Cut other = cut(piece.cells, d, share); other.cost < best.cost)
              best = std::move(other);
          pieces.push_back({std::move(best.lower), piece.first_part, n_lower});
          pieces.push_back({std::move(best.upper), piece.first_part + n_lower, piece.n_parts - n_lower});
        }
        return part;
      }

    private:
      using Cells = std::vector<unsigned int>;
      struct Cut
      {
        Cells  lower, upper;
        double cost;
      };
      /// What a node at a cut costs, in nodes: it belongs to the ghosts of levels, rows and products on both sides.
      static constexpr double node_at_cut = 5.;
      /// What a slave face costs, in cells, where the ranks without contact wait for those with it: they sleep, which
      /// costs time but no power, and so the half of what evaluating it takes.
      static constexpr double waiting_for_face = 5.;
      /// Of the weight of a part, by which a cut may miss it for the sake of a plane between layers of cells.
      static constexpr double tolerance = 0.01;

      /// The lower part gets @p share of the weight.
      Cut cut(const Cells &cells, const unsigned int direction, const double share) const
      {
        std::vector<std::pair<double, unsigned int>> order; // position and cell
        order.reserve(cells.size());
        for (const unsigned int c : cells)
          order.emplace_back(centres_[c][direction], c);
        std::sort(order.begin(), order.end());
        const auto weight = [&](const unsigned int c) { return cell_weight_ + double(face_weight_) * slave_faces_[c]; };
        double     total = 0., n_faces = 0.;
        for (const auto &[x, c] : order)
        {
          total += weight(c);
          n_faces += slave_faces_[c];
        }
        const double wanted = share * total, room = tolerance * std::min(share, 1. - share) * total;
        double       before = 0., widest = -1.;
        std::size_t  n_lower = order.size();
        for (std::size_t k = 0; k < order.size(); ++k)
        {
          if (before >= wanted - room && before <= wanted + room && k > 0)
            if (const double gap = order[k].first - order[k - 1].first; gap > widest)
            {
              widest  = gap;
              n_lower = k;
            }
          if (widest < 0. && before > wanted + room)
          {
            n_lower = k; // heavier than the room is the last cell
            break;
          }
          before += weight(order[k].second);
        }
        Cut result{};
        for (std::size_t k = 0; k < order.size(); ++k)
          (k < n_lower ? result.lower : result.upper).push_back(order[k].second);
        if (result.lower.empty() || result.upper.empty())
        {
          result.cost = std::numeric_limits<double>::max();
          return result;
        }
        double n_faces_lower = 0.;
        for (const unsigned int c : result.lower)
        {
          n_faces_lower += slave_faces_[c];
          for (const unsigned int v : mesh_.cells[c].vertices)
            is_lower_[v] = 1;
        }
        unsigned int n_cut = 0;
        for (const unsigned int c : result.upper)
          for (const unsigned int v : mesh_.cells[c].vertices)
            if (is_lower_[v])
            {
              is_lower_[v] = 0; // counted
              ++n_cut;
            }
        for (const unsigned int c : result.lower)
          for (const unsigned int v : mesh_.cells[c].vertices)
            is_lower_[v] = 0;
        result.cost = node_at_cut * n_cut + waiting_for_face * std::abs(n_faces_lower - share * n_faces) / (1. - share);
        return result;
      }

      const CoarseMesh                &mesh_;
      const std::vector<unsigned int> &slave_faces_;
      const unsigned int               cell_weight_, face_weight_;
      std::vector<Point>               centres_;
      mutable std::vector<char>        is_lower_; ///< by vertex; zeros
    };
  } // namespace

  CoarseMesh from_first_rank(const std::function<CoarseMesh()> &read, const MPI_Comm communicator)
  {
    namespace MPI = dealii::Utilities::MPI;
    if (MPI::n_mpi_processes(communicator) == 1)
      return read();
    const bool                first = MPI::this_mpi_process(communicator) == 0;
    CoarseMesh                mesh;
    std::vector<double>       positions; // of the vertices, and of the nodes of curved cells
    std::vector<unsigned int> cells, quads;
    std::string               failure;
    if (first)
      try
      {
        mesh = read();
        for (const Point &x : mesh.vertices)
          positions.insert(positions.end(), &x[0], &x[0] + dim);
        for (const QuadraticCell &cell : mesh.curved)
          for (const Point &x : cell.nodes)
            positions.insert(positions.end(), &x[0], &x[0] + dim);
        for (const Cell &cell : mesh.cells)
          cells.insert(cells.end(), cell.vertices.begin(), cell.vertices.end());
        for (const auto &quad : mesh.boundary.boundary_quads)
        {
          quads.insert(quads.end(), quad.vertices.begin(), quad.vertices.end());
          quads.push_back(quad.boundary_id);
        }
      }
      catch (const InputError &error)
      {
        failure = error.what();
      }
    wait_for_all(communicator);
    throw_everywhere<InputError>(failure, communicator);

    unsigned int size[] = {static_cast<unsigned int>(mesh.vertices.size()),
                           static_cast<unsigned int>(mesh.cells.size()),
                           static_cast<unsigned int>(mesh.boundary.boundary_quads.size()),
                           static_cast<unsigned int>(mesh.curved.size())};
    MPI::broadcast(size, 4, 0, communicator);
    constexpr unsigned int n_nodes = std::tuple_size<decltype(QuadraticCell::nodes)>::value;
    positions.resize(dim * (size[0] + std::size_t(n_nodes) * size[3]));
    cells.resize(Geometry::vertices_per_cell * std::size_t(size[1]));
    quads.resize(5 * std::size_t(size[2]));
    MPI::broadcast(positions.data(), positions.size(), 0, communicator);
    MPI::broadcast(cells.data(), cells.size(), 0, communicator);
    MPI::broadcast(quads.data(), quads.size(), 0, communicator);
    mesh.boundary_names = MPI::broadcast(communicator, mesh.boundary_names);
    if (first)
      return mesh;

    const double *x    = positions.data();
    const auto    next = [&x]
    {
      const Point point(x[0], x[1], x[2]);
      x += dim;
      return point;
    };
    for (unsigned int i = 0; i < size[0]; ++i)
      mesh.vertices.push_back(next());
    mesh.curved.resize(size[3]);
    for (QuadraticCell &cell : mesh.curved)
      for (Point &node : cell.nodes)
        node = next();
    mesh.cells.resize(size[1]);
    for (unsigned int c = 0; c < size[1]; ++c)
      std::copy_n(&cells[Geometry::vertices_per_cell * std::size_t(c)],
                  Geometry::vertices_per_cell,
                  mesh.cells[c].vertices.begin());
    mesh.boundary.boundary_quads.resize(size[2]);
    for (unsigned int q = 0; q < size[2]; ++q)
    {
      auto &quad = mesh.boundary.boundary_quads[q];
      std::copy_n(&quads[5 * std::size_t(q)], 4, quad.vertices.begin());
      quad.boundary_id = quads[5 * std::size_t(q) + 4];
    }
    return mesh;
  }

  std::vector<unsigned int> divide(const CoarseMesh                &mesh,
                                   const std::vector<unsigned int> &slave_faces,
                                   const unsigned int               cell_weight,
                                   const unsigned int               face_weight,
                                   const unsigned int               n_parts)
  {
    if (n_parts == 1)
      return std::vector<unsigned int>(mesh.cells.size(), 0);
    return Bisection(mesh, slave_faces, cell_weight, face_weight).divide(n_parts);
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

    ByFace<dealii::types::boundary_id> labels(mesh.vertices.size());
    for (const auto &quad : mesh.boundary.boundary_quads)
    {
      Face face = {{quad.vertices[0], quad.vertices[1], quad.vertices[2], quad.vertices[3]}};
      std::sort(face.begin(), face.end());
      labels[face] = quad.boundary_id;
    }
    ByFace<unsigned int> cut = cut_faces(mesh, is_local, owned_vertex);

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
