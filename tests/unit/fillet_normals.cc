// Averaged normals where the curvature jumps (eq. P7): a flat that turns into a side by a rounded edge of six facets of
// 15 degrees, straight or around a circle (eight facets in a quarter). With equal shares the normals where flat, edge
// and side meet would be off by a quarter of a facet, 3.67 and 3.59 degrees; elsewhere they are exact already. The same
// on three ranks. How far the smoothed surface misses the body, against a sagitta of the facets of 0.0428.

#include "../contact_fixture.h"

#include <fstream>

using namespace Cases;

namespace
{
  constexpr unsigned int n_flat = 4, n_edge = 6, n_side = 3, n_profile = n_flat + n_edge + n_side;
  constexpr double       radius = 5., depth = 2., turning = 20.;
  constexpr double       degree = dealii::numbers::PI / 180.;

  /// Angle between the normal and the axis at a node of the profile.
  double angle(const unsigned int i)
  {
    return 90. * degree * std::min(i > n_flat ? i - n_flat : 0, n_edge) / n_edge;
  }

  /// Node i of the profile in its plane, moved into the body by @p inwards.
  dealii::Point<2> profile(const unsigned int i, const double inwards)
  {
    const double a = angle(i), r = radius - inwards;
    double       x = r * std::sin(a), z = r * std::cos(a);
    if (i < n_flat)
      x -= 1.25 * (n_flat - i);
    if (i > n_flat + n_edge)
      z -= 1.2 * (i - n_flat - n_edge);
    return {x, z};
  }

  Point place(const bool around, const double x, const double y, const double z)
  {
    return around ? Point((turning + x) * std::cos(y), (turning + x) * std::sin(y), z) : Point(x, y, z);
  }

  /// A shell with the profile as its outside; that is the physical surface 1.
  void write_shell(const std::string &file, const bool around)
  {
    const unsigned int n_y  = around ? 8 : 4;
    const double       step = around ? 90. * degree / n_y : 2.;
    std::ofstream      out(file);
    out.precision(16);
    const auto node = [&](const unsigned int i, const unsigned int j, const unsigned int k)
    { return 1 + k + 2 * (j + (n_y + 1) * i); };
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << 2 * (n_y + 1) * (n_profile + 1) << '\n';
    for (unsigned int i = 0; i <= n_profile; ++i)
      for (unsigned int j = 0; j <= n_y; ++j)
        for (unsigned int k = 0; k < 2; ++k)
          out << node(i, j, k) << ' ' << place(around, profile(i, k * depth)[0], j * step, profile(i, k * depth)[1])
              << '\n';
    out << "$EndNodes\n$Elements\n" << 2 * n_y * n_profile << '\n';
    unsigned int number = 0;
    for (unsigned int i = 0; i < n_profile; ++i)
      for (unsigned int j = 0; j < n_y; ++j)
      {
        out << ++number << " 3 2 1 1 " << node(i, j, 0) << ' ' << node(i + 1, j, 0) << ' ' << node(i + 1, j + 1, 0)
            << ' ' << node(i, j + 1, 0) << '\n';
        out << ++number << " 5 2 1 1";
        for (const unsigned int k : {1, 0})
          out << ' ' << node(i, j, k) << ' ' << node(i + 1, j, k) << ' ' << node(i + 1, j + 1, k) << ' '
              << node(i, j + 1, k);
        out << '\n';
      }
    out << "$EndElements\n";
  }

  /// Exact normal at a point near the surface, and how far that is outside.
  std::pair<Vector3, double> exact(const bool around, const Point &p)
  {
    const double  x = around ? std::hypot(p[0], p[1]) - turning : p[0], z = p[2];
    const double  a    = x <= 0. ? 0. : z <= 0. ? 90. * degree : std::atan2(x, z);
    const double  out  = x <= 0. ? z - radius : z <= 0. ? x - radius : std::hypot(x, z) - radius;
    const Vector3 axis = Vector3({0., 0., 1.});
    const Vector3 side = around ? Vector3({p[0], p[1], 0.}) / std::hypot(p[0], p[1]) : Vector3({1., 0., 0.});
    return {std::cos(a) * axis + std::sin(a) * side, out};
  }

  void check_shell(const bool around)
  {
    const std::string file = around ? "around.msh" : "straight.msh";
    if (root())
      write_shell(file, around);
    MPI_Barrier(MPI_COMM_WORLD);
    BodyParameters shell, above = box("above", "1,1,1", {0, 0, 20}, {1, 1, 21}, 1, 0);
    shell.name              = "shell";
    shell.mesh_file         = file;
    ContactPairParameters p = pair(region(1, {z_minus}), region(2, {1}));
    p.surface               = ContactPairParameters::Surface::smoothed;
    const ContactFixture   f({above, shell}, {p}, 1);
    const SurfaceGeometry &surface = f.geometry->master[0];

    double      at_junctions = 0., elsewhere = 0., distance = 0.;
    const auto &faces = f.surfaces->master_faces(0);
    for (unsigned int m = 0; m < faces.size(); ++m)
      if (faces[m].owner == dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD))
      {
        // on the ends of the strip averages are one-sided along it: planes of symmetry take that part away
        bool inside = true;
        for (unsigned int n = 0; n < 4; ++n)
        {
          const Point   X      = f.surfaces->nodes()[faces[m].nodes[n]].X;
          const Vector3 normal = exact(around, X).first, found = surface.nodal_normal(m, n);
          const double  x   = around ? std::hypot(X[0], X[1]) - turning : X[0];
          const double  off = std::asin(std::min(1., dealii::cross_product_3d(normal, found).norm())) / degree;
          if (X[1] < 1e-6 || (around ? X[0] < 1e-6 : X[1] > 8. - 1e-6))
            inside = false;
          else if (std::abs(x) < 1e-6 || std::abs(X[2]) < 1e-6)
            at_junctions = std::max(at_junctions, off);
          else
            elsewhere = std::max(elsewhere, off);
        }
        for (const double xi : {0., 0.25, 0.5, 0.75, 1.})
          for (const double eta : {0., 0.25, 0.5, 0.75, 1.})
            if (inside)
              distance = std::max(distance, std::abs(exact(around, surface.at(m, xi, eta).x).second));
      }
    const auto all = [](const double value)
    { return Numbers::small(dealii::Utilities::MPI::max(value, MPI_COMM_WORLD)); };
    report(around ? "around a circle" : "straight",
           "normals off by " + all(at_junctions) + " degrees where the curvature jumps, by " + all(elsewhere) +
               " elsewhere; the surface by " + all(distance));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_shell(false);
  check_shell(true);
}
