#include "mesh/curved_geometry.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/cell_id.h>

#include <algorithm>
#include <limits>

namespace Nodus
{
  namespace
  {
    /// Position of a node in the 3 x 3 x 3 lattice of a cell: 0, 1 or 2 per direction.
    using Lattice = std::array<unsigned int, dim>;

    unsigned int lexicographic(const Lattice &l)
    {
      return l[0] + 3 * l[1] + 9 * l[2];
    }

    /// The corners between which gmsh puts its nodes 8 to 26, from "Node ordering" in the gmsh reference manual: first
    /// twelve edges, then six faces. The centre comes last.
    constexpr unsigned int gmsh_edges[12][2] = {
        {0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
    constexpr unsigned int gmsh_faces[6][4] = {
        {0, 1, 2, 3}, {0, 1, 4, 5}, {0, 3, 4, 7}, {1, 2, 5, 6}, {2, 3, 6, 7}, {4, 5, 6, 7}};

    Lattice middle(const unsigned int *gmsh_corners, const unsigned int n)
    {
      Lattice sum{};
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          sum[d] += (dealii::GeometryInfo<dim>::ucd_to_deal[gmsh_corners[i]] >> d & 1u) * 2;
      for (unsigned int &l : sum)
        l /= n;
      return sum;
    }

    /// A serendipity cell at the middle of a face (two free directions) or of the cell (three), from the corners and
    /// edges around it.
    Point serendipity(const std::array<Point, 27> &nodes, const Lattice &at)
    {
      Point              corners, edges;
      const unsigned int n_free = std::count(at.begin(), at.end(), 1u);
      for (unsigned int n = 0; n < 27; ++n)
      {
        const Lattice l{{n % 3, n / 3 % 3, n / 9}};
        bool          around = true;
        for (unsigned int d = 0; d < dim; ++d)
          around &= at[d] == 1 || l[d] == at[d];
        const auto n_middle = std::count(l.begin(), l.end(), 1u);
        if (around && n_middle == 0)
          corners += nodes[n];
        else if (around && n_middle == 1)
          edges += nodes[n];
      }
      return Point((n_free == 2 ? 0.5 : 0.25) * edges - 0.25 * corners);
    }

    /// Values and derivatives of the quadratic Lagrange polynomials on [0, 1].
    void lagrange(const double s, double value[3], double derivative[3])
    {
      value[0]      = (2 * s - 1) * (s - 1);
      value[1]      = 4 * s * (1 - s);
      value[2]      = s * (2 * s - 1);
      derivative[0] = 4 * s - 3;
      derivative[1] = 4 - 8 * s;
      derivative[2] = 4 * s - 1;
    }

    double scaled_jacobian(const QuadraticCell &cell, const Point &unit)
    {
      double value[dim][3], derivative[dim][3];
      for (unsigned int d = 0; d < dim; ++d)
        lagrange(unit[d], value[d], derivative[d]);
      dealii::Tensor<2, dim> columns; // [direction][component]
      for (unsigned int n = 0; n < 27; ++n)
      {
        const unsigned int l[dim] = {n % 3, n / 3 % 3, n / 9};
        for (unsigned int d = 0; d < dim; ++d)
        {
          double weight = 1.;
          for (unsigned int e = 0; e < dim; ++e)
            weight *= (e == d ? derivative : value)[e][l[e]];
          columns[d] += weight * cell.nodes[n];
        }
      }
      double lengths = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        lengths *= columns[d].norm();
      return lengths > 0. ? dealii::determinant(columns) / lengths : 0.;
    }
  } // namespace

  QuadraticCell QuadraticCell::from_gmsh(const std::vector<Point> &nodes)
  {
    QuadraticCell cell;
    for (unsigned int v = 0; v < 8; ++v)
      cell.nodes[lexicographic(middle(&v, 1))] = nodes[v];
    for (unsigned int e = 0; e < 12; ++e)
      cell.nodes[lexicographic(middle(gmsh_edges[e], 2))] = nodes[8 + e];

    const bool complete = nodes.size() == 27;
    for (unsigned int f = 0; f < 6; ++f)
    {
      const Lattice at              = middle(gmsh_faces[f], 4);
      cell.nodes[lexicographic(at)] = complete ? nodes[20 + f] : serendipity(cell.nodes, at);
    }
    const Lattice centre{{1, 1, 1}};
    cell.nodes[lexicographic(centre)] = complete ? nodes[26] : serendipity(cell.nodes, centre);
    return cell;
  }

  QuadraticCell QuadraticCell::reoriented(const std::vector<unsigned int> &before,
                                          const std::vector<unsigned int> &after) const
  {
    const auto corner = [&](const unsigned int v)
    { return std::find(before.begin(), before.end(), after[v]) - before.begin(); };
    QuadraticCell result;
    for (unsigned int n = 0; n < 27; ++n)
    {
      const unsigned int l[dim] = {n % 3, n / 3 % 3, n / 9};
      Lattice            from;
      for (unsigned int e = 0; e < dim; ++e)
      {
        // old lattice = 2 old(corner 0) + sum_d l_d (old(corner 2^d) - old(corner 0)), bit by bit
        const int origin = corner(0) >> e & 1;
        int       sum    = 2 * origin;
        for (unsigned int d = 0; d < dim; ++d)
          sum += static_cast<int>(l[d]) * (static_cast<int>(corner(1u << d) >> e & 1) - origin);
        from[e] = sum;
      }
      result.nodes[n] = nodes[lexicographic(from)];
    }
    return result;
  }

  Point QuadraticCell::position(const Point &unit) const
  {
    double value[dim][3], derivative[3];
    for (unsigned int d = 0; d < dim; ++d)
      lagrange(unit[d], value[d], derivative);
    Point x;
    for (unsigned int n = 0; n < 27; ++n)
      x += value[0][n % 3] * value[1][n / 3 % 3] * value[2][n / 9] * nodes[n];
    return x;
  }

  double QuadraticCell::smallest_scaled_jacobian() const
  {
    static const dealii::QGauss<dim> gauss(3);
    double                           smallest = std::numeric_limits<double>::max();
    for (unsigned int n = 0; n < 27; ++n)
    {
      smallest = std::min(smallest, scaled_jacobian(*this, Point(n % 3 / 2., n / 3 % 3 / 2., n / 9 / 2.)));
      smallest = std::min(smallest, scaled_jacobian(*this, gauss.point(n)));
    }
    return smallest;
  }

  unsigned int CurvedGeometry::coarse_cell(Cell cell) const
  {
    if (ids_are_numbers_)
      return cell->id().get_coarse_cell_id();
    while (cell->level() > 0) // p4est has an order of its own for the ids
      cell = cell->parent();
    return cell->index();
  }

  bool CurvedGeometry::covers(const Cell &cell) const
  {
    return !empty() && cells_.count(coarse_cell(cell)) > 0;
  }

  std::vector<Point> CurvedGeometry::positions(const Cell &cell, const std::vector<Point> &unit) const
  {
    // the box of the cell in the unit coordinates of its coarse ancestor
    const dealii::CellId id = cell->id();
    Point                corner;
    double               size = 1.;
    for (const unsigned int child : id.get_child_indices())
    {
      size /= 2.;
      for (unsigned int d = 0; d < dim; ++d)
        corner[d] += (child >> d & 1) * size;
    }
    const QuadraticCell &ancestor = cells_.at(coarse_cell(cell));
    std::vector<Point>   result;
    result.reserve(unit.size());
    for (const Point &p : unit)
      result.push_back(ancestor.position(corner + size * p));
    return result;
  }

  CurvedMapping::CurvedMapping(const unsigned int degree, const std::shared_ptr<const CurvedGeometry> &geometry)
      : dealii::MappingQ<dim>(degree)
      , geometry_(geometry)
      , unit_points_(dealii::FE_Q<dim>(degree).get_unit_support_points())
  {
  }

  std::unique_ptr<dealii::Mapping<dim>> CurvedMapping::clone() const
  {
    return std::make_unique<CurvedMapping>(*this);
  }

  std::vector<Point> CurvedMapping::compute_mapping_support_points(const CurvedGeometry::Cell &cell) const
  {
    if (!geometry_->covers(cell))
      return dealii::MappingQ<dim>::compute_mapping_support_points(cell);
    std::vector<Point> points = geometry_->positions(cell, unit_points_);
    // Bodies has placed them, once for all cells that share them
    for (const unsigned int v : cell->vertex_indices())
      points[v] = cell->vertex(v);
    return points;
  }
} // namespace Nodus
