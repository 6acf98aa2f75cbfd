// An open node beside pressed ones: with consistent weights its neighbours' traction, interpolated, does not vanish
// there, but no part of it acts on the node. The gap alone decides whether it closes, so that statuses and forces
// are those of nodal quadrature. With that share in its test (eq. S2) the node closes
// while the gap is open, pulls, opens again, and so on: the run stops at t = 0.54. A paraboloid (z = r^2/16, 6 cells
// an edge) is pressed into a block.

#include "paraboloid.h"

using namespace Cases;

namespace
{
  struct Path
  {
    std::vector<double> force, closed;
    unsigned int        iterations = 0, fallbacks = 0;
  };

  Path press(Parameters p, const ContactPairParameters::Weights weights)
  {
    p.contact_pairs[0].weights = weights;
    Path           path;
    ContactProblem problem(p, world(), log());
    problem.on_increment(
        [&](const unsigned int, const double)
        {
          const auto &r = problem.contact_resultants()[0];
          path.force.push_back(r.slave_force[2]);
          path.closed.push_back(r.stick + r.slip);
          path.iterations += problem.iterations().newton;
          path.fallbacks += problem.iterations().fallbacks;
        });
    problem.run();
    return path;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Weights = ContactPairParameters::Weights;

  Parameters p            = paraboloid_on_block("0.04");
  p.load_stepping         = {{1.}, {20}};
  p.output.results_folder = "open_beside_pressed_results";

  const Path                             reference = press(p, Weights::nodal_quadrature);
  const std::pair<Weights, const char *> others[]  = {{Weights::dual, "dual"}, {Weights::consistent, "consistent"}};
  for (const auto &[weights, name] : others)
  {
    const Path path  = press(p, weights);
    double     force = 0., closed = 0.;
    for (unsigned int i = 0; i < path.force.size(); ++i)
    {
      force  = std::max(force, std::abs(path.force[i] / reference.force[i] - 1.));
      closed = std::max(closed, std::abs(path.closed[i] - reference.closed[i]));
    }
    if (root())
      std::cout << name << ", closed nodes at the end " << path.closed.back() << std::endl;
    check_error("  force, that of nodal quadrature", force, 1e-8);
    check_error("  number of closed nodes, of every increment, that of nodal quadrature", closed, 0.5);
    check_count("  fallbacks", path.fallbacks, 0);
    check_count("  iterations beyond those of nodal quadrature", path.iterations - reference.iterations, 20);
  }
}
