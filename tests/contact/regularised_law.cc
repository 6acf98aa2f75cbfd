// Statuses that cycle because sites share multipliers: from there the laws are regularised, and the run finishes where
// no vector of statuses satisfies all sites. A block of 3x3 faces is dragged over 2x2 with friction 1.13 and lifts its
// rear edge: consistent weights against dual ones, which have the same nodal areas.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

namespace
{
  struct Result
  {
    Vector3      force;
    double       tension = 0., beyond_the_cone = 0.; ///< relative to the largest pressure
    unsigned int fallbacks = 0;
  };

  Result run(Parameters p, const double friction)
  {
    p.output.results_folder = "mean_results";
    p.output.vtu_interval   = 0;
    ContactProblem problem(p, world(), log());
    Result         result;
    problem.on_increment([&](unsigned int, double) { result.fallbacks += problem.iterations().fallbacks; });
    problem.run();
    const ContactFields &f       = problem.contact_fields()[0];
    const double         largest = *std::max_element(f.pressure.begin(), f.pressure.end());
    for (unsigned int k = 0; k < f.pressure.size(); ++k)
    {
      result.tension = std::max(result.tension, -f.pressure[k] / largest);
      result.beyond_the_cone =
          std::max(result.beyond_the_cone, (f.friction[k].norm() - friction * f.pressure[k]) / (friction * largest));
    }
    result.force = problem.contact_resultants()[0].slave_force;
    return result;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const double mu = 1.13;
  Parameters   p;
  p.bodies                      = {box("lower", "2,2,2", {-0.65, -0.65, -0.39}, {0.83, 0.65, 0}, 22.8, 0.41),
                                   box("upper", "3,3,2", {-0.5, -0.5, 0}, {0.5, 0.5, 0.5}, 11.9, 0.41)};
  p.boundary_conditions         = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                                   hold("y", region(2, {z_plus}), {1}),
                                   drive("down", region(2, {z_plus}), 2, "-0.0024*min(t,1)"),
                                   drive("along", region(2, {z_plus}), 0, "0.18*max(t-1,0)")};
  p.contact_pairs               = {pair(region(2, {z_minus}), region(1, {z_plus}), mu)};
  p.load_stepping.interval_ends = {1, 2};
  p.load_stepping.increments    = {1, 2};
  auto &contact                 = p.contact_pairs[0];
  contact.weights               = ContactPairParameters::Weights::dual;
  const Result dual             = run(p, mu);

  contact.weights         = ContactPairParameters::Weights::consistent;
  const Result consistent = run(p, mu);
  if (root())
    std::cout << "consistent weights:" << std::endl;
  report("  fallbacks, for the statuses cycle",
         std::to_string(consistent.fallbacks) + ", with dual weights " + std::to_string(dual.fallbacks) +
             (consistent.fallbacks > dual.fallbacks ? "" : ": NO"));
  check("  normal force", consistent.force[2], dual.force[2], 0.01);
  check("  friction", consistent.force[0], dual.force[0], 0.01);
  check("  no tension", consistent.tension < 1e-9);
  check("  no friction beyond the cone", consistent.beyond_the_cone < 1e-5);
}
