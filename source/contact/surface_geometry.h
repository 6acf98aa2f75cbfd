#ifndef nodus_contact_surface_geometry_h
#define nodus_contact_surface_geometry_h

#include "contact/face_powers.h"
#include "contact/surface.h"
#include <nodus/parameters/parameters.h>

#include <algorithm>
#include <array>
#include <vector>

namespace Nodus
{
  /// Derivative of a vector with respect to the position of a surface node.
  struct NodeDerivative
  {
    unsigned int           node; ///< index into ContactSurfaces::nodes()
    dealii::Tensor<2, dim> value;
  };
  /// Adds to the derivative with respect to @p node.
  void add(std::vector<NodeDerivative> &derivative, unsigned int node, const dealii::Tensor<2, dim> &value);
  /// [v] with [v] w = v x w.
  dealii::Tensor<2, dim> cross_matrix(const Vector3 &v);
  /// Derivative of v/|v|.
  dealii::Tensor<2, dim> unit_derivative(const Vector3 &v);

  /// How much something counts that has a measure, as a face that of the cosine between its normal and another one: in
  /// full from @p all on, not at all below @p none, with a smooth step between.
  struct Fading
  {
    Fading(const double measure, const double all, const double none)
    {
      const double t = std::clamp((measure - none) / (all - none), 0., 1.);
      part           = t * t * (3. - 2. * t);
      slope          = 6. * t * (1. - t) / (all - none);
    }
    double part, slope; ///< slope: by the measure
  };

  /// How much a face of the unit normal @p unit belongs to a smooth surface that looks along @p normal: 1 within 45
  /// degrees, 0 from 60 degrees on, where there is an edge between them (eq. P6).
  inline Fading belongs_to_surface(const Vector3 &unit, const Vector3 &normal)
  {
    return Fading(unit * normal, 0.70710678, 0.5);
  }

  /// Shape of the faces of one side at given positions, with normals averaged at the nodes.
  ///
  /// Faces of degree 1 may be smoothed: the middle of each edge moves onto the circular arc that meets the averaged
  /// normals of its ends, which makes the face an eight-node quadratic one (after Nagata 2005, whose patch is the same
  /// to fourth order in the angle). Faces of degree 2 are quadratic already and stay.
  class SurfaceGeometry
  {
  public:
    /// @p fixed: prescribed components of each node. A node that is held in some but not all directions lies on a plane
    /// of symmetry, and its averaged normal lies in that plane.
    SurfaceGeometry(const std::vector<SurfaceFace>           &faces,
                    unsigned int                              degree,
                    const std::vector<Point>                 &positions,
                    const std::vector<std::array<bool, dim>> &fixed,
                    ContactPairParameters::Surface            surface);

    unsigned int n_faces() const
    {
      return faces_.size();
    }
    const SurfaceFace &face(const unsigned int f) const
    {
      return faces_[f];
    }
    /// Degree of the displacement.
    unsigned int degree() const
    {
      return degree_;
    }
    const std::vector<Point> &positions() const
    {
      return positions_;
    }

    FaceGeometry at(const unsigned int f, const double xi, const double eta) const
    {
      const FacePowers::Tangents t = powers_[f].tangents(xi, eta);
      return FaceGeometry(Point(t.x[0], t.x[1], t.x[2]), FacePowers::vector(t.d_xi), FacePowers::vector(t.d_eta));
    }
    Point position(const unsigned int f, const double xi, const double eta) const
    {
      return Point(FacePowers::vector(powers_[f].tangents(xi, eta).x));
    }
    /// The face is the Lagrange interpolation of these (shape_degree + 1)^2 points.
    unsigned int shape_degree() const
    {
      return shape_degree_;
    }
    const Point *shape_points(const unsigned int f) const
    {
      return points_.data() + f * (shape_degree_ + 1) * (shape_degree_ + 1);
    }
    /// Outward unit normal of the face.
    Vector3 normal(unsigned int f, double xi, double eta) const;
    /// Outward unit normal interpolated from the averaged ones of the nodes.
    Vector3 averaged_normal(unsigned int f, double xi, double eta) const;
    Vector3 averaged_normal(unsigned int f, const FaceShape &shape) const;
    /// Edges xi = 0, 1, eta = 0, 1 of a face that no other face shares.
    using Rim = std::array<bool, 4>;
    /// Outward unit normal of the face, which turns into the averaged one in a strip along its edges but those on the
    /// rim, so that it does not jump from face to face (eq. P5).
    Vector3 facet_normal(unsigned int f, double xi, double eta, const Rim &rim) const;
    /// Part of the averaged normal in it: 1 on the edges, 0 beyond the strip.
    static double edge_part(double xi, double eta, const Rim &rim);
    /// Smoothed position minus the one that the displacement shape functions give; zero when faceted.
    Vector3 offset(unsigned int f, double xi, double eta) const;

    /// Averaged outward unit normal of node @p n of face @p f: of the faces at the node within 45 degrees of this one,
    /// and less and less of those within 60, with weights that make it exact on spheres and cylinders (Max 1999). At a
    /// hanging node it is interpolated, as on the larger face beside it.
    const Vector3 &nodal_normal(const unsigned int f, const unsigned int n) const
    {
      return nodal_normals_[f * faces_[f].nodes.size() + n];
    }

    /// How far an arc that meets the normals at the ends of an edge of a face rises above the lines between its nodes,
    /// at most: what facets cut off from a curved surface [length]. Of the faces of this rank.
    double bulge() const;

    /// Whether this is a copy of another one, or the other way round.
    bool has_faces_of(const SurfaceGeometry &other) const
    {
      return &faces_ == &other.faces_;
    }
    /// Whether @p condition(face) is true for any of the faces at a node.
    template <typename Condition>
    bool any_at(const unsigned int node, const Condition &condition) const
    {
      return std::any_of(occurrence_.begin() + start_[node],
                         occurrence_.begin() + start_[node + 1],
                         [&](const unsigned int at) { return condition(at / node_shapes_.size()); });
    }
    /// Calls f(node, part) for the nodes around a node of the surface, itself among them; the parts add up to 1. They
    /// are those beside it on the faces that meet there and look along @p normal: those beyond an edge count less and
    /// less and not at all from 60 degrees on.
    template <typename Function>
    void for_nodes_around(unsigned int node, const Vector3 &normal, const Function &f) const;

    bool smoothed() const
    {
      return shape_degree_ != degree_;
    }
    /// The offset is the sum over the middles of the four edges and the four corners, which move only where they hang,
    /// of a function of (xi, eta) times the offset there, and its derivative with respect to the nodes likewise.
    static std::array<double, 8> offset_functions(double xi, double eta)
    {
      return offset_functions(FaceShape(2, xi, eta).value);
    }
    /// The same from values, or derivatives, of the nine shape functions of degree 2.
    static std::array<double, 8> offset_functions(const std::array<double, 9> &shape);
    std::vector<NodeDerivative>  offset_derivative(unsigned int f, unsigned int part) const;

    /// Add to @p derivative that of the normals with respect to the nodes, at fixed local coordinates. That of the face
    /// normal leaves the smoothing out.
    void normal_derivative(unsigned int f, double xi, double eta, std::vector<NodeDerivative> &derivative) const;
    void
    averaged_normal_derivative(unsigned int f, double xi, double eta, std::vector<NodeDerivative> &derivative) const;
    void nodal_normal_derivative(unsigned int f, unsigned int n, std::vector<NodeDerivative> &derivative) const;

  private:
    const std::vector<SurfaceFace>           &faces_;
    const std::vector<Point>                 &positions_;
    const std::vector<std::array<bool, dim>> &fixed_; ///< components of each node
    unsigned int                              degree_, shape_degree_;
    /// Per face and node: of the face, the same with its weight in the average, averaged.
    std::vector<Vector3> unit_, weighted_, nodal_normals_;
    /// Where each surface node occurs: face * nodes per face + n, from start_[node] on.
    std::vector<unsigned int> start_, occurrence_;
    std::vector<FaceShape>    node_shapes_; ///< of the displacement at the nodes of a face
    std::vector<Point>        points_;      ///< per face, (shape_degree + 1)^2
    std::vector<FacePowers>   powers_;      ///< per face, of these
    std::vector<FacePowers>   offsets_;     ///< per face, of these, where the surface is smoothed

    void average_normals();
    void find_powers();
    /// Calls g(other, how much it belongs) for the faces around a surface node that belong to one smooth surface with
    /// that of @p own. Both are faces at a node of theirs: indices into unit_.
    template <typename Function>
    void for_faces(unsigned int node, unsigned int own, const Function &g) const;
    /// Sum of those around a node.
    Vector3 sum_of_normals(unsigned int node, unsigned int own) const;
    /// The unit vector of that, in the plane of symmetry where the node lies on one; zero when there are no such faces.
    Vector3 averaged_unit(unsigned int node, unsigned int own) const;
    /// Of node n of face f where it hangs: interpolated from those of the nodes that it follows; zero for others, and
    /// beyond sharp edges.
    Vector3 interpolated_direction(unsigned int f, unsigned int n) const;
    /// Adds @p direction times the derivative of the component of unit_[at] along @p along.
    void add_component_derivative(unsigned int                 at,
                                  const Vector3               &along,
                                  const Vector3               &direction,
                                  std::vector<NodeDerivative> &derivative) const;
    void add_sum_derivative(unsigned int                  node,
                            unsigned int                  own,
                            const dealii::Tensor<2, dim> &factor,
                            std::vector<NodeDerivative>  &derivative) const;
    void add_unit_derivative(unsigned int                  node,
                             unsigned int                  own,
                             const dealii::Tensor<2, dim> &factor,
                             std::vector<NodeDerivative>  &derivative) const;
    bool on_symmetry_plane(unsigned int node, const Vector3 &normal) const;

    void smooth();
    /// Of node n of face f where it hangs in the middle of an edge of a larger face, or nullptr.
    const SurfaceFace::Follower *on_larger_edge(unsigned int f, unsigned int n) const;
    /// Normal at an end of that edge.
    Vector3 end_normal(unsigned int f, unsigned int n, unsigned int master) const;
    /// Whether the edge to another corner is half of that edge.
    bool is_half(unsigned int f, unsigned int end, unsigned int other) const;
    /// Smoothed position minus position of a corner: one that hangs is in the middle of the larger face's smoothed
    /// edge.
    Vector3 corner_offset(unsigned int f, unsigned int n) const;
    /// The same of the middle of the edge from corner a to corner b.
    Vector3 middle_offset(unsigned int f, unsigned int a, unsigned int b) const;
    void    corner_offset_derivative(unsigned int                  f,
                                     unsigned int                  n,
                                     const dealii::Tensor<2, dim> &factor,
                                     std::vector<NodeDerivative>  &derivative) const;
  };

  template <typename Function>
  void SurfaceGeometry::for_nodes_around(const unsigned int node, const Vector3 &normal, const Function &f) const
  {
    const unsigned int n_line = degree_ + 1, n_face = n_line * n_line;
    double             sum = 0.;
    for (unsigned int o = start_[node]; o < start_[node + 1]; ++o)
      sum += belongs_to_surface(unit_[occurrence_[o]], normal).part;
    if (sum < 0.1) // nothing looks that way
    {
      f(node, 1.);
      return;
    }
    for (unsigned int o = start_[node]; o < start_[node + 1]; ++o)
    {
      const unsigned int face = occurrence_[o] / n_face, n = occurrence_[o] % n_face;
      const unsigned int i = n % n_line, j = n / n_line;
      const unsigned int i_begin = i > 0 ? i - 1 : 0, i_end = std::min(i + 2, n_line);
      const unsigned int j_begin = j > 0 ? j - 1 : 0, j_end = std::min(j + 2, n_line);
      const double       part =
          belongs_to_surface(unit_[occurrence_[o]], normal).part / (sum * (i_end - i_begin) * (j_end - j_begin));
      for (unsigned int l = j_begin; l < j_end; ++l)
        for (unsigned int k = i_begin; k < i_end; ++k)
          f(faces_[face].nodes[l * n_line + k], part);
    }
  }
} // namespace Nodus

#endif
