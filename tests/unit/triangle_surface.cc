// Rigid surfaces of triangles, rounded to averaged normals, against closed forms: a sphere, a cylinder with caps, a box
// with sharp edges, an open plate with a rim; normals and closest points are continuous over a bumpy surface, and their
// derivatives are those of differences; the closest point is the nearest of all triangles. Files of both kinds, and
// what is refused.

#include "rigid/triangle_surface.h"
#include "rigid/stl_file.h"

#include "../cases.h"
#include "../stl.h"

#include <deal.II/base/mpi.h>

#include <random>

using namespace Cases;

namespace
{
  std::mt19937                           generator(1);
  std::uniform_real_distribution<double> random_number(-1., 1.);

  Vector3 random_vector()
  {
    return Vector3({random_number(generator), random_number(generator), random_number(generator)});
  }
  /// In a spherical shell.
  Point random_point(const double inner, const double outer)
  {
    Vector3 v;
    do
      v = random_vector();
    while (v.norm() > 1. || v.norm() < 0.1);
    return Point((inner + (outer - inner) * std::abs(random_number(generator))) / v.norm() * v);
  }

  void show(const std::string &what, const double error, const double bound)
  {
    if (bound < 1e-10) // round-off has no digits
      return check(what + " within " + Numbers::plain(bound), error <= bound);
    report(what, Numbers::number(error, 2) + (error <= bound ? "" : ", more than " + Numbers::plain(bound) + ": NO"));
  }

  /// Points around a sphere of radius 1: heights, normals and curvatures.
  void test_sphere(const unsigned int levels, const bool smoothed, const double bound)
  {
    const TriangleSurface surface(Stl::icosphere(levels, 1.), smoothed, "sphere");
    double                height = 0., turn = 0., bent = 0.;
    bool                  found = true;
    for (unsigned int i = 0; i < 2000; ++i)
    {
      const Point      p = random_point(0.7, 1.3);
      const RigidPoint c = surface.closest(p);
      found              = found && c.found && c.overhang == 0.;
      height             = std::max(height, std::abs(c.height - (Vector3(p).norm() - 1.)));
      turn               = std::max(turn, (c.normal - Vector3(p) / Vector3(p).norm()).norm());
      for (const double k : c.curvature)
        bent = std::max(bent, std::abs(k - 1.));
    }
    report(smoothed ? "sphere, rounded" : "sphere", surface.describe());
    check("  closest points are found", found);
    show("  largest error of heights [radii]", height, bound);
    if (!smoothed)
      return;
    show("  of normals", turn, 50. * bound);
    show("  of curvatures", bent, 3000. * bound);
  }

  /// Radius 1, length 3, 36 sectors; where the normal is that of the side the height is that over a cylinder. Many
  /// points: in triangles that are seventeen times as long as wide, iterations that went on below round-off missed 3 of
  /// 100 000.
  void test_cylinder()
  {
    const TriangleSurface surface(Stl::cylinder(1., 3., 36), true, "cylinder");
    double                side = 0., cap = 0., edge = 0.;
    for (unsigned int i = 0; i < 300000; ++i)
    {
      Point p(random_vector());
      for (unsigned int c = 0; c < dim; ++c)
        p[c] = c < 2 ? 1.5 * p[c] : 1.5 + 2. * p[c];
      const double rho = std::hypot(p[0], p[1]), below = std::max(-p[2], p[2] - 3.), beside = rho - 1.;
      const double height = surface.height(p);
      if (below > 0. && beside > 0.01)
        edge = std::max(edge, std::abs(height - std::hypot(below, beside)));
      else if (below > beside + 0.01 && beside < -0.01)
        cap = std::max(cap, std::abs(height - below));
      else if (beside > below + 0.01)
        side = std::max(side, std::abs(height - beside));
    }
    show("cylinder of 36 sectors: largest error of heights over the side", side, 3e-5);
    show("  over the caps", cap, 1e-12);
    show("  beyond the edges, which are round by 1 % of a triangle", edge, 1e-3);
  }

  double height_over_box(const Point &p, const Point &half)
  {
    double  inside = -1e9;
    Vector3 outside;
    for (unsigned int c = 0; c < 3; ++c)
    {
      const double d = std::abs(p[c]) - half[c];
      inside         = std::max(inside, d);
      outside[c]     = std::max(d, 0.);
    }
    return inside < 0. ? inside : outside.norm();
  }

  void test_box(const bool smoothed)
  {
    const Point           half(1., 0.6, 0.3);
    const TriangleSurface surface(Stl::box(Point(-half), half, 5), smoothed, "box");
    double                sides = 0., edges = 0., turn = 0.;
    for (unsigned int i = 0; i < 3000; ++i)
    {
      const Point      p(1.6 * random_vector());
      const RigidPoint c        = surface.closest(p);
      const double     expected = height_over_box(p, half);
      unsigned int     beyond   = 0;
      for (unsigned int d = 0; d < 3; ++d)
        beyond += std::abs(p[d]) > half[d];
      (beyond < 2 ? sides : edges) = std::max(beyond < 2 ? sides : edges, std::abs(c.height - expected));
      if (beyond > 1)
        turn = std::max(turn, (c.normal - (p - c.x) / (p - c.x).norm()).norm() * expected);
    }
    report(smoothed ? "box, rounded" : "box", surface.describe());
    show("  largest error of heights over and below its sides", sides, 1e-12);
    show("  beyond its edges", edges, 1e-4);
    show("  normals there, over the distance", turn, 3e-3);
    const Vector3 mean({1. / std::sqrt(2.), 1. / std::sqrt(2.), 0.});
    check("  on an edge", (surface.closest(Point(half[0], half[1], 0.1) + 1e-9 * mean).normal - mean).norm() < 1e-6);
  }

  void test_plate()
  {
    const TriangleSurface surface(
        Stl::plate(Point(-1., -1., 0.5), Vector3({2., 0., 0.}), Vector3({0., 2., 0.}), 4), true, "plate");
    double height = 0., overhang = 0.;
    bool   far = true, found = true, above = true;
    for (unsigned int i = 0; i < 2000; ++i)
    {
      const Point      p(2.4 * random_number(generator), 0.9 * random_number(generator), random_number(generator));
      const double     beyond = std::max(0., std::abs(p[0]) - 1.);
      const RigidPoint c      = surface.closest(p);
      found                   = found && (beyond > 0.4 || c.found);
      far                     = far && (beyond < 0.55 || !c.found);
      above                   = above && (beyond == 0. || surface.height(p) > 0.);
      if (!c.found)
        continue;
      height   = std::max(height, std::abs(c.height - (p[2] - 0.5)));
      overhang = std::max(overhang, std::abs(c.overhang - beyond));
    }
    report("plate", surface.describe());
    show("  largest error of heights", height, 1e-12);
    show("  of how far points are beyond the rim", overhang, 1e-12);
    check("  found up to a triangle beyond the rim", found);
    check("  and not farther", far);
    check("  nothing is inside beyond the rim", above);
  }

  /// An ellipsoid with bumps, whose corners no quadric goes through.
  Stl::Triangles bumpy(const unsigned int levels)
  {
    Stl::Triangles triangles = Stl::icosphere(levels, 1.);
    for (auto &triangle : triangles)
      for (Point &p : triangle)
      {
        const double r = 1. + 0.05 * std::sin(5. * p[0] + 1.) * std::cos(4. * p[1]) + 0.03 * std::sin(6. * p[2]);
        p              = Point(1.3 * r * p[0], r * p[1], 0.8 * r * p[2]);
      }
    return triangles;
  }

  /// Closest points: against 231 points of each triangle, differences, and the same a step farther on.
  void test_bumpy()
  {
    const auto                 triangles = bumpy(3);
    const TriangleSurface      surface(triangles, true, "bumpy");
    const TriangleMesh         mesh(triangles, true, "bumpy");
    double                     farther = 0., along = 0., kink = 0., slide = 0., gradient = 0., jump = 0., turn = 0.;
    std::vector<TrianglePatch> patches;
    for (unsigned int t = 0; t < triangles.size(); ++t)
      patches.emplace_back(mesh, t);
    std::vector<Point> samples;
    for (const TrianglePatch &patch : patches)
      for (unsigned int i = 0; i <= 20; ++i)
        for (unsigned int j = 0; i + j <= 20; ++j)
          samples.push_back(patch.at(0.05 * i, 0.05 * j).x);
    for (unsigned int t = 0; t < triangles.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
        for (const double r : {0.1, 0.37, 0.5, 0.82})
        {
          const auto at = [](const unsigned int e, const double a) {
            return e == 0 ? std::make_pair(a, 0.) : e == 1 ? std::make_pair(1. - a, a) : std::make_pair(0., 1. - a);
          };
          const auto [s, u]   = at(i, r);
          const auto [s2, u2] = at(mesh.triangles()[t].edge[i], 1. - r);
          const auto one = patches[t].at(s, u), two = patches[mesh.triangles()[t].neighbour[i]].at(s2, u2);
          along = std::max(along, one.x.distance(two.x));
          kink  = std::max(kink, (one.normal() - two.normal()).norm());
        }
    show("bumpy surface of " + std::to_string(triangles.size()) + " triangles: gap between patches", along, 1e-12);
    show("  angle between them", kink, 1e-12);
    for (unsigned int i = 0; i < 500; ++i)
    {
      const Point      on      = samples[std::size_t(0.4999 * (1. + random_number(generator)) * samples.size())];
      const Point      p       = on + 0.03 * random_vector();
      const RigidPoint c       = surface.closest(p);
      double           nearest = 1e9;
      for (const Point &x : samples)
        nearest = std::min(nearest, x.distance(p));
      farther                 = std::max(farther, std::abs(c.height) - nearest);
      const double step       = 1e-6;
      bool         same       = true; // curvatures of one triangle: over edges they jump
      double       largest[2] = {0., 0.};
      for (unsigned int j = 0; j < 3; ++j)
      {
        Vector3 d;
        d[j]                  = step;
        const RigidPoint plus = surface.closest(p + d), minus = surface.closest(p - d);
        jump       = std::max(jump, plus.x.distance(minus.x) / (2. * step));
        turn       = std::max(turn, (plus.normal - minus.normal).norm() / (2. * step));
        same       = same && (plus.normal_derivative() - minus.normal_derivative()).norm() < 1e-2;
        largest[0] = std::max(largest[0],
                              ((plus.normal - minus.normal) / (2. * step) - c.normal_derivative() * d / step).norm());
        largest[1] = std::max(largest[1], (Vector3(plus.x - minus.x) / (2. * step) - c.slide() * d / step).norm());
      }
      if (!same)
        continue;
      gradient = std::max(gradient, largest[0]);
      slide    = std::max(slide, largest[1]);
    }
    for (unsigned int i = 0; i < 300; ++i) // far outside, and inside
    {
      const Point p(1.6 * random_vector());
      double      nearest = 1e9;
      for (const Point &x : samples)
        nearest = std::min(nearest, x.distance(p));
      farther = std::max(farther, std::abs(surface.closest(p).height) - nearest);
    }
    show("  no point of it is nearer than the closest one", std::max(farther, 0.), 1e-12);
    check("  derivative of the normal", gradient < 1e-6);
    check("  of the closest point", slide < 1e-6);
    show("  closest points move at most, over the point's way", jump, 2.);
    show("  and normals turn by", turn, 10.);
  }

  /// Derivatives around the sharp edges of a cylinder.
  void test_sharp_derivatives()
  {
    const TriangleSurface surface(Stl::cylinder(1., 3., 12), true, "cylinder");
    double                gradient = 0., slide = 0.;
    for (unsigned int i = 0; i < 300; ++i)
    {
      const double     phi = 3. * random_number(generator);
      const Point      p(1.3 * std::cos(phi), 1.3 * std::sin(phi), 3.2);
      const RigidPoint c    = surface.closest(p);
      const double     step = 1e-6;
      for (unsigned int j = 0; j < 3; ++j)
      {
        Vector3 d;
        d[j]                  = step;
        const RigidPoint plus = surface.closest(p + d), minus = surface.closest(p - d);
        gradient =
            std::max(gradient, ((plus.normal - minus.normal) / (2. * step) - c.normal_derivative() * d / step).norm());
        slide = std::max(slide, (Vector3(plus.x - minus.x) / (2. * step) - c.slide() * d / step).norm());
      }
    }
    show("around a sharp edge: error of the derivative of the normal", gradient, 0.1);
    show("  of the closest point", slide, 0.05);
  }

  void test_files()
  {
    const auto triangles = Stl::icosphere(1, 2.);
    Stl::write_ascii("triangle_surface.stl", triangles);
    const auto ascii = read_stl("triangle_surface.stl");
    Stl::write_binary("triangle_surface.stl", triangles);
    const auto binary = read_stl("triangle_surface.stl");
    double     off[2] = {0., 0.};
    for (unsigned int t = 0; t < triangles.size(); ++t)
      for (unsigned int i = 0; i < 3; ++i)
      {
        off[0] = std::max(off[0], ascii[t][i].distance(triangles[t][i]));
        off[1] = std::max(off[1], binary[t][i].distance(triangles[t][i]));
      }
    check("read from an ASCII file", ascii.size() == triangles.size() && off[0] == 0.);
    check("  from a binary one, in single precision", binary.size() == triangles.size() && off[1] < 2e-7);
    const TriangleSurface::Options options{Point(0., 0., 1.), 10., true, true};
    const auto                     one = TriangleSurface::of_file("triangle_surface.stl", options),
               two                     = TriangleSurface::of_file("triangle_surface.stl", options);
    check("  once for all that use it", one == two);
    report("  scaled, shifted and turned over", one->describe());
    check("  height at its centre", one->height(Point(0., 0., 1.)), 20., 2e-2);
  }

  void refuse(const std::string &what, const std::string &content)
  {
    std::ofstream("refused.stl", std::ios::binary) << content;
    try
    {
      TriangleSurface(read_stl("refused.stl"), true, "refused.stl");
      report(what, "NO");
    }
    catch (const InputError &error)
    {
      report(what, error.what());
    }
  }
  void refuse(const std::string &what, const Stl::Triangles &triangles)
  {
    Stl::write_ascii("refused.stl", triangles);
    std::ifstream stream("refused.stl");
    refuse(what, std::string((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>()));
  }

  void test_refusals()
  {
    const Stl::Triangles box = Stl::box(Point(0., 0., 0.), Point(1., 1., 1.), 1);
    Stl::write_binary("refused.stl", box);
    std::ifstream     stream("refused.stl", std::ios::binary);
    const std::string binary((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    refuse("nothing", std::string());
    refuse("no triangle", std::string("solid\nendsolid\n"));
    refuse("another file",
           std::string("# a mesh\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n# and more, to be longer than a head\n"));
    refuse("cut off", binary.substr(0, 400));
    std::string nan = binary;
    for (unsigned int i = 0; i < 4; ++i)
      nan[84 + 50 * 6 + 12 + i] = static_cast<char>(0xff);
    refuse("not a number", nan);
    const std::string facet = "solid x y\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n";
    refuse("ends in a facet", facet);
    refuse("not a number in a line", facet + "   vertex 0 nan 0\n  endloop\n endfacet\nendsolid\n");
    refuse("a quadrilateral", facet + "   vertex 1 1 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid\n");
    refuse("two on one side", facet + "   vertex 0 1 0\n  endloop\n endfacet\n");
    Stl::Triangles wrong = box;
    wrong[3][2]          = wrong[3][0] + 0.5 * (wrong[3][1] - wrong[3][0]);
    refuse("no area", wrong);
    wrong = box;
    std::swap(wrong[4][0], wrong[4][1]);
    refuse("turned over", wrong);
    wrong = box;
    wrong.push_back({{Point(0., 0., 0.), Point(0., 0., 1.), Point(0.5, 0.5, 0.5)}});
    refuse("three at an edge", wrong);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test_sphere(3, true, 1e-5);
  test_sphere(4, true, 1e-6);
  test_sphere(4, false, 2e-3);
  test_cylinder();
  test_box(true);
  test_box(false);
  test_plate();
  test_bumpy();
  test_sharp_derivatives();
  test_files();
  test_refusals();
}
