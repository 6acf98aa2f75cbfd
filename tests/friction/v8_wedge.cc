// A block is driven up a slope s = 0.115 under a guide: the narrower the slot, the larger the pressure, and the
// friction threshold is a fixed point with factor -mu/s, which loops cannot find for mu > s unless they are accelerated
// (theory section 12). Merged and as three loops: the guide carries V = H (1 - mu s)/(mu + s) by equilibrium.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  constexpr double slope = 0.115, H = 1000.;

  Parameters wedge(const double mu, const bool loops)
  {
    Parameters p;
    p.bodies = {box("slope", "17,2,1", {-2, 0, -1}, {14, 2, 0}, 1e6, 0.3),
                box("block", "10,3,4", {0, 0, 0}, {10, 2, 4}, 5000, 0.3)};
    for (auto &body : p.bodies)
    {
      body.rotation_axis  = Vector3({0, 1, 0});
      body.rotation_angle = -std::atan(slope) * 180 / dealii::numbers::PI;
    }
    p.bodies[1].material.law = MaterialParameters::Law::neo_hookean;
    p.boundary_conditions    = {hold("rigid", region(1, {0, 1, 2, 3, 4, 5}), {0, 1, 2}),
                                hold("plane strain", region(2, {y_minus, y_plus}), {1}),
                                hold("guide", region(2, {z_plus}), {2}),
                                condition("push",
                                       BoundaryConditionParameters::Type::traction,
                                       region(2, {x_minus}),
                                       {0},
                                       {std::to_string(H / 8.) + "*t"})};
    ContactPairParameters contact;
    contact.name                 = "slope";
    contact.slave                = region(2, {z_minus});
    contact.master               = region(1, {z_plus});
    contact.friction_coefficient = mu;
    p.contact_pairs              = {contact};
    p.load_stepping.increments   = {5};
    p.output.results_folder      = "v8_results";
    p.output.write_vtu           = false;
    if (loops)
      use_loops(p);
    p.threshold_loop.tolerance = 1e-8;
    return p;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const bool loops : {false, true})
    for (const double mu : {0.1, 0.2, 0.3})
    {
      ContactProblem problem(wedge(mu, loops), world(), log());
      problem.run();
      double guide = 0.;
      for (const auto &[name, force] : problem.reactions())
        if (name == "guide")
          guide = -force[2];
      std::ostringstream text;
      text << (loops ? "three loops" : "merged") << ", mu = " << mu;
      check(text.str(), guide, H * (1. - mu * slope) / (mu + slope), 2e-4);
    }
}
