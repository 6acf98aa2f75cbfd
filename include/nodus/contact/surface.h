#ifndef nodus_contact_surface_h
#define nodus_contact_surface_h

#include <nodus/mesh/bodies.h>
#include <nodus/parameters.h>
#include <nodus/solve/linear_system.h>
#include <nodus/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <array>
#include <set>
#include <vector>

namespace Nodus
{
  /// A displacement node of a contact surface.
  struct SurfaceNode
  {
    std::array<DoFIndex, dim> dofs;
    Point                     X;     ///< reference position
    unsigned int              owner; ///< rank that owns its degrees of freedom
  };

  /// A face with (degree+1)^2 nodes, lexicographic in its local coordinates (xi, eta) in [0, 1]^2.
  struct SurfaceFace
  {
    std::vector<unsigned int> nodes;       ///< indices into ContactSurfaces::nodes()
    double                    orientation; ///< +1 when x_xi x x_eta points out of the body, -1 otherwise
    unsigned int              owner;       ///< rank of the cell
  };

  /// A node that carries multipliers.
  struct SlaveNode
  {
    unsigned int node; ///< index into ContactSurfaces::nodes()
    unsigned int pair;
  };

  /// An integration point of a slave face with statuses of its own (scheme `integration point`).
  struct SlavePoint
  {
    unsigned int pair, face;      ///< face: index into slave_faces(pair)
    double       xi, eta, weight; ///< of the rule on [0, 1]^2
  };

  /// Values and derivatives of the face shape functions at one point.
  struct FaceShape
  {
    unsigned int          n; ///< (degree+1)^2
    std::array<double, 9> value, d_xi, d_eta;
    FaceShape(unsigned int degree, double xi, double eta);
  };

  /// Slave and master surfaces of all pairs, and their current positions; the same on every rank.
  ///
  /// Only surfaces are gathered, never volumes; this class is the one place to change for a distributed search.
  class ContactSurfaces
  {
  public:
    /// @throws InputError: a side without faces, a node that is slave twice, a face on both sides of a pair.
    ContactSurfaces(const std::vector<ContactPairParameters> &pairs,
                    const Bodies                             &bodies,
                    const dealii::DoFHandler<dim>            &dof_handler,
                    const dealii::Mapping<dim>               &mapping);

    unsigned int degree() const
    {
      return degree_;
    }
    unsigned int n_pairs() const
    {
      return slave_faces_.size();
    }
    const std::vector<SurfaceNode> &nodes() const
    {
      return nodes_;
    }
    const std::vector<SlaveNode> &slave_nodes() const
    {
      return slave_nodes_;
    }
    /// Integration points of the pairs that have that scheme, face by face.
    const std::vector<SlavePoint> &slave_points() const
    {
      return slave_points_;
    }
    /// Contact sites are the places with a jump, a frame and statuses: first the slave nodes, then the integration
    /// points.
    unsigned int n_sites() const
    {
      return slave_nodes_.size() + slave_points_.size();
    }
    bool is_point(const unsigned int site) const
    {
      return site >= slave_nodes_.size();
    }
    const SlavePoint &point(const unsigned int site) const
    {
      return slave_points_[site - slave_nodes_.size()];
    }
    unsigned int pair(const unsigned int site) const
    {
      return is_point(site) ? point(site).pair : slave_nodes_[site].pair;
    }
    /// Slave nodes of a pair with integration points carry multipliers and frames, but no statuses.
    bool has_status(const unsigned int site) const
    {
      return is_point(site) || !has_points_[slave_nodes_[site].pair];
    }
    bool has_points(const unsigned int pair) const
    {
      return has_points_[pair];
    }
    /// Rank that projects and assembles a site.
    unsigned int site_owner(const unsigned int site) const
    {
      return is_point(site) ? slave_faces_[point(site).pair][point(site).face].owner
                            : nodes_[slave_nodes_[site].node].owner;
    }
    /// Reference position of a site.
    Point site_position(unsigned int site) const;

    /// Range [first, last) of slave nodes owned by this rank.
    std::pair<unsigned int, unsigned int> owned_slave_nodes() const
    {
      return owned_range_;
    }
    const std::vector<SurfaceFace> &slave_faces(const unsigned int pair) const
    {
      return slave_faces_[pair];
    }
    const std::vector<SurfaceFace> &master_faces(const unsigned int pair) const
    {
      return master_faces_[pair];
    }
    /// Slave number of a surface node (its multiplier index), or invalid_unsigned_int.
    unsigned int slave_number(const unsigned int node) const
    {
      return slave_number_[node];
    }
    /// Mean size (square root of the area) of the slave faces of a pair, reference configuration.
    double face_size(const unsigned int pair) const
    {
      return face_size_[pair];
    }
    /// Indices of the bodies of the pair's slave and master faces.
    const std::set<unsigned int> &bodies(const unsigned int pair) const
    {
      return bodies_[pair];
    }
    const BlockLayout &layout() const
    {
      return layout_;
    }

    /// Values of a displacement-like vector (fully distributed) at all surface nodes. Collective.
    void gather(const Vector &v, std::vector<Vector3> &nodal_values) const;

    /// Which components of which nodes are prescribed; once after the constraints are known. Collective.
    void set_fixed(const dealii::AffineConstraints<double> &constraints);
    bool fixed(const unsigned int node, const unsigned int component) const
    {
      return fixed_[node][component];
    }
    const std::vector<std::array<bool, dim>> &fixed() const
    {
      return fixed_;
    }

    /// x = X + u for all nodes.
    std::vector<Point> positions(const std::vector<Vector3> &u) const;

  private:
    unsigned int                          degree_;
    std::vector<SurfaceNode>              nodes_;
    std::vector<SlaveNode>                slave_nodes_;
    std::vector<SlavePoint>               slave_points_;
    std::vector<char>                     has_points_;
    std::vector<unsigned int>             slave_number_;
    std::pair<unsigned int, unsigned int> owned_range_;
    std::vector<std::vector<SurfaceFace>> slave_faces_, master_faces_;
    std::vector<double>                   face_size_;
    std::vector<std::set<unsigned int>>   bodies_;
    std::vector<std::array<bool, dim>>    fixed_;
    BlockLayout                           layout_;
    dealii::IndexSet                      surface_dofs_;
  };

  /// Position and tangents of a face at a shape point.
  struct FaceGeometry
  {
    Point   x;
    Vector3 d_xi, d_eta;
    FaceGeometry(const SurfaceFace &face, const FaceShape &shape, const std::vector<Point> &positions);
    /// @p points: as many positions as the shape has functions.
    FaceGeometry(const FaceShape &shape, const Point *points);
    /// x_xi x x_eta, length = surface element.
    Vector3 area_vector() const;
  };
} // namespace Nodus

#endif
