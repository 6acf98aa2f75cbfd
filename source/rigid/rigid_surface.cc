#include "rigid/rigid_surface.h"
#include "rigid/triangle_surface.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace Nodus
{
  namespace
  {
    /// Points this close to the centre or to the axis, in radii, have no direction to the surface.
    constexpr double too_close = 1e-9;
    /// Beyond the centre of curvature derivatives have no bound: they stop growing here.
    constexpr double least_distance = 0.1;

    /// A unit vector across @p n.
    Vector3 across(const Vector3 &n)
    {
      Vector3 t;
      t[std::abs(n[0]) < 0.6 ? 0 : 1] = 1.;
      t -= (t * n) * n;
      return t / t.norm();
    }

    /// The root r > 0 of a r^3 + b r = rho with a, rho > 0: the left side is convex, so that Newton's method from a
    /// point above the root comes down to it.
    double cubic_root(const double a, const double b, const double rho)
    {
      double r = std::cbrt(rho / a) + std::sqrt(std::max(0., -b / a));
      if (b > 0.)
        r = std::min(r, rho / b);
      for (unsigned int iteration = 0; iteration < 100; ++iteration)
      {
        const double next = r - (a * r * r * r + b * r - rho) / (3. * a * r * r + b);
        if (!(next < r))
          break;
        r = next;
      }
      return r;
    }
  } // namespace

  dealii::Tensor<2, dim> RigidPoint::normal_derivative() const
  {
    dealii::Tensor<2, dim> result;
    for (unsigned int i = 0; i < 2; ++i)
      result += curvature[i] / std::max(1. + height * curvature[i], least_distance) *
                dealii::outer_product(direction[i], direction[i]);
    return result;
  }

  dealii::Tensor<2, dim> RigidPoint::slide() const
  {
    dealii::Tensor<2, dim> result;
    for (unsigned int i = 0; i < 2; ++i)
      if (!stays[i])
        result += (1. - height * curvature[i] / std::max(1. + height * curvature[i], least_distance)) *
                  dealii::outer_product(direction[i], direction[i]);
    return result;
  }

  RigidSurface::RigidSurface(const MasterSurfaceParameters &parameters, const std::string &label, const bool smoothed)
      : parameters_(parameters)
      , motion_(parameters.motion, parameters.point, parameters.axis, label + ", rigid master")
  {
    if (parameters.shape == MasterSurfaceParameters::Shape::triangles)
      try
      {
        triangles_ = TriangleSurface::of_file(parameters.file,
                                              {parameters.point, parameters.scale, parameters.cavity, smoothed});
      }
      catch (const InputError &error)
      {
        throw InputError(label + ": master file " + error.what());
      }
    set_increment(0., 0.);
  }

  std::string RigidSurface::describe() const
  {
    if (!triangles_)
      return text_of(parameters_.shape);
    return triangles_->describe() + " (" + std::filesystem::path(parameters_.file).filename().string() + ")";
  }

  void RigidSurface::set_increment(const double begin, const double end)
  {
    if (carrier_)
      return;
    before_ = motion_.at(begin);
    place(motion_.at(end));
  }

  void RigidSurface::check_motion(const double t) const
  {
    if (!carrier_)
      motion_.at(t);
  }

  void RigidSurface::follow_carrier(const std::vector<Point> &x)
  {
    if (!carrier_)
      return;
    carrier_->place(x);
    place(carrier_->placement());
  }

  void RigidSurface::place(const Placement &placement)
  {
    now_   = placement;
    point_ = now_.to(parameters_.point);
    axis_  = now_.R * parameters_.axis;
    if (axis_.norm() > 0.)
      axis_ /= axis_.norm();
  }

  RigidPoint RigidSurface::closest(const Point &p) const
  {
    using Shape         = MasterSurfaceParameters::Shape;
    const double radius = parameters_.radius;
    const double sign   = parameters_.cavity ? -1. : 1.;
    Vector3      d      = p - point_;
    RigidPoint   result;
    switch (parameters_.shape)
    {
      case Shape::plane:
        result.found     = true;
        result.normal    = axis_;
        result.height    = d * axis_;
        result.x         = p - result.height * axis_;
        result.direction = {{across(axis_), dealii::cross_product_3d(axis_, across(axis_))}};
        break;
      case Shape::cylinder:
      case Shape::sphere:
      {
        const bool cylinder = parameters_.shape == Shape::cylinder;
        if (cylinder)
          d -= (d * axis_) * axis_;
        const double distance = d.norm();
        if (distance < too_close * radius)
          break;
        result.found        = true;
        result.normal       = sign * d / distance;
        result.height       = sign * (distance - radius);
        result.x            = p - result.height * result.normal;
        const Vector3 along = cylinder ? axis_ : across(result.normal);
        result.direction    = {{dealii::cross_product_3d(along, result.normal), along}};
        result.curvature    = {{sign / radius, cylinder ? 0. : sign / radius}};
        break;
      }
      case Shape::paraboloid:
        return closest_on_paraboloid(p);
      case Shape::triangles:
        return closest_on_triangles(p);
      case Shape::mesh:
        break;
    }
    return result;
  }

  RigidPoint RigidSurface::closest_on_triangles(const Point &p) const
  {
    RigidPoint result = triangles_->closest(now_.from(p));
    result.x          = now_.to(result.x);
    for (Vector3 *const v : {&result.normal, &result.direction[0], &result.direction[1]})
      *v = now_.R * *v;
    return result;
  }

  double RigidSurface::height(const Point &p) const
  {
    if (triangles_)
      return triangles_->height(now_.from(p));
    if (const RigidPoint point = closest(p); point.found)
      return point.height;
    // on the axis: of a sphere or a cylinder the radius away; of a paraboloid, beyond its focus, the circle where
    // c^2/2 r^2 = c h - 1
    const double radius = parameters_.radius;
    if (parameters_.shape != MasterSurfaceParameters::Shape::paraboloid)
      return parameters_.cavity ? radius : -radius;
    const double c = (parameters_.cavity ? 1. : -1.) / radius, h = (p - point_) * axis_;
    return (parameters_.cavity ? 1. : -1.) * std::sqrt(std::max(2. * c * h - 1., 0.)) * radius;
  }

  /// In the plane of the axis and p the surface is height = c r^2/2, and r solves c^2/2 r^3 + (1 - c h) r = rho for a
  /// point at height h and distance rho from the axis.
  RigidPoint RigidSurface::closest_on_paraboloid(const Point &p) const
  {
    const double  c   = (parameters_.cavity ? 1. : -1.) / parameters_.radius;
    const Vector3 d   = p - point_;
    const double  h   = d * axis_;
    const Vector3 off = d - h * axis_;
    const double  rho = off.norm();
    RigidPoint    result;
    const bool    on_axis = rho < too_close * parameters_.radius;
    if (on_axis && 1. - c * h < too_close)
      return result; // beyond the focus, a circle is closest
    const Vector3 e     = on_axis ? across(axis_) : off / rho;
    const double  r     = on_axis ? 0. : cubic_root(0.5 * c * c, 1. - c * h, rho);
    const double  slope = c * r, length = std::sqrt(1. + slope * slope);
    result.found     = true;
    result.x         = point_ + r * e + 0.5 * c * r * r * axis_;
    result.normal    = (axis_ - slope * e) / length;
    result.height    = (p - result.x) * result.normal;
    result.direction = {{(e + slope * axis_) / length, dealii::cross_product_3d(axis_, e)}};
    result.curvature = {{-c / (length * length * length), -c / length}};
    return result;
  }
} // namespace Nodus
