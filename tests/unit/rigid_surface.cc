// Rigid surfaces in closed form, convex and as cavities, turned and moved: closest points are on the surface, below the
// point along the normal and nearer than 10000 others; the derivatives of normal and closest point against differences;
// points move as the rigid body does.

#include "rigid/rigid_surface.h"

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <random>

using namespace Cases;

namespace
{
  using Shape = MasterSurfaceParameters::Shape;

  const Point  point(0.3, -0.2, 0.5);
  const double radius = 1.7, angle = 40.;

  MasterSurfaceParameters surface(const Shape shape, const bool cavity)
  {
    MasterSurfaceParameters s;
    s.shape                  = shape;
    s.point                  = point;
    s.axis                   = Vector3({1., 2., -0.5});
    s.radius                 = radius;
    s.cavity                 = cavity;
    s.motion.translation     = {"0.5*t", "t^2", "-t"};
    s.motion.rotation        = "40*t";
    s.motion.rotation_axis   = Vector3({0., 0., 3.});
    s.motion.rotation_centre = {1., 0., 2.};
    return s;
  }

  /// The motion at t = 1 about (1, 0, 2), by hand, and its inverse.
  Point moved(const Point &X)
  {
    const double a = angle * dealii::numbers::PI / 180.;
    const double x = X[0] - 1.;
    return Point(1.5 + std::cos(a) * x - std::sin(a) * X[1], 1. + std::sin(a) * x + std::cos(a) * X[1], X[2] - 1.);
  }
  Point back(const Point &X)
  {
    const double a = -angle * dealii::numbers::PI / 180.;
    const double x = X[0] - 1.5, y = X[1] - 1.;
    return Point(1. + std::cos(a) * x - std::sin(a) * y, std::sin(a) * x + std::cos(a) * y, X[2] + 1.);
  }

  /// Value of a function that is zero on the surface, and a point of the surface from two parameters.
  double equation(const Shape shape, const double sign, const Point &X)
  {
    const Vector3 a = Vector3({1., 2., -0.5}) / std::sqrt(5.25), d = X - point;
    const double  h = d * a, rho = (d - h * a).norm();
    switch (shape)
    {
      case Shape::plane:
        return h;
      case Shape::sphere:
        return d.norm() - radius;
      case Shape::cylinder:
        return rho - radius;
      default:
        return h - sign * rho * rho / (2. * radius);
    }
  }
  Point sample(const Shape shape, const double sign, const double u, const double v)
  {
    const Vector3 a  = Vector3({1., 2., -0.5}) / std::sqrt(5.25);
    Vector3       e1 = Vector3({2., -1., 0.}) / std::sqrt(5.), e2 = dealii::cross_product_3d(a, e1);
    const double  phi = 2. * dealii::numbers::PI * u;
    switch (shape)
    {
      case Shape::plane:
        return point + 6. * (u - 0.5) * e1 + 6. * (v - 0.5) * e2;
      case Shape::sphere:
        return point + radius * ((2. * v - 1.) * a + std::sqrt(1. - (2. * v - 1.) * (2. * v - 1.)) *
                                                         (std::cos(phi) * e1 + std::sin(phi) * e2));
      case Shape::cylinder:
        return point + 6. * (v - 0.5) * a + radius * (std::cos(phi) * e1 + std::sin(phi) * e2);
      default:
        return point + 4. * v * (std::cos(phi) * e1 + std::sin(phi) * e2) + sign * 16. * v * v / (2. * radius) * a;
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::mt19937                             generator(1);
  std::uniform_real_distribution<double>   random(-1., 1.);
  for (const Shape shape : {Shape::plane, Shape::sphere, Shape::cylinder, Shape::paraboloid})
    for (const bool cavity : {false, true})
    {
      if (cavity && shape == Shape::plane)
        continue;
      RigidSurface rigid(surface(shape, cavity), "test");
      rigid.set_increment(0., 1.);
      const double sign = cavity ? 1. : -1.;
      double       off = 0., across = 0., length = 0., farther = 0., gradient = 0., slide = 0., motion = 0.;
      bool         found = true, outward = true;
      for (unsigned int i = 0; i < 20; ++i)
      {
        const Point      p = moved(point + 1.5 * Vector3({random(generator), random(generator), random(generator)}));
        const RigidPoint c = rigid.closest(p);
        found              = found && c.found;
        off                = std::max(off, std::abs(equation(shape, sign, back(c.x))));
        across             = std::max(across, (p - c.x - c.height * c.normal).norm());
        length             = std::max(length, std::abs(c.normal.norm() - 1.));
        motion             = std::max(motion, (rigid.part(c.x).moved - (c.x - back(c.x))).norm());
        // outward: along the normal, one gets away from the rigid body
        const double inside = equation(shape, sign, back(c.x + 1e-3 * c.normal));
        outward             = outward && (inside > 0.) != (cavity && shape != Shape::paraboloid);
        for (unsigned int k = 0; k < 10000; ++k)
          farther = std::max(
              farther, std::abs(c.height) - p.distance(moved(sample(shape, sign, k % 100 / 100., (k / 100) / 100.))));
        const double step = 1e-5;
        for (unsigned int j = 0; j < 3; ++j)
        {
          Vector3 d;
          d[j]                  = step;
          const RigidPoint plus = rigid.closest(p + d), minus = rigid.closest(p - d);
          const double     allowed = 1. / std::min(std::abs(1. + c.height * c.curvature[0]), 1.);
          gradient                 = std::max(gradient,
                              ((plus.normal - minus.normal) / (2. * step) - c.normal_derivative() * d / step).norm() /
                                  allowed);
          slide = std::max(slide, (Vector3(plus.x - minus.x) / (2. * step) - c.slide() * d / step).norm() / allowed);
        }
      }
      std::cout << text_of(shape) << (cavity ? ", cavity" : "") << '\n';
      check("  closest points are found", found);
      check("  on the surface", off < 1e-12);
      check("  below the point along a unit normal", across < 1e-12 && length < 1e-12);
      check("  out of the body", outward);
      check("  none is nearer", farther < 1e-12);
      check("  derivative of the normal", gradient < 1e-6);
      check("  derivative of the closest point", slide < 1e-6);
      check("  material points move with the body", motion < 1e-12);
    }
  RigidSurface ball(surface(Shape::sphere, false), "test");
  check("no point is closest to the centre", !ball.closest(point).found);
  check("  which is a radius deep", ball.height(point), -radius, 1e-12);
  RigidSurface bowl(surface(Shape::paraboloid, true), "test");
  const Point  beyond = point + 2. * radius * Vector3({1., 2., -0.5}) / std::sqrt(5.25);
  check("nor to a point of the axis beyond the focus", !bowl.closest(beyond).found);
  check("  of height R sqrt(2 h/R - 1) for h = 2 R", bowl.height(beyond), radius * std::sqrt(3.), 1e-12);
}
