#ifndef nodus_mesh_gmsh_content_h
#define nodus_mesh_gmsh_content_h

#include <nodus/base/types.h>

#include <array>
#include <string>
#include <vector>

namespace Nodus
{
  /// The file as it is, before any selection.
  struct GmshContent
  {
    using PhysicalIds = std::vector<int>;
    using Face        = std::array<unsigned int, 4>;
    /// Groups index into physical, nodes into vertices, the corners first.
    struct Hexahedron
    {
      unsigned int group, first_node;
    };
    struct Quadrilateral
    {
      unsigned int group;
      Face         corners;
    };
    struct Other
    {
      unsigned int group;
      const char  *type;
    };
    std::vector<Point>         vertices;
    std::vector<PhysicalIds>   physical; ///< combinations of ids that elements have
    std::vector<Hexahedron>    hexahedra;
    std::vector<unsigned int>  nodes; ///< of the hexahedra
    unsigned int               n_nodes_per_hexahedron = 8;
    std::vector<Quadrilateral> quadrilaterals;
    std::vector<Other>         others; ///< volume elements that are no hexahedra
  };

  /// @throws InputError: the message starts with the file name and ends with the fix.
  GmshContent       read_gmsh(const std::string &file);
  [[noreturn]] void refuse_gmsh(const std::string &file, const std::string &reason);
} // namespace Nodus

#endif
