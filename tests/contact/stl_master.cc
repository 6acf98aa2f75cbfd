// A rigid ball of 5120 triangles from an STL file presses like the sphere in closed form, within 0.5 %: all schemes,
// turned to other triangles, turning in place with friction, carried by a body that a force drives and that rolls. The
// radius of contact is one and a half edges of triangles, and the ball goes in by a tenth of an edge: triangles that
// stay flat are far off. Then plates with a rim over a cube: uniaxial stress as under a plane, and nodes beyond the rim
// that have no partner. On any number of ranks.

#include "../cases.h"
#include "../stl.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Shape  = MasterSurfaceParameters::Shape;
  using Scheme = ContactPairParameters::Scheme;

  const std::string folder = "stl_master_results", ball = "stl_master_ball.stl", plate = "stl_master_plate.stl";
  const double      radius = 2., depth = 0.02;

  void write(const std::string &file, const Stl::Triangles &triangles)
  {
    if (root())
      Stl::write_binary(file, triangles);
    MPI_Barrier(world());
  }

  /// A block under a sphere, or the ball of triangles, that goes down by the depth until t = 1.
  Parameters ball_on_block(const bool triangles, const Scheme scheme, const double friction)
  {
    Parameters p;
    p.bodies                     = {box("block", "8,8,4", {-1, -1, -1}, {1, 1, 0}, 1000, 0.3)};
    p.bodies[0].local_refinement = 2;
    p.bodies[0].refine_where     = "x^2+y^2+2*z^2<0.14";
    p.boundary_conditions        = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    p.contact_pairs              = {ContactPairParameters()};
    auto &pair                   = p.contact_pairs[0];
    pair.slave                   = region(1, {z_plus}, "x^2+y^2<0.2");
    pair.scheme                  = scheme;
    pair.friction_coefficient    = friction;
    auto &surface                = pair.master_surface;
    surface.shape                = triangles ? Shape::triangles : Shape::sphere;
    surface.point                = Point(0.01, 0.02, radius);
    surface.motion.translation   = {"0", "0", "-0.02*min(t,1)"};
    if (triangles)
      surface.file = ball;
    else
      surface.radius = radius;
    p.load_stepping         = {{1.}, {1}};
    p.output.results_folder = folder;
    p.output.write_vtu      = false;
    return p;
  }

  ContactResultants resultants(const Parameters &p)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    return problem.contact_resultants()[0];
  }

  void turn(Parameters &p, const std::string &angle, const Vector3 &axis)
  {
    p.contact_pairs[0].master_surface.motion.rotation      = angle;
    p.contact_pairs[0].master_surface.motion.rotation_axis = axis;
  }

  void check_pressed(const Scheme scheme)
  {
    const ContactResultants sphere = resultants(ball_on_block(false, scheme, 0.));
    Parameters              p      = ball_on_block(true, scheme, 0.);
    const ContactResultants stl    = resultants(p);
    check("pressed, " + text_of(scheme) + ": force", stl.master_force[2], sphere.master_force[2], 5e-3);
    check("  largest pressure", stl.maximum_pressure, sphere.maximum_pressure, 5e-3);
    if (scheme != Scheme::averaged)
      return;
    for (const std::string angle : {"50", "110"})
    {
      turn(p, angle, Vector3({1., 2., 3.}));
      check("  turned by " + angle + " degrees", resultants(p).master_force[2], sphere.master_force[2], 5e-3);
    }
    p.contact_pairs[0].surface = ContactPairParameters::Surface::faceted;
    const double flat          = resultants(p).master_force[2] / sphere.master_force[2] - 1.;
    report("  with flat triangles off by", Numbers::small(std::abs(flat), 2) + (std::abs(flat) > 5e-3 ? "" : ": NO"));
  }

  /// Turned in place about its vertical diameter with friction.
  void check_spun()
  {
    double moment[2];
    for (const bool triangles : {false, true})
    {
      Parameters p = ball_on_block(triangles, Scheme::averaged, 0.3);
      turn(p, "5*max(0,t-1)", Vector3({0., 0., 1.}));
      p.load_stepping           = {{1., 2.}, {1, 2}};
      const ContactResultants r = resultants(p);
      moment[triangles]         = r.master_moment[2] -
                          dealii::cross_product_3d(Vector3(p.contact_pairs[0].master_surface.point), r.master_force)[2];
    }
    check("turned in place: moment of friction", moment[1], moment[0], 5e-3);
  }

  /// A body without a mesh carries it, is pressed down with a given force and dragged; free to roll or not.
  void check_carried(const bool rolls, const Scheme scheme)
  {
    std::vector<RigidBodyMotion>   body;
    std::vector<ContactResultants> contact;
    for (const bool triangles : {false, true})
    {
      Parameters p = ball_on_block(triangles, scheme, 0.3);
      p.bodies.emplace_back();
      p.bodies[1].name                   = "tool";
      p.bodies[1].rigid                  = true;
      p.bodies[1].motion.rotation_centre = {0.01, 0.02, radius};
      p.bodies[1].motion.translation     = {"0.03*max(0,t-1)", "0", "0"};
      p.bodies[1].rigid_free             = rolls ? std::vector<unsigned int>{2, 4} : std::vector<unsigned int>{2};
      p.bodies[1].rigid_force            = {"0", "0", "-5*min(t,1)"};
      p.contact_pairs[0].master.bodies   = {2};
      p.contact_pairs[0].start.status    = ContactPairParameters::InitialStatus::closed;
      p.contact_pairs[0].master_surface.point[2] = radius - 1e-4;
      p.contact_pairs[0].master_surface.motion   = {};
      p.load_stepping                            = {{1., 2.}, {1, 2}};
      ContactProblem problem(p, world(), log());
      problem.run();
      body.push_back(problem.rigid_bodies()[0]);
      contact.push_back(problem.contact_resultants()[0]);
    }
    check(std::string("carried, ") + text_of(scheme) + (rolls ? ", rolls" : ", slides") + ": goes down by",
          body[1].translation[2],
          body[0].translation[2],
          5e-3);
    check("  force", contact[1].master_force[2], 5., 1e-6);
    if (rolls)
    {
      check("  turns by", body[1].rotation[1], body[0].rotation[1], 5e-3);
      check("  turns by its way over its radius", body[1].rotation[1], 0.03 / radius, 0.05);
    }
    else
      check("  resistance", contact[1].master_force[0], contact[0].master_force[0], 5e-3);
  }

  /// A cube compressed by 1 % by a plate that ends where x = end, with some play in y.
  void check_plate(const Scheme scheme, const double end)
  {
    write(plate, Stl::plate(Point(-0.2, -0.2, 0.), Vector3({0., 1.4, 0.}), Vector3({0.2 + end, 0., 0.}), 2)); // down
    Parameters p;
    p.bodies                   = {box("cube", "4,4,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.)};
    p.boundary_conditions      = {hold("x", region(1, {x_minus}), {0}),
                                  hold("y", region(1, {y_minus}), {1}),
                                  hold("z", region(1, {z_minus}), {2})};
    p.contact_pairs            = {ContactPairParameters()};
    auto &pair                 = p.contact_pairs[0];
    pair.slave                 = region(1, {z_plus});
    pair.scheme                = scheme;
    auto &surface              = pair.master_surface;
    surface.shape              = Shape::triangles;
    surface.file               = plate;
    surface.point              = Point(0., 0., 1.);
    surface.motion.translation = {"0", "0", "-0.01*t"};
    p.output.results_folder    = folder;
    p.output.write_vtu         = false;
    const ContactResultants r  = resultants(p);
    std::ostringstream      name;
    name << "plate up to x = " << end << ", " << text_of(scheme);
    if (end >= 1.)
      check(name.str() + ": force", r.master_force[2], 10., 1e-6);
    else
      check_equal(name.str() + ": nodes without a partner", r.unpaired, 10);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  write(ball, Stl::icosphere(4, radius));
  for (const Scheme scheme : {Scheme::averaged, Scheme::nodal, Scheme::integration_point})
    check_pressed(scheme);
  check_spun();
  check_carried(false, Scheme::averaged);
  check_carried(false, Scheme::nodal);
  check_carried(true, Scheme::averaged);
  for (const Scheme scheme : {Scheme::averaged, Scheme::nodal})
    check_plate(scheme, 1.);
  check_plate(Scheme::nodal, 0.5);
}
