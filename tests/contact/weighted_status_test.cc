// Consistent weights: with the raw multiplier in the status test the loop cycles, with the weighted one it converges,
// and to the resultant of nodal quadrature. A paraboloid (z = r^2/16, 6 cells an edge) on a block, 3216 degrees of
// freedom, pressed by 0.02.

#include "paraboloid.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Weights = ContactPairParameters::Weights;
  using Test    = ContactPairParameters::StatusTest;

  Parameters p = paraboloid_on_block("0.02");
  use_loops(p); // the loops may cycle, not their merged iteration

  double nodal = 0.;
  for (const auto &[weights, test, name] :
       {std::make_tuple(Weights::nodal_quadrature, Test::weighted, "nodal quadrature, weighted"),
        std::make_tuple(Weights::dual, Test::weighted, "dual, weighted"),
        std::make_tuple(Weights::consistent, Test::weighted, "consistent, weighted"),
        std::make_tuple(Weights::consistent, Test::raw, "consistent, raw")})
  {
    p.contact_pairs[0].weights     = weights;
    p.contact_pairs[0].status_test = test;
    p.output.results_folder        = "weighted_results";
    ContactProblem problem(p, world(), log());
    try
    {
      problem.run();
      const double force    = problem.contact_resultants()[0].slave_force[2];
      const auto  &pressure = problem.contact_fields()[0].pressure;
      if (weights == Weights::nodal_quadrature)
        nodal = force;
      check(std::string(name) + ": no tension", *std::min_element(pressure.begin(), pressure.end()) > -1e-9);
      check_count(std::string(name) + ": status passes", problem.iterations().status, 8);
      // the areas differ by the curvature, not the displacements
      check(std::string(name) + ": resultant, that of nodal quadrature", force, nodal, 1e-9);
    }
    catch (const SolverFailure &failure)
    {
      check(std::string(name) + ": the status loop cycles",
            std::string(failure.what()).find("the status loop cycles") != std::string::npos);
    }
  }
}
