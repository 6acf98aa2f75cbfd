// A fold: a ring is pressed flat between two planes, so that at its sides the nearest face to a node, where the ring
// turns back, is another one than the opposite wall, whose gap the node has the mean of. With the normal of the nearest
// face the mean gap would change its sign, and the node would close without a touch: increments without an equilibrium.
// Force: elastica of a flat part and two loops without curvature at their ends, EI theta'^2 / 2 = F sin(theta), so that
// P = 2 F = 5.7422 EI / height^2 between the middles of the walls, (int_0^pi sqrt(sin) = 2.39628)^2 = 5.7422.

#include "../cases.h"

using namespace Cases;

namespace
{
  constexpr double E = 10., nu = 0.3, outer = 12., wall = 0.8, way = 20.3;

  ContactPairParameters plane(const std::string &name, const std::string &where, const double y)
  {
    ContactPairParameters pair;
    pair.name                 = name;
    pair.slave                = region(1, {}, "sqrt(x^2+y^2)>11.8 && abs(nz)<0.5 && " + where);
    pair.master_surface.shape = MasterSurfaceParameters::Shape::plane;
    pair.master_surface.point = Point(0., y, 0.);
    pair.master_surface.axis  = Vector3({0., y > 0. ? -1. : 1., 0.});
    return pair;
  }

  Parameters ring()
  {
    Parameters     p;
    BodyParameters body;
    body.name                    = "ring";
    body.generator               = "cylinder_shell";
    body.generator_arguments     = "1 : 11.2 : 12 : 48 : 1";
    body.material.youngs_modulus = E;
    body.material.poissons_ratio = nu;
    p.degree                     = 2;
    p.bodies                     = {body};
    p.boundary_conditions        = {hold("plane strain", region(0, {}, "abs(z-0.5)>0.4999"), {2}),
                                    hold("upright", region(0, {}, "abs(x)<1e-6"), {0})};
    ContactPairParameters inside;
    inside.name         = "inside";
    inside.slave        = region(1, {}, "sqrt(x^2+y^2)<11.4 && abs(nz)<0.5");
    inside.master       = inside.slave;
    inside.self_contact = true;
    p.contact_pairs     = {plane("floor", "y<-2", -outer), plane("press", "y>2", outer), inside};
    p.contact_pairs[1].master_surface.motion.translation = {"0", "-20.3*t", "0"};
    p.load_stepping                                      = {{1.}, {10}};
    p.load_stepping.cut_back                             = false;
    p.output.write_vtu                                   = false;
    p.output.results_folder                              = "fold_results";
    return p;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  ContactProblem                           problem(ring(), world(), log());
  unsigned int                             fallbacks = 0;
  std::vector<double>                      force;
  problem.on_increment(
      [&](const unsigned int, const double)
      {
        fallbacks += problem.iterations().fallbacks;
        force.push_back(problem.contact_resultants()[1].slave_force.norm());
      });
  problem.run();
  check_count("fallbacks", fallbacks, 0);
  const double EI = E / (1. - nu * nu) * std::pow(wall, 3) / 12.;
  for (const unsigned int increment : {7, 8, 9})
  {
    const double height = 2. * outer - wall - way * increment / 10.;
    check("force at a height of " + Numbers::plain(height, 3),
          force[increment - 1],
          5.7422 * EI / (height * height),
          0.05);
  }
  const ContactResultants inside = problem.contact_resultants()[2];
  check_equal("closed nodes of the inside", inside.stick + inside.slip, 0);
  return 0;
}
