// What users see of friction in the tangents of the surface, CSHEAR1/2 and CSLIP1/2 (second tangent: normal x first). A
// block is pressed on a plane at rest and dragged to and fro in two directions, friction coefficient 0.2. It is closed
// all the time, so that the slip that adds up is the tangential displacement of each node; where a node slips, friction
// is 0.2 times the pressure, against its last motion.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

namespace
{
  void drag(const ContactPairParameters::Scheme scheme, const std::string &name)
  {
    Parameters p;
    p.bodies                     = {box("block", "3,2,2", {0, 0, 0}, {1, 0.7, 0.5}, 1000., 0.3)};
    p.boundary_conditions        = {drive("down", region(1, {z_plus}), 2, "-0.005*min(1,3*t)"),
                                    drive("x", region(1, {z_plus}), 0, "0.1*t"),
                                    drive("y", region(1, {z_plus}), 1, "if(t<0.6, 0.05*t, 0.03-0.15*(t-0.6))")};
    p.contact_pairs              = {pair(region(1, {z_minus}), RegionParameters(), 0.2)};
    auto &contact                = p.contact_pairs[0];
    contact.scheme               = scheme;
    contact.start.status         = ContactPairParameters::InitialStatus::closed;
    contact.normal               = ContactPairParameters::Normal::averaged;
    contact.master_surface.shape = MasterSurfaceParameters::Shape::plane;
    contact.master_surface.axis  = Vector3({0., 0., 1.});
    p.load_stepping.increments   = {10};
    p.output.results_folder      = "tangent_frame_results";
    p.output.write_vtu           = false;
    std::vector<Vector3> before;
    ContactProblem       problem(p, world(), log());
    problem.on_increment(
        [&](const unsigned int i, const double)
        {
          if (i == 9)
            before = problem.contact_fields()[0].displacement;
        });
    problem.run();

    const auto  &f    = problem.contact_fields()[0];
    double       slip = 0., largest_slip = 0., shear = 0., cone = 0., against = 1.;
    unsigned int slips = 0;
    for (unsigned int k = 0; k < f.X.size(); ++k)
    {
      const Vector3 second = dealii::cross_product_3d(f.normal[k], f.tangent1[k]);
      const auto    vector = [&](const std::vector<double>(&values)[2])
      { return values[0][k] * f.tangent1[k] + values[1][k] * second; };
      const auto tangential = [&](const Vector3 &v) { return v - (v * f.normal[k]) * f.normal[k]; };
      slip                  = std::max(slip, (vector(f.slip) - tangential(f.displacement[k])).norm());
      largest_slip          = std::max(largest_slip, vector(f.slip).norm());
      shear                 = std::max(shear, (vector(f.shear) - f.friction[k]).norm() / f.friction[k].norm());
      if (f.status[k] != ContactStatus::slip)
        continue;
      ++slips;
      const Vector3 moved = tangential(f.displacement[k] - before[k]);
      cone                = std::max(cone, std::abs(f.friction[k].norm() / f.pressure[k] - 0.2));
      against             = std::min(against, -(f.friction[k] * moved) / (f.friction[k].norm() * moved.norm()));
    }
    check_equal(name + ": nodes that slip", slips, f.X.size());
    check("  largest slip that has added up", largest_slip, std::hypot(0.1, 0.03), 0.05);
    check("  slip less tangential displacement, largest", slip, 0., 1e-9, 1.);
    check("  shear in the tangents less friction, largest", shear, 0., 1e-12, 1.);
    check("  friction over pressure less 0.2, largest", cone, 0., 1e-6, 1.);
    check("  cosine of friction and the way back, smallest", against, 1., 1e-6);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  drag(ContactPairParameters::Scheme::nodal, "nodal");
  drag(ContactPairParameters::Scheme::averaged, "averaged");
}
