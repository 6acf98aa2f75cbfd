// Two pins of 0.2 are pressed 0.1 and 0.06 deep into a block in one increment, without friction: neither is missed, and
// the forces are those of ten increments, since the law has no history. Nor does it matter where a pin comes from in
// the increment: from where it touches, from a gap of half its size, or from metres away in a mesh of tenths.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;

  /// The second pin begins @p gap above the block.
  Parameters pins(const double gap, const unsigned int increments, const Scheme scheme)
  {
    Parameters p;
    p.bodies = {box("block", "6,3,3", {0, 0, 0}, {2, 1, 1}, 1000, 0.3),
                box("pin", "2,2,2", {0.4, 0.4, 1}, {0.6, 0.6, 1.2}, 1000, 0.3),
                box("other pin", "2,2,2", {1.4, 0.4, 1}, {1.6, 0.6, 1.2}, 1000, 0.3)};
    for (auto &body : p.bodies)
      body.material.law = MaterialParameters::Law::neo_hookean;
    p.bodies[2].translation = Vector3({0, 0, gap});
    p.boundary_conditions   = {
          hold("ground", region(1, {z_minus}), {0, 1, 2}),
          hold("guide", region(2, {z_plus}), {0, 1}),
          hold("other guide", region(3, {z_plus}), {0, 1}),
          drive("pin", region(2, {z_plus}), 2, "-0.1*t"),
          drive("other pin", region(3, {z_plus}), 2, "-0.06*t-" + std::to_string(gap) + "*min(10*t,1)")};
    p.contact_pairs = {pair(region(2, {z_minus}), region(1, {z_plus})),
                       pair(region(3, {z_minus}), region(1, {z_plus}))};
    for (auto &contact : p.contact_pairs)
      contact.scheme = scheme;
    p.load_stepping.increments = {increments};
    p.output.results_folder    = "far_motion_results";
    p.output.vtu_interval      = 0;
    return p;
  }

  std::array<double, 2> forces(const Parameters &p)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto contact = problem.contact_resultants();
    return {{contact[0].slave_force[2], contact[1].slave_force[2]}};
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const auto &[name, scheme] : {std::make_pair("averaged", Scheme::averaged),
                                     {"nodal", Scheme::nodal},
                                     {"integration point", Scheme::integration_point}})
  {
    report("scheme", name);
    const std::array<double, 2> reference = forces(pins(0., 10, scheme));
    for (const auto &[from, gap] :
         {std::make_pair("from where it touches", 0.), {"from a gap of 0.1", 0.1}, {"from 1000 away", 1000.}})
    {
      const std::array<double, 2> force = forces(pins(gap, 1, scheme));
      for (const unsigned int pin : {0, 1})
        check(from + std::string(", pin ") + std::to_string(pin + 1), force[pin], reference[pin], 1e-6);
    }
  }
}
