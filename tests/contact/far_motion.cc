// Two pins of 0.2 are pressed 0.1 and 0.06 deep into a block in one increment, without friction: neither is missed, and
// the forces are those of ten increments, since the law has no history. Nor does it matter where a pin comes from in
// the increment: from where it touches, from a gap of half its size, or from metres away in a mesh of tenths.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

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

  /// A block on a plate travels 1000 with it and is then pressed a tenth harder, by 1e-7 of its modulus: round-off of
  /// the displacements is a millionth of the forces. It is no failure of Newton's method.
  void press_far_away()
  {
    Parameters p;
    p.bodies = {box("block", "3,3,3", {0.1, 0.1, 1}, {0.9, 0.9, 1.8}, 1000, 0.3),
                box("plate", "4,4,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.3)};
    for (auto &body : p.bodies)
      body.material.law = MaterialParameters::Law::neo_hookean;
    p.boundary_conditions                   = {hold("ground", region(2, {z_minus}), {1, 2}),
                                               hold("guide", region(1, {z_plus}), {1}),
                                               drive("travel", region(2, {z_minus}), 0, "1000*min(t,1)"),
                                               drive("travel of the block", region(1, {z_plus}), 0, "1000*min(t,1)"),
                                               condition("load",
                                       BoundaryConditionParameters::Type::traction,
                                       region(1, {z_plus}),
                                       {2},
                                       {"-1e-3*min(t,1)-1e-4*max(0,t-1)"})};
    p.contact_pairs                         = {pair(region(1, {z_minus}), region(2, {z_plus}))};
    p.contact_pairs[0].friction_coefficient = 0.3;
    p.load_stepping.interval_ends           = {1., 2.};
    p.load_stepping.increments              = {1, 2};
    p.load_stepping.cut_back                = false;
    p.output.results_folder                 = "far_motion_results";
    p.output.vtu_interval                   = 0;
    ContactProblem problem(p, world(), log());
    unsigned int   most = 0;
    problem.on_increment([&](const unsigned int increment, double)
                         { most = increment > 1 ? std::max(most, problem.iterations().newton) : 0; });
    problem.run();
    check("pressed 1000 away: force", problem.contact_resultants()[0].slave_force[2], 1.1e-3 * 0.64, 1e-5);
    check_count("  most Newton iterations of an increment there", most, 4);
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
  press_far_away();
}
