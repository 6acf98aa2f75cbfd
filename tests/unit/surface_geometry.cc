// Smoothed faces and averaged normals on a sphere and on a cylinder of radius 2, faces of very different sizes: the
// averaged normals are those of the body; facets miss it by the sagitta R theta^2 / 8, smoothed faces by far less, with
// order 4 in the face size. A sharp edge stays, and a node on a plane of symmetry has its normal in that plane.

#include "../cases.h"

#include "contact/surface_geometry.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  constexpr double R = 2.;

  /// (n+1)^2 points of a patch of 60 x 40 degrees, spacing growing by a factor of about two across it.
  std::vector<Point> patch(const bool sphere, const unsigned int n)
  {
    std::vector<Point> x;
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
      {
        const double s = double(i) / n, t = double(j) / n;
        const double a = (0.7 * s + 0.3 * s * s) * dealii::numbers::PI / 3, b = (0.7 * t + 0.3 * t * t) * 0.7;
        x.push_back(sphere ? Point(R * std::cos(b) * std::cos(a), R * std::cos(b) * std::sin(a), R * std::sin(b))
                           : Point(R * std::cos(a), R * std::sin(a), b));
      }
    return x;
  }

  std::vector<SurfaceFace> faces(const unsigned int n)
  {
    std::vector<SurfaceFace> all;
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int k = i + (n + 1) * j;
        all.push_back({{k, k + 1, k + n + 1, k + n + 2}, 1., 0});
      }
    return all;
  }

  /// Largest distance of inner faces (whose nodes have all their neighbours) from the body.
  double error(const bool sphere, const unsigned int n, const ContactPairParameters::Surface surface)
  {
    const auto                             x = patch(sphere, n);
    const auto                             f = faces(n);
    const std::vector<std::array<bool, 3>> fixed(x.size());
    const SurfaceGeometry                  geometry(f, 1, x, fixed, surface);
    double                                 worst = 0.;
    for (unsigned int j = 1; j + 1 < n; ++j)
      for (unsigned int i = 1; i + 1 < n; ++i)
        for (const double xi : {0., 0.25, 0.5, 0.75})
          for (const double eta : {0., 0.25, 0.5, 0.75})
          {
            const Point p = geometry.at(i + n * j, xi, eta).x;
            worst         = std::max(worst, std::abs((sphere ? p.norm() : std::hypot(p[0], p[1])) - R));
          }
    return worst;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const auto faceted = ContactPairParameters::Surface::faceted, smoothed = ContactPairParameters::Surface::smoothed;

  for (const bool sphere : {true, false})
  {
    const std::string                      body = sphere ? "sphere: " : "cylinder: ";
    const auto                             x    = patch(sphere, 8);
    const auto                             f    = faces(8);
    const std::vector<std::array<bool, 3>> free(x.size());
    const SurfaceGeometry                  geometry(f, 1, x, free, smoothed);
    double                                 worst = 0.;
    for (unsigned int j = 1; j < 7; ++j)
      for (unsigned int i = 1; i < 7; ++i)
      {
        Vector3 exact = x[f[i + 8 * j].nodes[0]];
        if (!sphere)
          exact[2] = 0.;
        worst = std::max(worst, (geometry.nodal_normal(i + 8 * j, 0) - exact / exact.norm()).norm());
      }
    check(body + "averaged normals", worst, 0., 1e-12, 1.);

    const double coarse = error(sphere, 8, smoothed), fine = error(sphere, 16, smoothed);
    check(body + "order of the smoothed faces", std::log2(coarse / fine), 4., 0.1);
    check(body + "order of the facets", std::log2(error(sphere, 8, faceted) / error(sphere, 16, faceted)), 2., 0.1);
    check(body + "smoothed faces miss it by 1/300 of what facets do", fine < error(sphere, 16, faceted) / 300);
    report(body + "facets miss it by, smoothed faces by, over the radius",
           Numbers::number(error(sphere, 16, faceted) / R, 4) + ' ' + Numbers::number(fine / R, 4));
  }

  // Two faces at a right angle keep their edge; the nodes on y = 0 lie on a plane of symmetry.
  const std::vector<Point>         corner = {{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0}, {1, 1, 0.3}, {1, 0, -1}, {1, 1, -1}};
  const std::vector<SurfaceFace>   two    = {{{0, 1, 2, 3}, 1., 0}, {{1, 4, 3, 5}, 1., 0}};
  std::vector<std::array<bool, 3>> fixed(corner.size());
  fixed[0] = fixed[1] = {{false, true, false}};
  const SurfaceGeometry edge(two, 1, corner, fixed, smoothed);
  const double          cosine = edge.nodal_normal(0, 1) * edge.nodal_normal(1, 0);
  report("sharp edge: cosine between normals of its two faces, less than 0.2",
         Numbers::number(cosine, 4) + (cosine < 0.2 ? "" : ": NO"));
  check("plane of symmetry", edge.nodal_normal(0, 1)[1], 0., 1e-14, 1.);
  check("off the plane the normal is that of the face", std::abs(edge.nodal_normal(0, 3)[1]) > 0.1);
}
