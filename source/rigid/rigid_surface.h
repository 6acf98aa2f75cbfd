#ifndef nodus_rigid_rigid_surface_h
#define nodus_rigid_rigid_surface_h

#include "rigid/prescribed_motion.h"
#include "rigid/rigid_carrier.h"
#include <nodus/parameters/parameters.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace Nodus
{
  class TriangleSurface;

  /// The point of a rigid surface closest to another point.
  struct RigidPoint
  {
    bool                   found = false; ///< false where the closest point is not unique, or far beyond a rim
    Point                  x;
    Vector3                normal;                       ///< unit, out of the rigid body
    double                 height = 0.;                  ///< of the other point along the normal [length]
    std::array<Vector3, 2> direction;                    ///< unit, of the principal curvatures
    std::array<double, 2>  curvature = {{0., 0.}};       ///< > 0 where the rigid body is convex [1/length]
    std::array<bool, 2>    stays     = {{false, false}}; ///< x does, across a sharp edge and at a corner
    double overhang = 0.; ///< how far x is beyond the rim of an open surface, which goes on there [length]

    /// Derivatives of the normal and of x with respect to the other point (eq. R1).
    dealii::Tensor<2, dim> normal_derivative() const;
    dealii::Tensor<2, dim> slide() const;
  };

  /// The part of a rigid master that moves as prescribed in a jump: where it is, and how far its material has come in
  /// the increment [length].
  struct RigidPart
  {
    Vector3 x, moved;
  };

  /// The surface of a rigid body in closed form, or of triangles. It moves as prescribed, or a body of the model
  /// carries it.
  class RigidSurface
  {
  public:
    /// @p label: for messages; @p smoothed: whether triangles are rounded. @throws InputError, the same on every rank
    RigidSurface(const MasterSurfaceParameters &parameters, const std::string &label, bool smoothed = true);

    /// The increment at hand; the surface is where it is at its end, unless it is carried. @throws InputError on every
    /// rank
    void set_increment(double begin, double end);

    /// Lets a body carry it.
    void set_carrier(const RigidCarrier &carrier)
    {
      carrier_ = carrier;
    }
    const RigidCarrier *carrier() const
    {
      return carrier_ ? &*carrier_ : nullptr;
    }
    /// @throws InputError where its motion at time @p t is not a number; a carried surface has none of its own.
    void check_motion(double t) const;
    /// Moves it with the nodes of what carries it, which are in the array @p x; nothing without that.
    void follow_carrier(const std::vector<Point> &x);

    RigidPoint closest(const Point &p) const;
    /// Of a point above the surface, < 0 inside the rigid body; also where the closest point is not unique [length].
    /// Nothing is inside beyond the rim of an open surface.
    double height(const Point &p) const;

    /// "sphere", or what surface of which file.
    std::string describe() const;

    /// Where it is, and where its point is (of a sphere the centre).
    const Placement &placement() const
    {
      return now_;
    }
    const Point &point() const
    {
      return point_;
    }

    /// Part in a jump of its point @p x; zero of a carried surface, whose nodes have it.
    RigidPart part(const Point &x) const
    {
      return carrier_ ? RigidPart() : RigidPart{x, x - before_.to(now_.from(x))};
    }

  private:
    RigidPoint closest_on_paraboloid(const Point &p) const;
    RigidPoint closest_on_triangles(const Point &p) const;
    void       place(const Placement &placement);

    MasterSurfaceParameters parameters_;
    PrescribedMotion        motion_;

    std::shared_ptr<const TriangleSurface> triangles_; ///< where they are at t = 0, or nullptr

    std::optional<RigidCarrier> carrier_;
    Placement                   before_, now_;
    Point                       point_; ///< now
    Vector3                     axis_;  ///< unit, now; zero for a sphere
  };
} // namespace Nodus

#endif
