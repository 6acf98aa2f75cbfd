// A block of rubber that touches a rigid plane as the run starts is pressed on it by 0.5 % of its height while the
// plane goes along by 0.8 of its width, all in one increment, friction 0.1. There is no pressure yet: the first system
// is one without friction, and where the nodes stuck afterwards, as closed nodes do by default, the block would be
// sheared by 160 %. They slip, and friction is mu times the pressure after a few iterations, merged and in loops.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <sstream>

using namespace Cases;

namespace
{
  void run(const std::string &name, const ContactPairParameters::Scheme scheme)
  {
    const double mu = 0.1;
    Parameters   p;
    p.bodies                         = {box("block", "4,4,2", {0, 0, 0}, {1, 1, 0.5}, 10, 0.4999)};
    p.bodies[0].material.law         = MaterialParameters::Law::neo_hookean;
    p.bodies[0].volumetric_treatment = BodyParameters::VolumetricTreatment::mean_dilatation;
    p.boundary_conditions            = {hold("top", region(1, {z_plus}), {0, 1}),
                                        drive("down", region(1, {z_plus}), 2, "-0.0025*t")};
    ContactPairParameters contact;
    contact.slave                             = region(1, {z_minus});
    contact.master_surface.shape              = MasterSurfaceParameters::Shape::plane;
    contact.master_surface.axis               = Vector3({0, 0, 1});
    contact.master_surface.motion.translation = {"0.8*t", "0", "0"};
    contact.friction_coefficient              = mu;
    contact.scheme                            = scheme;
    p.contact_pairs                           = {contact};
    p.load_stepping.interval_ends             = {1.};
    p.load_stepping.increments                = {1};
    p.output.results_folder                   = "touching_at_start_results";
    p.output.vtu_interval                     = 0;

    std::ostringstream text;
    ContactProblem     problem(p, world(), text);
    problem.run();
    const auto result = problem.contact_resultants()[0];
    check(name + ": friction over pressure",
          result.slave_force[0] / result.slave_force[2],
          mu,
          1e-5); // nodes go a little sideways, too
    check(name + ": all nodes slip", result.open == 0 && result.stick == 0);
    check(name + ": nothing is halved", text.str().find("halved") == std::string::npos);
    check_equal(name + ": fallbacks", problem.iterations().fallbacks, 0);
    check(name + ": at most 8 iterations", problem.iterations().newton <= 8);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  run("averaged", ContactPairParameters::Scheme::averaged);
  run("nodal", ContactPairParameters::Scheme::nodal);
}
