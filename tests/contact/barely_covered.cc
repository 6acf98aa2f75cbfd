// Slave nodes of which the rim of the master covers next to nothing share their part out (eq. J9). A block lies on the
// slave surface with its rim anywhere in the slave faces: uniform pressure passes exactly. It slides over a plate which
// is the slave: no pressure is far from the mean, and no increment falls back. Without (J9) the pressure at the rim is
// up to 51 times the mean, and there are 8 fallbacks in 11 increments.
//
// A block also slides over the end of a plate, whose side is on the master surface, too: nothing changes by that, and
// the force is that of what still lies on the plate.

#include "../cases.h"

using namespace Cases;

namespace
{
  using Type = BoundaryConditionParameters::Type;

  ContactPairParameters averaged(const RegionParameters &slave, const RegionParameters &master, const double friction)
  {
    ContactPairParameters pair;
    pair.name                 = "pair";
    pair.slave                = slave;
    pair.master               = master;
    pair.friction_coefficient = friction;
    return pair;
  }

  /// A block of unit pressure, nu = 0, on a plate that does not deform, with this part of a face beyond two of the
  /// plate's lines of nodes.
  void lie(const unsigned int degree, const double part)
  {
    Parameters   p;
    const double begin      = 0.25 * part;
    p.degree                = degree;
    p.bodies                = {box("plate", "8,8,1", {-0.5, -0.5, -0.25}, {1.5, 1.5, 0}, 100., 0.),
                               box("block", "7,7,1", {begin, begin, 0}, {begin + 0.9, begin + 0.9, 0.5}, 100., 0.)};
    p.boundary_conditions   = {hold("plate", region(1, {x_minus, x_plus, y_minus, y_plus, z_minus, z_plus}), {0, 1, 2}),
                               hold("x", region(2, {x_minus}), {0}),
                               hold("y", region(2, {y_minus}), {1}),
                               condition("load", Type::traction, region(2, {z_plus}), {2}, {"-t"})};
    p.contact_pairs         = {averaged(region(1, {z_plus}), region(2, {z_minus}), 0.)};
    p.load_stepping         = {{1.}, {1}};
    p.linear_solver.type    = LinearSolverParameters::Type::direct; // pressures to 1e-8 are asked for
    p.output.write_vtu      = false;
    p.output.results_folder = "barely_covered_results";
    ContactProblem problem(p, world(), log());
    problem.run();
    const ContactFields &fields = problem.contact_fields()[0];
    std::vector<double>  pressure;
    for (unsigned int k = 0; k < fields.X.size(); ++k)
      if (fields.status[k] != ContactStatus::open)
        pressure.push_back(fields.pressure[k]);
    if (!root())
      return;
    std::cout << "rim at " << part << " of a face, degree " << degree << ": " << pressure.size() << " nodes"
              << std::endl;
    check("  pressure", farthest(pressure, 1.), 1., 1e-8);
  }

  /// A soft block that is pressed on a plate and moved over it.
  Parameters sliding(const double way, const unsigned int increments)
  {
    Parameters p;
    p.bodies                = {box("block", "6,3,2", {0, 0.25, 0}, {1, 0.75, 0.5}, 100., 0.3),
                               box("plate", "20,7,2", {-1, 0, -0.5}, {2, 1, 0}, 1000., 0.3)};
    p.boundary_conditions   = {hold("ground", region(2, {z_minus}), {0, 1, 2}),
                               drive("press", region(1, {z_plus}), 2, "-0.02*min(t,1)"),
                               drive("drag", region(1, {z_plus}), 0, std::to_string(way) + "*max(t-1,0)"),
                               hold("guide", region(1, {z_plus}), {1})};
    p.load_stepping         = {{1., 2.}, {1, increments}};
    p.output.write_vtu      = false;
    p.output.results_folder = "barely_covered_results";
    return p;
  }

  void slide_over_the_slave()
  {
    Parameters p    = sliding(0.3, 10);
    p.contact_pairs = {averaged(region(2, {z_plus}), region(1, {z_minus}), 0.3)};
    ContactProblem problem(p, world(), log());
    double         largest   = 0.;
    unsigned int   fallbacks = 0, iterations = 0;
    Vector3        force;
    problem.on_increment(
        [&](const unsigned int, const double)
        {
          const auto &r = problem.contact_resultants()[0];
          largest       = std::max(largest, r.maximum_pressure / (std::abs(r.slave_force[2]) / 0.5));
          fallbacks += problem.iterations().fallbacks;
          iterations += problem.iterations().newton;
          force = r.slave_force;
        });
    problem.run();
    if (root())
      std::cout << "sliding over the slave" << std::endl;
    check("  friction over pressing force", std::abs(force[0] / force[2]), 0.3, 5e-3);
    check_error("  largest pressure over the mean", largest, 3.);
    check_count("  fallbacks", fallbacks, 0);
    check("  at most 80 Newton iterations", iterations <= 80);
  }

  Vector3 slide_over_the_end(const std::vector<unsigned int> &ids)
  {
    Parameters p    = sliding(1.6, 16);
    p.contact_pairs = {averaged(region(1, {z_minus}), region(2, ids), 0.3)};
    ContactProblem problem(p, world(), log());
    problem.run();
    return problem.contact_resultants()[0].slave_force;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const double part : {0.02, 0.3, 0.5, 0.7, 0.98})
    lie(1, part);
  lie(2, 0.3);
  slide_over_the_slave();
  if (root())
    std::cout << "over the end" << std::endl;
  const Vector3 top = slide_over_the_end({z_plus}), all = slide_over_the_end({z_plus, x_plus});
  check("  force with the side of the plate", all, top, 1e-6);
}
