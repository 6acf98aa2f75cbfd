#ifndef nodus_mesh_gmsh_reader_h
#define nodus_mesh_gmsh_reader_h

#include "mesh/curved_geometry.h"
#include "parameters/physical_names.h"
#include <nodus/base/types.h>

#include <deal.II/grid/tria_description.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// Vertices, cells and boundary faces of one body, ready for create_triangulation.
  struct CoarseMesh
  {
    std::vector<Point>                  vertices;
    std::vector<dealii::CellData<dim>>  cells;
    dealii::SubCellData                 boundary;       ///< faces with an id other than 0; may hold manifold ids
    std::vector<QuadraticCell>          curved;         ///< one per cell of a second-order file, else empty
    std::map<unsigned int, std::string> boundary_names; ///< of physical surfaces, by id
  };

  struct GmshContent;

  /// A gmsh file (text or binary, version 2.2 or 4.1), of which several bodies may take their volumes.
  ///
  /// Not GridIn::read_msh: bodies are cut out here before a triangulation exists, so that two bodies may come from one
  /// file whose volumes share the nodes of their interface, and a physical surface inside a body is ignored; GridIn
  /// throws for both, and for second-order files.
  ///
  /// @throws InputError: the message starts with the file name and ends with the fix.
  class GmshFile
  {
  public:
    explicit GmshFile(const std::string &name);
    ~GmshFile();
    GmshFile(GmshFile &&) noexcept;

    /// The hexahedra (8, 20 or 27 nodes) whose physical volume is in @p volume_ids, or all if that is empty. The
    /// boundary id of a face is its physical surface.
    CoarseMesh body(const std::vector<unsigned int> &volume_ids) const;

  private:
    std::string                  name_;
    std::unique_ptr<GmshContent> content_;
    PhysicalNames                names_;
  };
} // namespace Nodus

#endif
