#ifndef nodus_contact_contact_geometry_h
#define nodus_contact_contact_geometry_h

#include "contact/surface_geometry.h"

#include <deal.II/base/bounding_box.h>

#include <memory>
#include <vector>

namespace Nodus
{
  /// A point of a surface by face and local coordinates.
  struct Projection
  {
    unsigned int face = dealii::numbers::invalid_unsigned_int;
    double       xi = 0., eta = 0.;
    bool         found() const
    {
      return face != dealii::numbers::invalid_unsigned_int;
    }
  };

  /// Finds master points: a tree of bounding volumes over the faces, then closest points with edges and vertices.
  class MasterSearch
  {
  public:
    explicit MasterSearch(const SurfaceGeometry &master);
    ~MasterSearch();
    MasterSearch(MasterSearch &&) noexcept;

    /// Closest master point of @p p within @p reach that does not look the way of @p slave_normal (the far side of a
    /// body). A point beyond the rim of the surface by more than @p tolerance face sizes has none.
    Projection closest(const Point &p, const Vector3 &slave_normal, double reach, double tolerance) const;

    /// Faces whose bounding boxes meet @p box, in ascending order.
    void candidates(const dealii::BoundingBox<dim> &box, std::vector<unsigned int> &faces) const;

  private:
    struct Tree;
    const SurfaceGeometry           &master_;
    std::unique_ptr<Tree>            tree_;
    std::vector<std::array<bool, 4>> on_rim_;        ///< edges xi = 0, 1, eta = 0, 1 that no other face shares
    std::vector<Vector3>             centre_normal_; ///< outward
    std::vector<double>              size_;
  };

  /// Both sides of every pair at the same positions, which must outlive it. Construction is collective.
  struct ContactGeometry
  {
    ContactGeometry(const std::vector<ContactPairParameters> &pairs,
                    const ContactSurfaces                    &surfaces,
                    const std::vector<Point>                 &positions);

    /// Point of a rigid master that is a partner of @p p, by the same rules as those of MasterSearch. @p tolerance:
    /// over that of the pair.
    RigidPoint
    closest_on_rigid(unsigned int pair, const Point &p, const Vector3 &slave_normal, double tolerance = 1.) const;
    /// Position of a site.
    Point position(const ContactSurfaces &surfaces, unsigned int site) const;

    std::vector<SurfaceGeometry>      slave, master;
    std::vector<MasterSearch>         search;
    std::vector<const RigidSurface *> rigid;    ///< masters without faces, or nullptr
    std::vector<double>               reach;    ///< farther master points are no partners [length]
    std::vector<double>               overhang; ///< of a projection over the rim of a rigid master, at most [length]
  };

  /// Closest point of face @p f to @p p: local coordinates in [0, 1]^2 (clamped at edges and vertices).
  /// Bounded projected Gauss-Newton; returns the squared distance.
  double closest_point(const SurfaceGeometry &surface, unsigned int f, const Point &p, double &xi, double &eta);
} // namespace Nodus

#endif
