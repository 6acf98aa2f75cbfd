#ifndef nodus_contact_pairing_h
#define nodus_contact_pairing_h

#include <nodus/contact/surface.h>
#include <nodus/parameters.h>

#include <array>
#include <vector>

namespace Nodus
{
  /// Where a slave node meets the master surface, frozen within a geometry pass.
  struct NodePairing
  {
    bool         found = false; ///< a master point within reach, and a normal motion that the constraints leave free
    unsigned int face  = dealii::numbers::invalid_unsigned_int; ///< master face of the node's pair
    double       xi = 0., eta = 0.;                             ///< local coordinates of the projection
    Vector3      normal;                                        ///< unit, from slave to master
    std::array<Vector3, 2> tangent;                             ///< unit, with the normal a right-handed frame
    std::array<bool, 2>    tangent_free{{false, false}};        ///< void directions carry no friction multiplier
  };

  /// Projection of all slave nodes on their master surfaces; the same on every rank.
  class Pairing
  {
  public:
    /// Projects at the given positions: bounding-volume tree, closest point with edge and vertex fallbacks, frames
    /// restricted to the relative motion that the constraints leave free. Each rank projects the nodes it owns.
    /// Collective.
    void project(const std::vector<ContactPairParameters> &pairs,
                 const ContactSurfaces                    &surfaces,
                 const std::vector<Point>                 &positions);

    const NodePairing &operator[](const unsigned int slave) const
    {
      return nodes_[slave];
    }
    unsigned int size() const
    {
      return nodes_.size();
    }

  private:
    std::vector<NodePairing> nodes_;
  };

  /// Closest point of one face to @p p: local coordinates in [0, 1]^2 (clamped at edges and vertices).
  /// Bounded projected Newton; returns the squared distance.
  double closest_point(const SurfaceFace        &face,
                       unsigned int              degree,
                       const std::vector<Point> &positions,
                       const Point              &p,
                       double                   &xi,
                       double                   &eta);
} // namespace Nodus

#endif
