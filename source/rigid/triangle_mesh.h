#ifndef nodus_rigid_triangle_mesh_h
#define nodus_rigid_triangle_mesh_h

#include <nodus/base/types.h>

#include <array>
#include <string>
#include <vector>

namespace Nodus
{
  /// Triangles that know their neighbours, with a normal at each of their corners.
  ///
  /// Corners nearer to each other than a millionth of the diagonal of the box around all of them are one. Where
  /// neighbours meet at more than 45 degrees there is an edge: the normal at a corner is averaged over the triangles
  /// around it that one reaches without going over such an edge, with the weights of eq. P1.
  class TriangleMesh
  {
  public:
    static constexpr unsigned int none = static_cast<unsigned int>(-1);

    struct Triangle
    {
      std::array<unsigned int, 3> vertex;    ///< counter-clockwise from outside
      std::array<unsigned int, 3> neighbour; ///< beyond the edge from corner i to the next one, or none
      std::array<unsigned int, 3> edge;      ///< which is that edge of the neighbour
      std::array<Vector3, 3>      normal;    ///< outward unit, at the corners
      Vector3                     facet;     ///< outward unit normal of the triangle itself
    };

    /// @p corners: as read; @p smoothed: otherwise the normals are those of the triangles. @p name: for messages.
    /// @throws InputError for triangles without area, edges of three and more triangles, neighbours that are turned
    /// over
    TriangleMesh(const std::vector<std::array<Point, 3>> &corners, bool smoothed, const std::string &name);

    const std::vector<Triangle> &triangles() const
    {
      return triangles_;
    }
    Point corner(const unsigned int triangle, const unsigned int i) const
    {
      return vertices_[triangles_[triangle].vertex[i]];
    }
    const std::vector<Point> &vertices() const
    {
      return vertices_;
    }
    /// Whether a vertex is on the rim of an open surface.
    bool on_rim(const unsigned int vertex) const
    {
      return on_rim_[vertex];
    }
    /// Whether the normals at all corners there are the same.
    bool is_smooth(const unsigned int vertex) const
    {
      return is_smooth_[vertex];
    }
    /// Outward, mean of the triangles around a vertex weighted with their angles: whose side a point nearest to the
    /// vertex is on (Baerentzen & Aanaes 2005). Unit; that of an edge is the mean of its triangles.
    const Vector3 &mean_normal(const unsigned int vertex) const
    {
      return mean_normal_[vertex];
    }
    /// Of those that end at a vertex [length].
    double shortest_edge(const unsigned int vertex) const
    {
      return shortest_edge_[vertex];
    }
    /// Edges of one triangle alone.
    unsigned int n_rim_edges() const
    {
      return n_rim_edges_;
    }

  private:
    void merge(const std::vector<std::array<Point, 3>> &corners, const std::string &name);
    void connect(const std::string &name);
    void average_normals();

    std::vector<Point>    vertices_;
    std::vector<Triangle> triangles_;
    std::vector<char>     on_rim_, is_smooth_;
    std::vector<Vector3>  mean_normal_;
    std::vector<double>   shortest_edge_;
    unsigned int          n_rim_edges_ = 0;
  };
} // namespace Nodus

#endif
