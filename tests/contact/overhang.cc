// A block is pressed on a larger slab, which is the slave, and its rim lies just inside a row of slave nodes: a sliver
// of the faces beyond hangs over the rim by less than the projection tolerance. The nodes at the far end of these faces
// must not get a constraint of it, which would repeat that of the nodes at the rim; statuses would cycle.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Integration = ContactPairParameters::Integration;

  void run(const Integration integration, const bool loops)
  {
    Parameters p;
    p.bodies                       = {box("slab", "6,6,2", {0, 0, -2}, {6, 6, 0}, 100, 0.3),
                                      box("block", "2,2,2", {1.026, 1.026, 0}, {4.974, 4.974, 2}, 1000, 0.3)};
    p.boundary_conditions          = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                      hold("guide", region(2, {z_plus}), {0, 1}),
                                      drive("down", region(2, {z_plus}), 2, "-0.02")};
    p.contact_pairs                = {pair(region(1, {z_plus}), region(2, {z_minus}))};
    p.contact_pairs[0].scheme      = ContactPairParameters::Scheme::averaged;
    p.contact_pairs[0].integration = integration;
    p.output.results_folder        = "overhang_results";
    p.output.write_vtu             = false;
    p.load_stepping.cut_back       = false;
    if (loops)
      use_loops(p);
    ContactProblem problem(p, world(), log());
    problem.run();
    check_count("fallbacks", problem.iterations().fallbacks, 0);
    const auto  &fields = problem.contact_fields()[0];
    unsigned int beyond = 0;
    for (unsigned int k = 0; k < fields.X.size(); ++k)
      beyond += fields.paired[k] && std::max(std::abs(fields.X[k][0] - 3), std::abs(fields.X[k][1] - 3)) > 2.5;
    check_count("partners a face beyond the rim", beyond, 0);
    // of 36; the block bulges a little, and a fixed rule does not cut areas at the rim exactly
    const double tolerance = integration == Integration::segment ? 0.005 : 0.03;
    check("contact area", problem.contact_resultants()[0].contact_area, 3.948 * 3.948, tolerance);
    // not a reference, but what the block is pressed with
    const double force = problem.contact_resultants()[0].slave_force[2];
    report("force that carries the block", Numbers::number(force, 4) + (force < -1. ? "" : ": NO"));
  }

  /// Averages whose points are all on the edge of the master, under slave nodes that hang over its rim by half a face:
  /// moments balance for all that (eq. J4 with the shares J6).
  void run_on_edge(const Integration integration)
  {
    Parameters p;
    p.degree                                = 2;
    p.bodies                                = {box("slab", "6,6,2", {0, 0, -2}, {6, 6, 0}, 100, 0.3),
                                               box("block", "2,2,2", {1.51, 1.51, 0}, {4.52, 4.52, 2}, 1000, 0.3)};
    p.boundary_conditions                   = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                               condition("drag",
                                       BoundaryConditionParameters::Type::displacement,
                                       region(2, {z_plus}),
                                       {0, 1, 2},
                                       {"0.02*t", "0", "-0.02"})};
    p.contact_pairs                         = {pair(region(1, {z_plus}), region(2, {z_minus}))};
    p.contact_pairs[0].integration          = integration;
    p.contact_pairs[0].friction_coefficient = 0.3;
    p.output.results_folder                 = "overhang_results";
    p.output.write_vtu                      = false;
    ContactProblem problem(p, world(), log());
    problem.run();
    const ContactResultants r = problem.contact_resultants()[0];
    check("moment of both sides, of the force times a face",
          (r.slave_moment + r.master_moment).norm() / r.slave_force.norm(),
          0.,
          1e-10,
          1.);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const Integration integration : {Integration::face, Integration::segment})
    for (const bool loops : {false, true})
      run(integration, loops);
  for (const Integration integration : {Integration::face, Integration::segment})
    run_on_edge(integration);
}
