#ifndef nodus_contact_contact_geometry_h
#define nodus_contact_contact_geometry_h

#include "base/box_tree.h"
#include "contact/self_contact.h"

#include <deal.II/base/bounding_box.h>

#include <algorithm>
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
    /// @p tolerance: how far points with a partner may be beyond the rim [faces]. Where jumps are averaged over
    /// @p segments, which do not see faces that look past them (facing()), these are no partners, and edges between
    /// such faces are rims.
    MasterSearch(const SurfaceGeometry &master, double tolerance, bool segments);

    /// Closest master point of @p p within @p reach that does not look the way of @p slave_normal (the far side of a
    /// body). A point beyond the rim of the surface by more than @p part of what is tolerated has none.
    Projection closest(const Point &p, const Vector3 &slave_normal, double reach, double part = 1.) const;
    /// The same where the surface touches itself, for @p seeker, which is at @p p; none where the closest point is its
    /// slave (theory section 35).
    Projection closest_of_own(
        const Point &p, const Vector3 &normal, double reach, double part, const SelfContact::Seeker &seeker) const;

    /// How far @p p is beyond the rim of the surface, of which @p closest is the nearest point: along the surface, over
    /// what is tolerated. Zero elsewhere.
    Vector3                     overhang(const Projection &closest, const Point &p) const;
    const SurfaceGeometry::Rim &rim(const unsigned int face) const
    {
      return on_rim_[face];
    }
    /// What is tolerated at a master face [length].
    double tolerated_overhang(const unsigned int face) const
    {
      return tolerance_ * size_[face];
    }

    /// Faces whose bounding boxes meet @p box, in ascending order.
    void candidates(const dealii::BoundingBox<dim> &box, std::vector<unsigned int> &faces) const;

  private:
    void find_rims();
    /// Whether there is an edge between two faces, beyond which the neighbour leads down: what slides over it leaves
    /// the face as at a rim.
    bool       falls_off(unsigned int f, unsigned int neighbour) const;
    Projection within_rim(const Projection &closest, const Point &p, double part) const;

    const SurfaceGeometry            &master_;
    const bool                        segments_;
    const double                      tolerance_; ///< of the overhang [faces]
    BoxTree                           tree_;      ///< of the faces
    std::vector<SurfaceGeometry::Rim> on_rim_;
    std::vector<Point>                centre_;
    std::vector<Vector3>              centre_normal_; ///< outward
    std::vector<double>               size_;
  };

  /// Both sides of every pair at the same positions, which must outlive it. Construction is collective.
  struct ContactGeometry
  {
    ContactGeometry(const std::vector<ContactPairParameters> &pairs,
                    const ContactSurfaces                    &surfaces,
                    const std::vector<Point>                 &positions);

    /// Part of a point of a fixed rule that counts where it is beyond the rim by @p overhang, over what is tolerated:
    /// it fades out, so that nothing jumps where it goes (eq. J7).
    static double counted_part(const double overhang)
    {
      return std::max(0., 1. - overhang * fading);
    }
    static constexpr double fading = 2.;
    /// Partner of the point (xi, eta) of slave face @p f, which is at @p p and looks along @p normal; of a pair with
    /// master faces.
    Projection closest_to_face(unsigned int   pair,
                               unsigned int   f,
                               double         xi,
                               double         eta,
                               const Point   &p,
                               const Vector3 &normal,
                               double         part = 1.) const;
    /// The same of a slave node, given as index into ContactSurfaces::nodes().
    Projection closest_to_node(
        unsigned int pair, unsigned int node, const Point &p, const Vector3 &normal, double part = 1.) const;
    /// Point of a rigid master that is a partner of @p p, by the same rules as those of MasterSearch.
    RigidPoint closest_on_rigid(unsigned int pair, const Point &p, const Vector3 &slave_normal, double part = 1.) const;
    /// Position of a site.
    Point position(const ContactSurfaces &surfaces, unsigned int site) const;

    std::vector<SurfaceGeometry>              slave, master;
    std::vector<MasterSearch>                 search;
    std::vector<std::unique_ptr<SelfContact>> self;  ///< of pairs whose surface touches itself, or nullptr
    std::vector<const RigidSurface *>         rigid; ///< masters without faces, or nullptr
    std::vector<double>                       reach; ///< farther master points are no partners [length]
    std::vector<double> overhang; ///< of a projection over the rim of a rigid master, at most [length]
  };

  /// Closest point of face @p f to @p p: local coordinates in [0, 1]^2 (clamped at edges and vertices).
  /// Bounded projected Gauss-Newton; returns the squared distance.
  double closest_point(const SurfaceGeometry &surface, unsigned int f, const Point &p, double &xi, double &eta);
} // namespace Nodus

#endif
