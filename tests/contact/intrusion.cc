// How far nodes are behind the other surface of their pair, and which have gone through it, for a block over a wider
// one whose nodes are put where nothing holds them. Expected numbers follow from the geometry: faces of 0.5 above, of
// 0.5 below, a block of thickness 1.

#include "../contact_fixture.h"
#include "../stl.h"

#include "contact/intrusion.h"
#include "contact/triangles.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  constexpr double tolerated = 0.1;

  /// Moves the upper body, which has nodes above z = 1.
  std::vector<Point> moved(const ContactFixture &f, const Vector3 &by, const Vector3 &all = Vector3(), double turn = 0.)
  {
    std::vector<Point> x;
    for (const SurfaceNode &node : f.surfaces->nodes())
    {
      Point        p     = node.X;
      const bool   upper = p[2] > 1.01;
      const double c = std::cos(turn), s = std::sin(turn);
      if (upper)
        p = Point(1. + c * (p[0] - 1.) - s * (p[2] - 1.05), p[1], 1.05 + s * (p[0] - 1.) + c * (p[2] - 1.05));
      x.push_back(p + (upper ? by : Vector3()) + all);
    }
    return x;
  }

  void show(const std::string &what, ContactFixture &f, const std::vector<Point> &before, const std::vector<Point> &now)
  {
    const Intrusion found = find_intrusions(*f.surfaces, before, now, 0., 1., {tolerated})[0];
    if (!root())
      return;
    const SurfaceSide side  = found.depth[master_side] > found.depth[slave_side] ? master_side : slave_side;
    const double      depth = found.depth[side];
    std::cout << what << ": depth " << (depth < 1e-12 ? 0. : depth);
    if (depth > 1e-12)
      std::cout << " at " << (side == slave_side ? "slave" : "master") << " node (" << found.deepest[side] << ')';
    std::cout << ", passed " << (found.passed > 0 ? "yes" : "no") << std::endl;
  }

  void test(const unsigned int degree)
  {
    ContactFixture f({box("lower", "4,4,2", {0, 0, 0}, {2, 2, 1}, 1., 0.),
                      box("upper", "2,2,2", {0.5, 0.5, 1.05}, {1.5, 1.5, 2.05}, 1., 0.)},
                     {pair(region(2, {z_minus}), region(1, {z_plus}))},
                     degree);
    if (root())
      std::cout << "degree " << degree << std::endl;
    const auto at_start = moved(f, {});
    show("at rest over a gap of 0.05", f, at_start, at_start);
    show("pressed 0.06 inside", f, at_start, moved(f, Vector3({0., 0., -0.11})));
    show("pressed 0.3 inside", f, at_start, moved(f, Vector3({0., 0., -0.35})));
    show("as deep before", f, moved(f, Vector3({0., 0., -0.35})), moved(f, Vector3({0., 0., -0.35})));
    show("both bodies carried 40 away", f, at_start, moved(f, {}, Vector3({0., 40., 0.})));
    show("... and pressed 0.3 inside", f, at_start, moved(f, Vector3({0., 0., -0.35}), Vector3({0., 40., 0.})));
    show("thrown through and beyond", f, at_start, moved(f, Vector3({0., 0., -30.})));
    show("thrown through and out sideways", f, at_start, moved(f, Vector3({4., 0., -4.})));
    show("past the rim, and down beside the block",
         f,
         moved(f, Vector3({1.6, 0., 0.})),
         moved(f, Vector3({1.8, 0., -0.6})));
    show("hanging over the rim, bent down",
         f,
         moved(f, Vector3({1.3, 0., -0.05})),
         moved(f, Vector3({1.3, 0., -0.05}), {}, -0.3));
    show("touching, slid along", f, moved(f, Vector3({0., 0., -0.05})), moved(f, Vector3({0.4, 0.2, -0.05})));
    show("touching, pressed 2 inside", f, moved(f, Vector3({0., 0., -0.05})), moved(f, Vector3({0., 0., -2.05})));
  }

  void test_crossings()
  {
    const auto show = [](const std::string &what, const Way &p, const Way &a, const Way &b, const Way &c)
    {
      if (!root())
        return;
      std::cout << what << ':';
      for (const Crossing &crossing : find_crossings(p, a, b, c))
        std::cout << " at " << crossing.time << (crossing.inward ? " inward" : " outward") << " with "
                  << crossing.speed;
      std::cout << std::endl;
    };
    const Way a{{Point(0, 0, 0), Point(0, 0, 0)}}, b{{Point(1, 0, 0), Point(1, 0, 0)}},
        c{{Point(0, 1, 0), Point(0, 1, 0)}};
    show("straight through", {{Point(0.2, 0.2, 1), Point(0.2, 0.2, -3)}}, a, b, c);
    show("back", {{Point(0.2, 0.2, -3), Point(0.2, 0.2, 1)}}, a, b, c);
    show("beside", {{Point(0.7, 0.7, 1), Point(0.7, 0.7, -3)}}, a, b, c);
    show("through an edge", {{Point(0.5, 0., 1), Point(0.5, 0., -1)}}, a, b, c);
    // the triangle turns over while the point rests: its plane comes by twice
    const Way b_up{{Point(1, 0, -1), Point(1, 0, 1)}}, c_up{{Point(0, 1, -1), Point(0, 1, 1)}};
    show("the triangle moves",
         {{Point(0.2, 0.2, 0), Point(0.2, 0.2, 0)}},
         {{Point(0, 0, -1), Point(0, 0, 1)}},
         b_up,
         c_up);
    show("both move together",
         {{Point(0.2, 0.2, 0.1), Point(0.2, 0.2, 2.1)}},
         {{Point(0, 0, 0), Point(0, 0, 2)}},
         {{Point(1, 0, 0), Point(1, 0, 2)}},
         {{Point(0, 1, 0), Point(0, 1, 2)}});
  }

  /// A block whose top at z = 1 a rigid body in closed form moves against, in one increment.
  void test_rigid(const std::string                   &what,
                  const MasterSurfaceParameters::Shape shape,
                  const Point                         &centre,
                  const std::vector<std::string>      &translation,
                  const std::string                   &rotation = "0",
                  const std::string                   &file     = "")
  {
    ContactPairParameters contact;
    contact.slave                             = region(1, {z_plus});
    contact.master_surface.shape              = shape;
    contact.master_surface.point              = centre;
    contact.master_surface.axis               = Vector3({0, 1, 0});
    contact.master_surface.radius             = 0.5;
    contact.master_surface.motion.translation = translation;
    contact.master_surface.motion.rotation    = rotation;
    if (shape == MasterSurfaceParameters::Shape::triangles)
    {
      contact.surface               = ContactPairParameters::Surface::smoothed;
      contact.master_surface.file   = file;
      contact.master_surface.axis   = Vector3();
      contact.master_surface.radius = 0.;
    }
    ContactFixture f({box("block", "4,4,2", {0, 0, 0}, {2, 2, 1}, 1., 0.)}, {contact}, 1);
    const auto     at_rest = moved(f, {});
    show(what, f, at_rest, at_rest);
  }

  /// The same ball as triangles, then two walls 0.3 thick that go along x through the top of the block: of one file,
  /// with a node row between them, or over one.
  void test_triangles()
  {
    const std::string ball = "intrusion_ball.stl", walls = "intrusion_walls.stl", sheet = "intrusion_sheet.stl";
    const auto        both   = Stl::box(Point(0., 0., 0.), Point(0.3, 0.3, 1.), 2);
    Stl::Triangles    pieces = both;
    for (auto triangle : both)
    {
      for (Point &p : triangle)
        p[1] += 0.5;
      pieces.push_back(triangle);
    }
    const auto write = [&](const std::string &file, const Stl::Triangles &triangles)
    {
      if (root())
        Stl::write_binary(file, triangles);
      MPI_Barrier(MPI_COMM_WORLD);
    };
    write(ball, Stl::icosphere(3, 0.5));
    write(walls, pieces);
    write(sheet, Stl::plate(Point(-0.3, -0.3, 0.), Vector3({0., 0.6, 0.}), Vector3({0.6, 0., 0.}), 2)); // faces down
    const auto test = [&](const std::string              &what,
                          const std::string              &file,
                          const Point                    &origin,
                          const std::vector<std::string> &way,
                          const std::string              &turn = "0")
    { test_rigid(what, MasterSurfaceParameters::Shape::triangles, origin, way, turn, file); };
    test("a ball of triangles comes down to 0.2", ball, Point(1, 1, 1.6), {"0", "0", "-0.3*t"});
    test("a ball of triangles goes through the block", ball, Point(1, 1, 1.6), {"0", "0", "-2*t"});
    test("a ball of triangles goes through it a thousand blocks far", ball, Point(1, 1, 1.6), {"0", "0", "-1000*t"});
    test("a ball of triangles flies past above it", ball, Point(-5, 1, 1.6), {"10*t", "0", "0"});
    test("two walls go through the top beside its nodes", walls, Point(-3, 1.1, 0.5), {"7*t", "0", "0"});
    test("two walls go through the top over nodes", walls, Point(-3, 0.85, 0.5), {"7*t", "0", "0"});
    test("a sheet comes down to 0.2 around a node", sheet, Point(1, 1, 1.1), {"0", "0", "-0.3*t"});
    test("a sheet goes down beside nodes", sheet, Point(-0.4, 1, 1.1), {"0", "0", "-3*t"});
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test_crossings();
  test(1);
  test(2);

  using Shape = MasterSurfaceParameters::Shape;
  test_rigid("a sphere comes down to 0.2", Shape::sphere, Point(1, 1, 1.6), {"0", "0", "-0.3*t"});
  test_rigid("a sphere ends with its centre in a node", Shape::sphere, Point(1, 1, 1.6), {"0", "0", "-0.6*t"});
  test_rigid("a sphere goes through the block", Shape::sphere, Point(1, 1, 1.6), {"0", "0", "-2*t"});
  test_rigid("a sphere goes through it a thousand blocks far", Shape::sphere, Point(1, 1, 1.6), {"0", "0", "-1000*t"});
  test_rigid("a sphere flies past above it", Shape::sphere, Point(-5, 1, 1.6), {"10*t", "0", "0"});
  test_rigid("a cylinder goes through the block", Shape::cylinder, Point(1, 1, 1.6), {"0.1*t", "0.3*t", "-3*t"});
  test_rigid("a cylinder turns on the block", Shape::cylinder, Point(1, 1, 1.5), {"0", "0", "0"}, "170*t");
  test_rigid("a cylinder rolls over it", Shape::cylinder, Point(0.5, 1, 1.5), {"t", "0", "0"}, "360/3.14159265*t");
  test_triangles();
}
