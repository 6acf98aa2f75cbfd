// Supports along axes that are not those of x, y, z: rigid surfaces with bilateral contact, which hold the displacement
// along their normal and leave the others free. A block that stands askew, three of its faces on planes and the fourth
// drawn out by one, has uniform stress; so it has with z held by a condition besides. A ring whose outside a cylinder
// holds radially follows Lame's solution.

#include "../cases.h"

#include <deal.II/base/mpi.h>
#include <deal.II/physics/transformations.h>

using namespace Cases;

namespace
{
  using Shape = MasterSurfaceParameters::Shape;

  /// Holds the faces along the normal of the surface.
  ContactPairParameters support(const std::string &name, const RegionParameters &faces)
  {
    ContactPairParameters p;
    p.name         = name;
    p.slave        = faces;
    p.contact_law  = ContactPairParameters::ContactLaw::bilateral;
    p.start.status = ContactPairParameters::InitialStatus::closed;
    return p;
  }

  ContactPairParameters
  plane(const std::string &name, const unsigned int id, const Vector3 &through, const Vector3 &normal)
  {
    ContactPairParameters p = support(name, region(1, {id}));
    p.master_surface.shape  = Shape::plane;
    p.master_surface.point  = Point(through);
    p.master_surface.axis   = normal;
    return p;
  }

  /// Turned by 30 degrees about (1, 1, 1), or about z with faces that are held in this direction: plane strain.
  void askew_block(const unsigned int degree, const bool plane_strain)
  {
    constexpr double             E = 200., nu = 0.3, strain = 0.01;
    const Vector3                axis = plane_strain ? Vector3({0, 0, 1}) : Vector3({1, 1, 1}) / std::sqrt(3.);
    const dealii::Tensor<2, dim> R =
        dealii::Physics::Transformations::Rotations::rotation_matrix_3d(Point(axis), dealii::numbers::PI / 6.);
    const double  across = plane_strain ? -nu / (1. - nu) : -nu;
    const Vector3 reference({strain, across * strain, plane_strain ? 0. : across * strain});
    Parameters    p;
    p.degree                   = degree;
    p.bodies                   = {box("block", "3,2,2", {0, 0, 0}, {1, 1, 1}, E, nu)};
    p.bodies[0].rotation_axis  = axis;
    p.bodies[0].rotation_angle = 30.;
    p.load_stepping            = {{1.}, {2}};
    p.output.results_folder    = "inclined_supports";
    p.output.write_vtu         = false;
    const Vector3 e[dim]       = {R * Vector3({1, 0, 0}), R * Vector3({0, 1, 0}), R * Vector3({0, 0, 1})};
    p.contact_pairs            = {
                   plane("drawn", x_plus, e[0], -e[0]), plane("x", x_minus, {}, e[0]), plane("y", y_minus, {}, e[1])};
    if (plane_strain)
      p.boundary_conditions = {hold("z", region(1, {z_minus, z_plus}), {2})};
    else
      p.contact_pairs.push_back(plane("z", z_minus, {}, e[2]));
    for (unsigned int c = 0; c < dim; ++c)
    {
      std::ostringstream text;
      text << std::setprecision(17) << strain * e[0][c] << "*t";
      p.contact_pairs[0].master_surface.motion.translation[c] = text.str();
    }
    ContactProblem problem(p, world(), log());
    problem.run();
    check(std::string(plane_strain ? "plane strain" : "askew block") + " of degree " + std::to_string(degree) +
              ": corner",
          problem.displacement(1, Point(R * Vector3({1, 1, 1}))),
          R * reference,
          1e-8);
    check("  edge",
          problem.displacement(1, Point(R * Vector3({1, 0, 0.5}))),
          R * Vector3({strain, 0, 0.5 * reference[2]}),
          1e-8);
    check("  force",
          problem.contact_resultants()[0].slave_force,
          (plane_strain ? E / (1. - nu * nu) : E) * strain * e[0],
          1e-8);
  }

  /// Plane strain: u = A r + B/r with u = 0 outside and sigma_r = -p inside.
  void held_ring(const unsigned int degree, const double tolerance)
  {
    constexpr double E = 200., nu = 0.3, inner = 1., outer = 2.;
    constexpr double lambda = E * nu / ((1. + nu) * (1. - 2. * nu)), mu = E / (2. * (1. + nu));
    constexpr double B = 1. / (2. * (lambda + mu) / (outer * outer) + 2. * mu / (inner * inner));
    Parameters       p;
    p.degree                                 = degree;
    p.bodies                                 = {box("ring", "1,1,1", {0, 0, 0}, {1, 1, 1}, E, nu)};
    p.bodies[0].generator                    = "cylinder_shell";
    p.bodies[0].generator_arguments          = "0.5 : 1 : 2 : 32 : 1";
    p.bodies[0].global_refinement            = 1;
    p.load_stepping                          = {{1.}, {1}};
    p.output.results_folder                  = "inclined_supports_ring";
    p.output.write_vtu                       = false;
    p.boundary_conditions                    = {hold("axial", region(1, {}, "abs(nz)>0.9"), {2}),
                                                hold("turn", region(1, {}, "abs(y)<1e-6 && x>0"), {1}),
                                                press("inside", region(1, {}, "x*nx+y*ny<-0.5"), "t")};
    p.contact_pairs                          = {support("radial", region(1, {}, "x*nx+y*ny>0.5"))};
    p.contact_pairs[0].master_surface.shape  = Shape::cylinder;
    p.contact_pairs[0].master_surface.axis   = Vector3({0, 0, 1});
    p.contact_pairs[0].master_surface.radius = outer;
    p.contact_pairs[0].master_surface.cavity = true;
    ContactProblem problem(p, world(), log());
    problem.run();
    const double u = B / inner - B * inner / (outer * outer);
    check("held ring of degree " + std::to_string(degree) + ": inside",
          problem.displacement(1, {0, -inner, 0}),
          Vector3({0, -u, 0}),
          tolerance);
    check("  outside", problem.displacement(1, {0, outer, 0}).norm() / u, 0., 1e-2 * tolerance, 1.);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const bool plane_strain : {false, true})
    for (const unsigned int degree : {1, 2})
      askew_block(degree, plane_strain);
  held_ring(1, 5e-2);
  held_ring(2, 2e-3);
}
