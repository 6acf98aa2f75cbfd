#ifndef nodus_mesh_curved_geometry_h
#define nodus_mesh_curved_geometry_h

#include <nodus/base/types.h>

#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <iterator>
#include <map>
#include <memory>
#include <vector>

namespace Nodus
{
  /// A triquadratic hexahedron: its 27 nodes, x fastest, then y, in the orientation of the deal.II cell.
  struct QuadraticCell
  {
    /// From the 20 or 27 nodes of a gmsh element; the seven that 20 nodes lack follow from the serendipity functions.
    static QuadraticCell from_gmsh(const std::vector<Point> &nodes);

    /// The same cell when its vertices, numbered @p before, are listed in the order @p after.
    QuadraticCell reoriented(const std::vector<unsigned int> &before, const std::vector<unsigned int> &after) const;

    Point position(const Point &unit) const;

    /// Determinant of the map divided by the lengths of its columns, 1 for a cube: its smallest value over the nodes
    /// and the 27 Gauss points.
    double smallest_scaled_jacobian() const;

    std::array<Point, 27> nodes;
  };

  /// The coarse cells that come from second-order files. All their descendants lie on the triquadratic geometry of the
  /// coarse cell, whatever the refinement.
  class CurvedGeometry
  {
  public:
    using Cell = dealii::Triangulation<dim>::cell_iterator;

    /// Number of the coarse ancestor of @p cell, of any level, in the order in which all coarse cells came.
    unsigned int coarse_cell(Cell cell) const;
    /// From now on the cells are those of a mesh whose coarse cells kept their numbers as ids, some of which are not
    /// held here.
    void set_ids_are_numbers()
    {
      ids_are_numbers_ = true;
    }

    void add(const unsigned int coarse_cell, const QuadraticCell &cell)
    {
      cells_[coarse_cell] = cell;
    }
    /// Forgets the cells for which @p held does not hold.
    template <typename Predicate>
    void keep(const Predicate &held)
    {
      for (auto cell = cells_.begin(); cell != cells_.end();)
        cell = held(cell->first) ? std::next(cell) : cells_.erase(cell);
    }
    bool empty() const
    {
      return cells_.empty();
    }
    /// Whether @p cell, of any level, descends from a cell of a second-order file.
    bool covers(const Cell &cell) const;

    /// Where the points with unit coordinates @p unit in a covered cell lie.
    std::vector<Point> positions(const Cell &cell, const std::vector<Point> &unit) const;

  private:
    std::map<unsigned int, QuadraticCell> cells_;
    bool                                  ids_are_numbers_ = false;
  };

  /// MappingQ whose cells follow the CurvedGeometry where that covers them. Unlike MappingQCache it needs no
  /// initialisation after refinement.
  class CurvedMapping : public dealii::MappingQ<dim>
  {
  public:
    CurvedMapping(unsigned int degree, const std::shared_ptr<const CurvedGeometry> &geometry);

    std::unique_ptr<dealii::Mapping<dim>> clone() const override;

  protected:
    std::vector<Point> compute_mapping_support_points(const CurvedGeometry::Cell &cell) const override;

  private:
    std::shared_ptr<const CurvedGeometry> geometry_;
    std::vector<Point>                    unit_points_; ///< in the order of FE_Q
  };
} // namespace Nodus

#endif
