#include <nodus/mesh/gmsh_reader.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <unordered_map>

namespace Nodus
{
  namespace
  {
    using PhysicalIds = std::vector<int>;

    /// What of an element matters here; nodes index into Raw::vertices, the corners come first.
    struct Element
    {
      PhysicalIds               physical;
      std::vector<unsigned int> nodes;
    };

    /// The file as it is, before any selection.
    struct Raw
    {
      std::vector<Point>                               vertices;
      std::unordered_map<long, unsigned int>           index; ///< node tag -> index into vertices
      std::vector<Element>                             quadrilaterals, hexahedra;
      std::vector<std::pair<std::string, PhysicalIds>> others; ///< volume elements that are no hexahedra
    };

    /// Reads one file; every failure carries its name.
    class Reader
    {
    public:
      explicit Reader(const std::string &file)
          : file_(file)
          , in_(file)
      {
        if (!in_)
          fail("cannot be opened; the path is relative to the folder of the .prm file");
      }

      Raw read()
      {
        std::string version;
        for (std::string section; in_ >> section;)
        {
          // A file may hold sections that say nothing about the mesh (names, periodicity, fields): skip them whole.
          if (section == "$MeshFormat")
            version = read_format();
          else if (version.empty())
            fail("is not a gmsh .msh file: it does not start with $MeshFormat");
          else if (section == "$Entities")
            read_entities();
          else if (section == "$Nodes")
            version == "2.2" ? read_nodes_22() : read_nodes_41();
          else if (section == "$Elements")
            version == "2.2" ? read_elements_22() : read_elements_41();
          else if (!section.empty() && section[0] == '$' && section.compare(0, 4, "$End") != 0)
            for (std::string line; std::getline(in_, line) && line.compare(0, 4, "$End") != 0;)
              ;
        }
        if (version.empty())
          fail("is not a gmsh .msh file: it does not start with $MeshFormat");
        return std::move(raw_);
      }

      [[noreturn]] void fail(const std::string &reason) const
      {
        throw InputError("mesh file " + file_ + ": " + reason);
      }

    private:
      template <typename Number>
      Number next()
      {
        Number value;
        if (!(in_ >> value))
          fail("ends early or holds text where a number belongs; write it again with gmsh");
        return value;
      }

      std::string read_format()
      {
        const auto version = next<std::string>();
        const bool binary  = next<int>() != 0;
        if (binary)
          fail("is binary: save with Mesh.Binary=0");
        if (version != "2.2" && version != "4.1")
          fail("has format " + version + ": save with Mesh.MshFileVersion=4.1 (or 2.2)");
        return version;
      }

      PhysicalIds read_physical_ids()
      {
        PhysicalIds ids(next<std::size_t>());
        for (int &id : ids)
          id = std::abs(next<int>()); // the sign holds the orientation only
        return ids;
      }

      /// Which physical groups each curve, surface, ... is in (4.1 only).
      void read_entities()
      {
        std::array<std::size_t, 4> n;
        for (auto &i : n)
          i = next<std::size_t>();
        for (unsigned int d = 0; d < 4; ++d)
          for (std::size_t i = 0; i < n[d]; ++i)
          {
            const int tag = next<int>();
            for (unsigned int j = 0; j < (d == 0 ? 3 : 6); ++j)
              next<double>(); // position or bounding box
            entities_[{d, tag}] = read_physical_ids();
            if (d > 0)
              for (auto j = next<std::size_t>(); j > 0; --j)
                next<int>(); // the entities that bound it
          }
      }

      void read_vertex(const long tag)
      {
        Point p;
        for (unsigned int d = 0; d < dim; ++d)
          p[d] = next<double>();
        raw_.index[tag] = raw_.vertices.size();
        raw_.vertices.push_back(p);
      }

      void read_nodes_22()
      {
        for (auto n = next<std::size_t>(); n > 0; --n)
          read_vertex(next<long>());
      }

      void read_nodes_41()
      {
        const auto n_blocks = next<std::size_t>();
        for (unsigned int i = 0; i < 3; ++i)
          next<std::size_t>(); // number of nodes, smallest and largest tag
        for (std::size_t block = 0; block < n_blocks; ++block)
        {
          const auto dimension = next<int>();
          next<int>(); // entity
          const bool        parametric = next<int>() != 0;
          std::vector<long> tags(next<std::size_t>());
          for (long &tag : tags)
            tag = next<long>();
          for (const long tag : tags)
          {
            read_vertex(tag);
            for (int d = 0; parametric && d < dimension; ++d)
              next<double>();
          }
        }
      }

      void read_elements_22()
      {
        for (auto n = next<std::size_t>(); n > 0; --n)
        {
          next<long>(); // element number
          const auto       type = next<int>();
          std::vector<int> tags(next<std::size_t>());
          for (int &tag : tags)
            tag = next<int>();
          read_element(type, tags.empty() || tags[0] == 0 ? PhysicalIds() : PhysicalIds{std::abs(tags[0])});
        }
      }

      void read_elements_41()
      {
        const auto n_blocks = next<std::size_t>();
        for (unsigned int i = 0; i < 3; ++i)
          next<std::size_t>(); // number of elements, smallest and largest tag
        for (std::size_t block = 0; block < n_blocks; ++block)
        {
          const auto  dimension = next<int>();
          const auto  tag       = next<int>();
          const auto  type      = next<int>();
          const auto  entity    = entities_.find({dimension, tag});
          PhysicalIds physical;
          if (entity != entities_.end())
            physical = entity->second;
          for (auto n = next<std::size_t>(); n > 0; --n)
          {
            next<long>(); // element number
            read_element(type, physical);
          }
        }
      }

      void read_element(const int type, const PhysicalIds &physical)
      {
        // gmsh's types 1 to 19 are the elements of first and second order
        static constexpr unsigned int n_nodes[20] = {0, 2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13};
        if (type < 1 || type > 19)
          fail("holds elements of gmsh type " + std::to_string(type) +
               ", nodus reads those of first and second order only: save with Mesh.ElementOrder=2 or 1");

        Element element{physical, std::vector<unsigned int>(n_nodes[type])};
        for (unsigned int &node : element.nodes)
        {
          const auto tag   = next<long>();
          const auto index = raw_.index.find(tag);
          if (index == raw_.index.end())
            fail("uses node " + std::to_string(tag) + ", which it does not define; write it again with gmsh");
          node = index->second;
        }
        const auto is = [type](const std::initializer_list<int> types)
        { return std::find(types.begin(), types.end(), type) != types.end(); };
        if (is({3, 10, 16}))
          raw_.quadrilaterals.push_back(std::move(element));
        else if (is({5, 12, 17}))
        {
          if (!raw_.hexahedra.empty() && raw_.hexahedra[0].nodes.size() != element.nodes.size())
            fail("mixes hexahedra of " + std::to_string(raw_.hexahedra[0].nodes.size()) + " and of " +
                 std::to_string(element.nodes.size()) +
                 " nodes: save the whole mesh with one Mesh.ElementOrder and one Mesh.SecondOrderIncomplete");
          raw_.hexahedra.push_back(std::move(element));
        }
        else if (is({4, 11}))
          raw_.others.emplace_back("tetrahedra", physical);
        else if (is({6, 13, 18}))
          raw_.others.emplace_back("prisms", physical);
        else if (is({7, 14, 19}))
          raw_.others.emplace_back("pyramids", physical);
      }

      std::string                                file_;
      std::ifstream                              in_;
      Raw                                        raw_;
      std::map<std::pair<int, int>, PhysicalIds> entities_;
    };

    std::string list(const std::set<int> &ids)
    {
      std::ostringstream text;
      for (const int id : ids)
        text << (text.tellp() > 0 ? ", " : "") << id;
      return ids.empty() ? "none" : text.str();
    }

    using Face = std::array<unsigned int, 4>;

    Face sorted(Face face)
    {
      std::sort(face.begin(), face.end());
      return face;
    }

    /// The faces that belong to a single cell, sorted corners in ascending order.
    std::vector<Face> boundary_faces(const std::vector<dealii::CellData<dim>> &cells, const Reader &reader)
    {
      std::vector<Face> all, once;
      all.reserve(6 * cells.size());
      for (const auto &cell : cells)
        for (const unsigned int f : dealii::GeometryInfo<dim>::face_indices())
        {
          Face face;
          for (unsigned int v = 0; v < 4; ++v)
            face[v] = cell.vertices[dealii::GeometryInfo<dim>::face_to_cell_vertices(f, v)];
          all.push_back(sorted(face));
        }
      std::sort(all.begin(), all.end());
      for (auto first = all.begin(); first != all.end();)
      {
        const auto last = std::find_if(first, all.end(), [&](const Face &face) { return face != *first; });
        if (last - first == 1)
          once.push_back(*first);
        else if (last - first > 2)
          reader.fail("a face is shared by more than two hexahedra: cells overlap, or a volume is in two physical "
                      "groups; give each volume one physical id");
        first = last;
      }
      return once;
    }
  } // namespace

  CoarseMesh read_gmsh(const std::string &file, const std::vector<unsigned int> &volume_ids)
  {
    Reader reader(file);
    Raw    raw = reader.read();

    const auto selected = [&](const PhysicalIds &physical)
    {
      return volume_ids.empty() ||
             std::any_of(physical.begin(),
                         physical.end(),
                         [&](const int id)
                         { return std::find(volume_ids.begin(), volume_ids.end(), id) != volume_ids.end(); });
    };

    std::set<int> present;
    for (const auto &hexahedron : raw.hexahedra)
      present.insert(hexahedron.physical.begin(), hexahedron.physical.end());
    for (const auto &[type, physical] : raw.others)
    {
      if (selected(physical))
        reader.fail("holds " + type +
                    ", nodus needs hexahedra only: use transfinite or extruded volumes with Recombine, or select "
                    "other volumes with 'Volume ids'");
      present.insert(physical.begin(), physical.end());
    }
    if (raw.hexahedra.empty())
      reader.fail("holds no hexahedra; check that the volumes are meshed (gmsh -3) and, where the file has physical "
                  "groups, that the volumes are in one");
    for (const unsigned int id : volume_ids)
      if (present.count(id) == 0)
        reader.fail("has no volume with physical id " + std::to_string(id) + "; ids present: " + list(present));

    CoarseMesh mesh;
    for (const auto &hexahedron : raw.hexahedra)
      if (selected(hexahedron.physical))
      {
        dealii::CellData<dim> cell;
        for (unsigned int v = 0; v < 8; ++v)
          cell.vertices[dealii::GeometryInfo<dim>::ucd_to_deal[v]] = hexahedron.nodes[v];
        mesh.cells.push_back(cell);
        if (hexahedron.nodes.size() > 8)
        {
          std::vector<Point> nodes;
          for (const unsigned int node : hexahedron.nodes)
            nodes.push_back(raw.vertices[node]);
          mesh.curved.push_back(QuadraticCell::from_gmsh(nodes));
        }
      }

    const std::vector<Face> boundary = boundary_faces(mesh.cells, reader);
    std::map<Face, int>     id_of_face;
    for (const auto &quadrilateral : raw.quadrilaterals)
    {
      if (quadrilateral.physical.empty())
        continue;
      const auto &c    = quadrilateral.nodes;
      const Face  face = sorted({{c[0], c[1], c[2], c[3]}});
      if (!std::binary_search(boundary.begin(), boundary.end(), face))
        continue; // of another body, or inside this one

      std::set<int> ids(quadrilateral.physical.begin(), quadrilateral.physical.end());
      const auto    other = id_of_face.find(face);
      if (other != id_of_face.end())
        ids.insert(other->second);
      if (ids.size() > 1)
      {
        std::ostringstream where;
        where << 0.25 * (raw.vertices[c[0]] + raw.vertices[c[1]] + raw.vertices[c[2]] + raw.vertices[c[3]]);
        reader.fail("the face at " + where.str() + " has the physical ids " + list(ids) +
                    "; give each surface one physical id");
      }
      if (other != id_of_face.end())
        continue;
      id_of_face[face] = *ids.begin();

      dealii::CellData<2> data;
      data.vertices    = {c[0], c[1], c[3], c[2]};
      data.boundary_id = *ids.begin();
      mesh.boundary.boundary_quads.push_back(data);
    }

    mesh.vertices = std::move(raw.vertices);
    dealii::GridTools::delete_unused_vertices(mesh.vertices, mesh.cells, mesh.boundary);
    const std::vector<dealii::CellData<dim>> before = mesh.cells;
    // A body that was mirrored, or extruded downwards, has its nodes in the other order; tangled cells are caught
    // later.
    dealii::GridTools::invert_cells_with_negative_measure(mesh.vertices, mesh.cells);
    dealii::GridTools::consistently_order_cells(mesh.cells);
    for (unsigned int c = 0; c < mesh.curved.size(); ++c)
      mesh.curved[c] = mesh.curved[c].reoriented(before[c].vertices, mesh.cells[c].vertices);
    return mesh;
  }
} // namespace Nodus
