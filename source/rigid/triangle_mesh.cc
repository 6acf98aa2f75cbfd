#include "rigid/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <sstream>
#include <tuple>
#include <unordered_map>

namespace Nodus
{
  namespace
  {
    /// Corners this near, in diagonals of the box around the surface, are one. Single precision has 6e-8.
    constexpr double merging = 1e-6;
    /// Triangles that meet at a larger angle (cosine below this) have an edge between them, as faces of meshes have.
    constexpr double smooth_cosine = 0.70710678;
    /// Unit normals that differ less are the same.
    constexpr double same_normal = 1e-6;

    std::string with_corner(const std::string &text, const Point &p)
    {
      std::ostringstream stream;
      stream << text << " (" << p << ")";
      return stream.str();
    }

    /// Points by the cells of a grid as wide as they may be apart.
    class Grid
    {
    public:
      Grid(const Point &origin, const double width)
          : origin_(origin)
          , width_(width)
      {
      }
      /// The first vertex within the width of @p p, or a new one.
      unsigned int number(const Point &p, std::vector<Point> &vertices)
      {
        std::array<std::int64_t, dim> at;
        for (unsigned int c = 0; c < dim; ++c)
          at[c] = static_cast<std::int64_t>(std::floor((p[c] - origin_[c]) / width_));
        unsigned int found = TriangleMesh::none;
        for (int n = 0; n < 27; ++n)
        {
          const auto [begin, end] =
              cells_.equal_range(key(at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1));
          for (auto cell = begin; cell != end; ++cell)
            if (vertices[cell->second].distance(p) <= width_)
              found = std::min(found, cell->second);
        }
        if (found == TriangleMesh::none)
        {
          found = vertices.size();
          vertices.push_back(p);
          cells_.emplace(key(at[0], at[1], at[2]), found);
        }
        return found;
      }

    private:
      /// Cells that share a key cost time alone.
      static std::uint64_t key(const std::int64_t i, const std::int64_t j, const std::int64_t k)
      {
        return std::uint64_t(i) * 73856093u ^ std::uint64_t(j) * 19349663u ^ std::uint64_t(k) * 83492791u;
      }

      const Point                                          origin_;
      const double                                         width_;
      std::unordered_multimap<std::uint64_t, unsigned int> cells_;
    };

    /// Corners of triangles, numbered 3 t + i, in classes.
    class Classes
    {
    public:
      explicit Classes(const unsigned int n)
          : parent_(n)
      {
        std::iota(parent_.begin(), parent_.end(), 0);
      }
      unsigned int root(unsigned int i)
      {
        while (parent_[i] != i)
          i = parent_[i] = parent_[parent_[i]];
        return i;
      }
      void join(const unsigned int i, const unsigned int j)
      {
        const unsigned int a = root(i), b = root(j);
        parent_[std::max(a, b)] = std::min(a, b);
      }

    private:
      std::vector<unsigned int> parent_;
    };
  } // namespace

  TriangleMesh::TriangleMesh(const std::vector<std::array<Point, 3>> &corners,
                             const bool                               smoothed,
                             const std::string                       &name)
  {
    merge(corners, name);
    connect(name);
    mean_normal_.resize(vertices_.size());
    shortest_edge_.assign(vertices_.size(), std::numeric_limits<double>::max());
    for (unsigned int t = 0; t < triangles_.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const Vector3 a = corner(t, (i + 1) % 3) - corner(t, i), b = corner(t, (i + 2) % 3) - corner(t, i);
        const double  angle    = std::atan2(dealii::cross_product_3d(a, b).norm(), a * b);
        double       &shortest = shortest_edge_[triangles_[t].vertex[i]];
        shortest               = std::min({shortest, a.norm(), b.norm()});
        mean_normal_[triangles_[t].vertex[i]] += angle * triangles_[t].facet;
      }
    for (Vector3 &normal : mean_normal_)
      normal /= std::max(normal.norm(), std::numeric_limits<double>::min());
    if (smoothed)
      average_normals();
    std::vector<Vector3> first(vertices_.size());
    is_smooth_.assign(vertices_.size(), true);
    for (const Triangle &triangle : triangles_)
      for (unsigned int i = 0; i < 3; ++i)
      {
        Vector3 &normal = first[triangle.vertex[i]];
        if (normal == Vector3())
          normal = triangle.normal[i];
        else if ((normal - triangle.normal[i]).norm() > same_normal)
          is_smooth_[triangle.vertex[i]] = false;
      }
  }

  void TriangleMesh::merge(const std::vector<std::array<Point, 3>> &corners, const std::string &name)
  {
    Point lower = corners[0][0], upper = lower;
    for (const auto &triangle : corners)
      for (const Point &p : triangle)
        for (unsigned int c = 0; c < dim; ++c)
        {
          lower[c] = std::min(lower[c], p[c]);
          upper[c] = std::max(upper[c], p[c]);
        }
    const double tolerance = std::max(merging * lower.distance(upper), std::numeric_limits<double>::min());
    Grid         grid(lower, tolerance);
    triangles_.resize(corners.size());
    for (unsigned int t = 0; t < corners.size(); ++t)
    {
      Triangle &triangle = triangles_[t];
      for (unsigned int i = 0; i < 3; ++i)
        triangle.vertex[i] = grid.number(corners[t][i], vertices_);
      triangle.neighbour.fill(none);
      triangle.edge.fill(none);
      const Vector3 a = corner(t, 1) - corner(t, 0), b = corner(t, 2) - corner(t, 0);
      const Vector3 area    = dealii::cross_product_3d(a, b);
      const double  longest = std::max({a.norm(), b.norm(), (b - a).norm()});
      if (!(area.norm() > tolerance * longest))
        throw InputError(
            with_corner(name + ": triangle " + std::to_string(t + 1), corners[t][0]) +
            " has no area: its height is less than a millionth of the diagonal of the surface; remove such "
            "triangles and join what is beside them");
      triangle.facet = area / area.norm();
      triangle.normal.fill(triangle.facet);
    }
  }

  void TriangleMesh::connect(const std::string &name)
  {
    struct Side
    {
      unsigned int lower, upper; ///< vertices
      unsigned int triangle, edge;
    };
    std::vector<Side> sides;
    for (unsigned int t = 0; t < triangles_.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const auto [lower, upper] = std::minmax(triangles_[t].vertex[i], triangles_[t].vertex[(i + 1) % 3]);
        sides.push_back({lower, upper, t, i});
      }
    std::sort(sides.begin(),
              sides.end(),
              [](const Side &a, const Side &b)
              { return std::tie(a.lower, a.upper, a.triangle) < std::tie(b.lower, b.upper, b.triangle); });
    const auto refuse = [&](const std::string &what, const Side *first, const unsigned int n, const std::string &fix)
    {
      std::string text = name + ": triangles ";
      for (unsigned int i = 0; i < std::min(n, 4u); ++i)
        text += (i == 0 ? "" : i + 1 == n ? " and " : ", ") + std::to_string(first[i].triangle + 1);
      throw InputError(with_corner(text + (n > 4 ? ", ..." : "") + what + " at", vertices_[first->lower]) + "; " + fix);
    };
    on_rim_.assign(vertices_.size(), false);
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last)
    {
      while (last < sides.size() && sides[last].lower == sides[first].lower && sides[last].upper == sides[first].upper)
        ++last;
      const Side &a = sides[first];
      if (last - first > 2)
        refuse(" share one edge",
               &a,
               last - first,
               "a surface has one triangle on each side of an edge: split the bodies that touch there, or remove "
               "triangles inside");
      if (last - first == 1)
      {
        on_rim_[a.lower] = on_rim_[a.upper] = true;
        ++n_rim_edges_;
        continue;
      }
      const Side &b = sides[first + 1];
      if (triangles_[a.triangle].vertex[a.edge] == triangles_[b.triangle].vertex[b.edge])
        refuse(" look to different sides",
               &a,
               2,
               "one of them is turned over: orient all triangles counter-clockwise seen from outside");
      triangles_[a.triangle].neighbour[a.edge] = b.triangle;
      triangles_[a.triangle].edge[a.edge]      = b.edge;
      triangles_[b.triangle].neighbour[b.edge] = a.triangle;
      triangles_[b.triangle].edge[b.edge]      = a.edge;
    }
  }

  void TriangleMesh::average_normals()
  {
    Classes classes(3 * triangles_.size());
    for (unsigned int t = 0; t < triangles_.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const Triangle &triangle = triangles_[t];
        if (triangle.neighbour[i] == none)
          continue;
        const unsigned int other = triangle.neighbour[i], j = triangle.edge[i];
        if (triangle.facet * triangles_[other].facet <= smooth_cosine)
          continue;
        classes.join(3 * t + i, 3 * other + (j + 1) % 3);
        classes.join(3 * t + (i + 1) % 3, 3 * other + j);
      }
    std::vector<Vector3> sum(3 * triangles_.size());
    for (unsigned int t = 0; t < triangles_.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const Vector3 a = corner(t, (i + 1) % 3) - corner(t, i), b = corner(t, (i + 2) % 3) - corner(t, i);
        sum[classes.root(3 * t + i)] += dealii::cross_product_3d(a, b) / (a.norm_square() * b.norm_square());
      }
    for (unsigned int t = 0; t < triangles_.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
      {
        // at the apex of a cone the average is the normal of none
        const Vector3 &normal = sum[classes.root(3 * t + i)];
        if (normal * triangles_[t].facet > smooth_cosine * normal.norm())
          triangles_[t].normal[i] = normal / normal.norm();
      }
  }
} // namespace Nodus
