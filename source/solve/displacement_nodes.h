#ifndef nodus_solve_displacement_nodes_h
#define nodus_solve_displacement_nodes_h

#include <nodus/base/types.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace Nodus
{
  /// The corners of cells that displacements of degree 2 lie between: those of degree 1 on the same cells. Corners of
  /// all ranks are numbered in pairs, those of rank r from 2 pairs[r] on; the last pair of a rank may lack its second.
  struct CellCorners
  {
    std::vector<DoFIndex>      pairs; ///< of the ranks before each one, and of all
    std::vector<unsigned int>  nodes; ///< owned node of each owned corner
    std::vector<std::uint32_t> start; ///< by owned node: of its corners in the next, and their number
    std::vector<DoFIndex>
        corners; ///< that it has equal parts of: itself, or the 2, 4, 8 around an edge, a face, a cell
  };

  /// What multigrid knows of the owned displacement nodes besides the matrix.
  struct DisplacementNodes
  {
    DisplacementNodes(std::vector<Point> positions = {}, CellCorners corners = {})
        : positions(std::move(positions))
        , corners(std::move(corners))
    {
    }

    std::vector<Point> positions;
    CellCorners        corners; ///< of degree 2; otherwise empty
  };
} // namespace Nodus

#endif
