// Press and slide with friction, finite strain, non-matching blocks: all linear solvers give the same
// solution to 1e-8, and the forces do not depend on the number of ranks (1e-8; the numbers are those of one rank).

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Parameters p;
  p.bodies = {box("lower", "5,4,2", {0, 0, 0}, {1, 0.8, 0.4}, 100, 0.3),
              box("upper", "3,3,2", {0.1, 0.1, 0.4}, {0.6, 0.7, 0.8}, 200, 0.3)};
  for (auto &body : p.bodies)
    body.material.law = MaterialParameters::Law::neo_hookean;
  p.boundary_conditions = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                           drive("down", region(2, {z_plus}), 2, "-0.02*min(t,1)"),
                           drive("along", region(2, {z_plus}), 0, "0.05*max(t-1,0)"),
                           hold("across", region(2, {z_plus}), {1})};
  p.contact_pairs       = {pair(region(2, {z_minus}), region(1, {z_plus}), 0.3)};
  p.load_stepping       = {{1., 2.}, {1, 3}};
  p.output.vtu_interval = 0;

  using Type                = LinearSolverParameters::Type;
  const std::string names[] = {"direct", "block", "condensed"};
  Vector3           force[3];
  unsigned int      slip[3];
  Vector3           u[3];
  double            cone = 0.;
  for (const auto type : {Type::direct, Type::block, Type::condensed})
  {
    const unsigned int s    = static_cast<unsigned int>(type) - static_cast<unsigned int>(Type::direct);
    p.linear_solver.type    = type;
    p.output.results_folder = names[s] + "_results";
    ContactProblem problem(p, world(), log());
    problem.run();
    force[s]      = problem.contact_resultants()[0].slave_force;
    slip[s]       = problem.contact_resultants()[0].slip;
    u[s]          = problem.displacement(2, {0.6, 0.7, 0.4});
    const auto &f = problem.contact_fields()[0];
    for (unsigned int k = 0; k < f.X.size(); ++k)
      if (f.status[k] == ContactStatus::slip)
        cone = std::max(cone,
                        std::abs(f.friction[k].norm() - 0.3 * f.pressure[k]) /
                            problem.contact_resultants()[0].maximum_pressure);
  }
  const double reference[] = {-0.5101412194, 0., 1.684709356};
  for (unsigned int c = 0; c < 3; ++c)
    check("force component " + std::to_string(c), force[0][c], reference[c], 1e-8, force[0].norm());
  check("slipping nodes carry mu times their pressure, threshold tolerance", cone < 1e-4);
  report("nodes that slip", std::to_string(slip[0]));
  for (const unsigned int s : {1, 2})
  {
    check(names[s] + " against direct, force", force[s], force[0], 1e-8);
    check(names[s] + " against direct, displacement", u[s], u[0], 1e-8);
    check_equal("nodes that slip", slip[s], slip[0]);
  }
}
