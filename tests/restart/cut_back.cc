// An increment that fails leaves nothing behind: a run that is cut back is the run that takes the same small increments
// from the start.

#include "sliding_block.h"

#include <deal.II/base/mpi.h>

using namespace SlidingBlock;

namespace
{
  Outcome run(const Parameters &p)
  {
    ContactProblem      problem(p, world(), log());
    std::vector<double> times;
    problem.on_increment([&](unsigned int, double t) { times.push_back(t); });
    problem.run();
    return outcome(problem, times);
  }

  void compare(const std::string &name, Parameters p)
  {
    p.load_stepping.interval_ends     = {0.5, 1.};
    p.load_stepping.increments        = {1, 1};
    p.load_stepping.minimum_increment = 1e-3;
    p.load_stepping.predictor         = false; // each of the small increments is an interval, and goes on along nothing
    const Outcome cut                 = run(p);

    p.load_stepping.interval_ends = cut.times;
    p.load_stepping.increments.assign(cut.times.size(), 1);
    p.load_stepping.cut_back = false;
    const Outcome direct     = run(p);

    const auto at = [&](const double t) { return std::count(cut.times.begin(), cut.times.end(), t) == 1; };
    check(name + ": cut back, and the times asked for are met", cut.times.size() > 2 && at(0.5) && at(1.));
    report("  increments", std::to_string(cut.times.size()));
    check("  force at the end", force(cut), force(direct), 1e-12);
    check("  the small increments alone: the same to 1e-12", difference(cut, direct) <= 1e-12);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Parameters p     = SlidingBlock::parameters("cut_back_results");
  auto       loops = p;

  // nor can three loops help while their geometry does not converge in three passes
  p.newton.maximum_iterations    = 5;
  p.geometry_loop.maximum_passes = 3;
  compare("merged loops", p);

  use_loops(loops);
  loops.newton.maximum_iterations     = 4;
  loops.threshold_loop.maximum_passes = 8;
  compare("three loops", loops);

  auto points                      = p;
  points.contact_pairs[0].scheme   = ContactPairParameters::Scheme::integration_point;
  points.newton.maximum_iterations = 6;
  compare("integration points", points);

  auto averaged                      = p;
  averaged.contact_pairs[0].scheme   = ContactPairParameters::Scheme::averaged;
  averaged.contact_pairs[0].surface  = ContactPairParameters::Surface::smoothed;
  averaged.contact_pairs[0].normal   = ContactPairParameters::Normal::averaged;
  averaged.newton.maximum_iterations = 4;
  compare("averaged jumps", averaged);

  Parameters driven = SlidingBlock::driven("cut_back_results");
  use_loops(driven);
  driven.newton.maximum_iterations       = 4;
  driven.bodies[1].motion.translation[0] = "0.5*sin(3*t)";
  compare("rigid body driven by force and moment", driven);
}
