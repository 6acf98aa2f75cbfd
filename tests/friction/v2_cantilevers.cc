// Two cantilevers, large sliding without friction, St Venant-Kirchhoff (Code_Aster SSNV505): sum of the vertical
// reactions at the two clamps over 50 increments against Code_Aster's continuous formulation (its two formulations
// differ by 0.2 %).

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Parameters p;
  p.bodies = {box("lower", "40,3,1", {0, -31.75, -5.08}, {2032, 31.75, 5.08}, 6894.8, 0.3333),
              box("upper", "40,3,1", {914.4, 476.25, -5.08}, {2946.4, 539.75, 5.08}, 6894.8, 0.3333)};
  for (auto &body : p.bodies)
    body.material.law = MaterialParameters::Law::st_venant_kirchhoff;
  p.boundary_conditions   = {hold("clamp lower", region(1, {x_minus}), {0, 1}),
                             hold("clamp upper", region(2, {x_plus}), {0, 1}),
                             hold("plane strain", region(0, {z_minus, z_plus}), {2}),
                             drive("drive", region(2, {y_plus}, "abs(x-1625.6)<1e-3"), 1, "-790*t")};
  p.contact_pairs         = {pair(region(2, {y_minus, x_minus}), region(1, {y_plus}))};
  p.load_stepping         = {{1.}, {50}};
  p.output.results_folder = "v2_results";
  p.output.vtu_interval   = 0;

  const double   reference[] = {436.99518570, 1668.0334566, 3264.5297606, 2741.9758698, 3092.5195229};
  ContactProblem problem(p, world(), log());
  problem.on_increment(
      [&](const unsigned int increment, const double t)
      {
        if (increment % 10 == 0)
          check("sum of reactions at t = " + std::to_string(t),
                problem.reactions()[0].second[1] + problem.reactions()[1].second[1],
                reference[increment / 10 - 1],
                0.01);
      });
  problem.run();
}
