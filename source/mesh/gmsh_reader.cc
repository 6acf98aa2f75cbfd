#include "mesh/gmsh_reader.h"
#include "mesh/gmsh_content.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace Nodus
{
  namespace
  {
    using Face = GmshContent::Face;

    using Names = std::map<unsigned int, std::string>;

    std::string list(const std::set<int> &ids, const Names &names)
    {
      std::string text;
      for (const int id : ids)
        text += (text.empty() ? "" : ", ") + named_id(id, names);
      return ids.empty() ? "none" : text;
    }

    Face sorted(Face face)
    {
      std::sort(face.begin(), face.end());
      return face;
    }

    /// The faces that belong to a single cell, sorted corners in ascending order.
    std::vector<Face> boundary_faces(const std::vector<dealii::CellData<dim>> &cells, const std::string &file)
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
          refuse_gmsh(file,
                      "a face is shared by more than two hexahedra: cells overlap, or a volume is in two physical "
                      "groups; give each volume one physical id");
        first = last;
      }
      return once;
    }

    /// Which groups have one of the physical ids; all where there are none.
    std::vector<char> selected_groups(const GmshContent &file, const std::vector<unsigned int> &volume_ids)
    {
      std::vector<char> selected;
      for (const GmshContent::PhysicalIds &physical : file.physical)
        selected.push_back(volume_ids.empty() ||
                           std::any_of(physical.begin(),
                                       physical.end(),
                                       [&](const int id) {
                                         return std::find(volume_ids.begin(), volume_ids.end(), id) != volume_ids.end();
                                       }));
      return selected;
    }

    /// Before the last way out.
    std::string way_to_hexahedra(const GmshContent::Other &other, const std::string &name)
    {
      const std::string in_gmsh = "use transfinite or extruded volumes with Recombine, or";
      if (std::string(other.type) == "pyramids")
        return in_gmsh;
      return "'contrib/convert " + name + " hexahedra.msh' makes them of tetrahedra and prisms; or " + in_gmsh;
    }

    /// @throws InputError where the selected volumes are not there, or not of hexahedra.
    void check_selection(const GmshContent               &file,
                         const std::vector<unsigned int> &volume_ids,
                         const std::vector<char>         &selected,
                         const std::string               &name,
                         const Names                     &volume_names)
    {
      std::vector<char> has_volume(file.physical.size(), 0);
      for (const auto &hexahedron : file.hexahedra)
        has_volume[hexahedron.group] = 1;
      for (const auto &other : file.others)
      {
        if (selected[other.group])
          refuse_gmsh(name,
                      "holds " + std::string(other.type) + ", nodus needs hexahedra only: " +
                          way_to_hexahedra(other, name) + " select other volumes with 'Volume ids'");
        has_volume[other.group] = 1;
      }
      std::set<int> present;
      for (unsigned int g = 0; g < has_volume.size(); ++g)
        if (has_volume[g])
          present.insert(file.physical[g].begin(), file.physical[g].end());
      if (file.hexahedra.empty())
        refuse_gmsh(name,
                    "holds no hexahedra; check that the volumes are meshed (gmsh -3) and, where the file has physical "
                    "groups, that the volumes are in one");
      for (const unsigned int id : volume_ids)
        if (present.count(id) == 0)
          refuse_gmsh(name,
                      "has no volume with physical id " + named_id(id, volume_names) +
                          "; ids present: " + list(present, volume_names));
    }

    /// In the order of deal.II.
    std::array<unsigned int, 8> corners(const GmshContent &file, const GmshContent::Hexahedron &hexahedron)
    {
      std::array<unsigned int, 8> corner;
      for (unsigned int v = 0; v < 8; ++v)
        corner[dealii::GeometryInfo<dim>::ucd_to_deal[v]] = file.nodes[hexahedron.first_node + v];
      return corner;
    }

    /// Adds the selected hexahedra, with the vertex numbers of the file.
    void add_cells(const GmshContent &file, const std::vector<char> &selected, CoarseMesh &mesh)
    {
      for (const auto &hexahedron : file.hexahedra)
        if (selected[hexahedron.group])
        {
          const unsigned int               *nodes  = file.nodes.data() + hexahedron.first_node;
          const std::array<unsigned int, 8> corner = corners(file, hexahedron);
          dealii::CellData<dim>             cell;
          std::copy(corner.begin(), corner.end(), cell.vertices.begin());
          mesh.cells.push_back(cell);
          if (file.n_nodes_per_hexahedron > 8)
          {
            std::vector<Point> points;
            for (unsigned int i = 0; i < file.n_nodes_per_hexahedron; ++i)
              points.push_back(file.vertices[nodes[i]]);
            mesh.curved.push_back(QuadraticCell::from_gmsh(points));
          }
        }
    }

    /// Adds the physical surfaces on the boundary of the cells. @throws InputError for faces with two ids.
    void add_boundary(const GmshContent &file, const std::string &name, const Names &names, CoarseMesh &mesh)
    {
      const std::vector<Face> boundary = boundary_faces(mesh.cells, name);
      std::map<Face, int>     id_of_face;
      for (const auto &quadrilateral : file.quadrilaterals)
      {
        const GmshContent::PhysicalIds &physical = file.physical[quadrilateral.group];
        if (physical.empty())
          continue;
        const Face &c    = quadrilateral.corners;
        const Face  face = sorted(c);
        if (!std::binary_search(boundary.begin(), boundary.end(), face))
          continue; // of another body, or inside this one

        std::set<int> ids(physical.begin(), physical.end());
        const auto    other = id_of_face.find(face);
        if (other != id_of_face.end())
          ids.insert(other->second);
        if (ids.size() > 1)
        {
          std::ostringstream where;
          where << 0.25 * (file.vertices[c[0]] + file.vertices[c[1]] + file.vertices[c[2]] + file.vertices[c[3]]);
          refuse_gmsh(name,
                      "the face at " + where.str() + " has the physical ids " + list(ids, names) +
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
    }

    /// Physical surfaces that belong to the hexahedra in part: the rest would be missing without a word. @throws
    /// InputError
    void refuse_stray_faces(const GmshContent &file, const std::string &name)
    {
      struct Found
      {
        unsigned int faces = 0, strays = 0;
        Point        first;
      };
      std::vector<char> marked(file.vertices.size(), 0);
      std::vector<Face> faces; // of hexahedra, all of whose corners have a physical surface
      for (const auto &quadrilateral : file.quadrilaterals)
        for (const unsigned int v : quadrilateral.corners)
          marked[v] = marked[v] || !file.physical[quadrilateral.group].empty();
      for (const auto &hexahedron : file.hexahedra)
      {
        const std::array<unsigned int, 8> corner = corners(file, hexahedron);
        for (const unsigned int f : dealii::GeometryInfo<dim>::face_indices())
        {
          Face face;
          for (unsigned int v = 0; v < 4; ++v)
            face[v] = corner[dealii::GeometryInfo<dim>::face_to_cell_vertices(f, v)];
          if (std::all_of(face.begin(), face.end(), [&](const unsigned int v) { return marked[v]; }))
            faces.push_back(sorted(face));
        }
      }
      std::sort(faces.begin(), faces.end());
      std::map<int, Found> of_id;
      for (const auto &quadrilateral : file.quadrilaterals)
        for (const int id : file.physical[quadrilateral.group])
        {
          Found      &found = of_id[id];
          const Face &c     = quadrilateral.corners;
          ++found.faces;
          if (!std::binary_search(faces.begin(), faces.end(), sorted(c)) && found.strays++ == 0)
            found.first =
                0.25 * (file.vertices[c[0]] + file.vertices[c[1]] + file.vertices[c[2]] + file.vertices[c[3]]);
        }
      for (const auto &[id, found] : of_id)
        if (found.strays > 0 && found.strays < found.faces)
        {
          std::ostringstream text;
          text << "has " << found.faces << " faces with the physical id " << id << ", of which " << found.strays
               << " are no face of a hexahedron, the first at " << found.first
               << "; mesh surfaces and volumes together, and save them all (Mesh.SaveAll=0 with the volumes in a "
                  "physical group)";
          refuse_gmsh(name, text.str());
        }
    }

    /// Turns the cells as deal.II wants them, the curved ones with them.
    void orient_cells(CoarseMesh &mesh)
    {
      const std::vector<dealii::CellData<dim>> before = mesh.cells;
      // A body that was mirrored, or extruded downwards, has its nodes in the other order; tangled cells are caught
      // later.
      dealii::GridTools::invert_cells_with_negative_measure(mesh.vertices, mesh.cells);
      dealii::GridTools::consistently_order_cells(mesh.cells);
      for (unsigned int c = 0; c < mesh.curved.size(); ++c)
        mesh.curved[c] = mesh.curved[c].reoriented(before[c].vertices, mesh.cells[c].vertices);
    }
  } // namespace

  GmshFile::GmshFile(const std::string &name)
      : name_(name)
      , content_(std::make_unique<GmshContent>(read_gmsh(name)))
      , names_(read_physical_names(name))
  {
    refuse_stray_faces(*content_, name);
  }
  GmshFile::~GmshFile()                    = default;
  GmshFile::GmshFile(GmshFile &&) noexcept = default;

  CoarseMesh GmshFile::body(const std::vector<unsigned int> &volume_ids) const
  {
    const std::vector<char> selected = selected_groups(*content_, volume_ids);
    check_selection(*content_, volume_ids, selected, name_, names_.volumes);

    CoarseMesh mesh;
    mesh.boundary_names = names_.surfaces;
    add_cells(*content_, selected, mesh);
    add_boundary(*content_, name_, names_.surfaces, mesh);
    mesh.vertices = content_->vertices;
    dealii::GridTools::delete_unused_vertices(mesh.vertices, mesh.cells, mesh.boundary);
    orient_cells(mesh);
    return mesh;
  }
} // namespace Nodus
