// Projection, frames and surface weights: closest points of warped faces against brute force, overhang, the far side of
// a body, frames on symmetry planes, nodal areas of all weightings.

#include "../contact_fixture.h"

#include <random>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::mt19937                             generator(3);
  std::uniform_real_distribution<double>   random(-1., 1.);

  for (const unsigned int degree : {1u, 2u})
  {
    // A warped face and points around it; the grid of candidates has spacing 1/200.
    const unsigned int n = degree + 1;
    SurfaceFace        face{{}, 1., 0};
    std::vector<Point> x;
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        face.nodes.push_back(x.size());
        x.emplace_back(double(i) / degree + 0.05 * random(generator),
                       double(j) / degree + 0.05 * random(generator),
                       0.15 * random(generator));
      }
    const std::vector<SurfaceFace>           faces = {face};
    const std::vector<std::array<bool, dim>> fixed(x.size());
    const SurfaceGeometry                    surface(faces, degree, x, fixed, ContactPairParameters::Surface::faceted);
    double                                   worst = 0.;
    for (unsigned int trial = 0; trial < 200; ++trial)
    {
      const Point  p(0.5 + random(generator), 0.5 + random(generator), 0.3 * random(generator));
      double       xi, eta;
      const double found = std::sqrt(closest_point(surface, 0, p, xi, eta));
      double       brute = 1e9;
      for (unsigned int i = 0; i <= 200; ++i)
        for (unsigned int j = 0; j <= 200; ++j)
          brute = std::min(brute, p.distance(FaceGeometry(face, FaceShape(degree, i / 200., j / 200.), x).x));
      worst = std::max(worst, found - brute);
    }
    std::cout << "Q" << degree << ":" << std::endl;
    check("  no candidate is closer than the closest point", worst < 1e-10);

    // Upper block, a little aside: its nodes at x = 1.2 and 1.6 stick out of the master, 0.02 of a face is tolerated.
    {
      ContactFixture f(
          {box("lower", "2,2,1", {0, 0, 0}, {1, 1, 1}, 1, 0), box("upper", "2,1,1", {0.4, 0, 1.1}, {1.01, 1, 2}, 1, 0)},
          {pair(region(2, {z_minus}), region(1, {z_plus, z_minus}))},
          degree);
      unsigned int found = 0;
      bool         up = true, gap = true;
      for (unsigned int k = 0; k < f.pairing.size(); ++k)
        if (f.pairing[k].found)
        {
          ++found;
          up  = up && std::abs(f.pairing[k].normal[2] + 1) < 1e-12;
          gap = gap && std::abs(f.assembler->distance(f.state, k) + 0.1) < 1e-12;
        }
      check_equal("  overhang of 0.02 faces: all found", found, f.pairing.size());
      check("  normals point down, never to the far side", up);
      check("  d_n = -0.1", gap);
      double area = 0.;
      for (const double m : f.weights.area())
        area += m;
      check("  nodal areas add up", area, 0.61, 1e-12);
    }
    {
      ContactFixture f(
          {box("lower", "2,2,1", {0, 0, 0}, {1, 1, 1}, 1, 0), box("upper", "2,1,1", {0.5, 0, 1.1}, {1.5, 1, 2}, 1, 0)},
          {pair(region(2, {z_minus}), region(1, {z_plus}))},
          degree);
      unsigned int wrong = 0;
      for (unsigned int k = 0; k < f.pairing.size(); ++k)
        wrong += f.pairing[k].found != (f.surfaces->nodes()[f.surfaces->slave_nodes()[k].node].X[0] < 1.001);
      check("  nodes beyond the rim have no partner", wrong == 0);
    }
    // Symmetry plane x = 0 with a master tilted about y: no friction across the plane, the tangent lies in it. So does
    // the normal on edges between two faces, which is the averaged one (eq. P5), elsewhere it is tilted.
    {
      auto           lower = box("lower", "2,2,1", {0, 0, 0}, {1, 1, 1}, 1, 0);
      auto           upper = box("upper", "2,2,1", {0, 0, 1}, {1, 1, 2}, 1, 0);
      ContactFixture f({lower, upper}, {pair(region(2, {z_minus}), region(1, {z_plus}), 0.5)}, degree);
      dealii::AffineConstraints<double> constraints;
      for (const auto &node : f.surfaces->nodes())
        if (node.X[0] < 1e-9)
          constraints.add_line(node.dofs[0]);
      constraints.close();
      f.surfaces->set_fixed(constraints);
      std::vector<Point> tilted = f.state.x;
      for (auto &p : tilted)
        p[2] += 0.02 * p[0] * (1. - p[0]);
      f.pair_at(tilted);
      bool plane = true, inside = true;
      for (unsigned int k = 0; k < f.pairing.size(); ++k)
      {
        const auto  &q       = f.pairing[k];
        const Point &X       = f.surfaces->nodes()[f.surfaces->slave_nodes()[k].node].X;
        const bool   on_edge = std::abs(X[1] - 0.5) < 1e-9;
        if (X[0] < 1e-9)
          plane = plane && q.found && q.tangent_free[0] && !q.tangent_free[1] && std::abs(q.tangent[0][0]) < 1e-14 &&
                  std::abs(q.tangent[0] * q.normal) < 1e-14 &&
                  (on_edge ? std::abs(q.normal[0]) < 1e-14 : std::abs(q.normal[0]) > 1e-3);
        else
          inside = inside && q.found && q.tangent_free[0] && q.tangent_free[1] &&
                   std::abs(dealii::cross_product_3d(q.tangent[0], q.tangent[1]) * q.normal - 1) < 1e-12;
      }
      check("  symmetry plane: one tangent, in the plane", plane);
      check("  elsewhere a right-handed frame", inside);
    }
  }
}
