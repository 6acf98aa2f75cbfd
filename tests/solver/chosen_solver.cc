// Type = automatic with a model of 2565 displacements: the condensed solver begins, and keeps the systems where it
// costs less by its own count than the direct one would by its symbolic analysis. Where it does not, because it takes
// many iterations, the direct solver gets them as soon as that is known; where the direct one cannot be the cheaper of
// the two it is not analysed. An increment that was cut back goes to the direct solver; so does what the condensed one
// cannot solve, and the answers are those of the direct solver in any case.

#include "solve/chosen_solver.h"
#include "model_problem.h"
#include "solve/direct_solver.h"

#include <deal.II/base/conditional_ostream.h>
#include <deal.II/base/mpi.h>

#include <cmath>
#include <iostream>

using namespace Nodus;
using Type = LinearSolverParameters::Type;

namespace
{
  constexpr unsigned int n_systems = 12;

  class Run
  {
  public:
    Run(const ModelProblem::TwoCubes &problem, const unsigned int maximum_iterations)
        : problem_(problem)
        , solver_(parameters(maximum_iterations), true, problem.layout, problem.node_positions, profile_, {})
    {
    }
    /// @returns a letter for what solved each of some systems
    std::string solve(const double tolerance, const bool cut_back = false)
    {
      std::string letters;
      solver_.begin_increment(cut_back);
      for (unsigned int n = 0; n < n_systems; ++n)
      {
        const auto report = solver_.solve(problem_.system, solution, tolerance);
        letters += solver_.type() == Type::direct ? 'd' : 'c';
        (solver_.type() == Type::direct ? direct_work : condensed_work) = report.work;
      }
      return letters;
    }

    /// Hierarchies, condensations, analyses and factorisations so far.
    unsigned int set_ups()
    {
      return profile_.report(problem_.layout.n_u, true, MPI_COMM_WORLD)
          .phases[static_cast<unsigned int>(Phase::solver_set_up)]
          .calls;
    }

    BlockVector solution;
    double      direct_work = 0., condensed_work = 0.;

  private:
    static Parameters parameters(const unsigned int maximum_iterations)
    {
      Parameters p;
      p.linear_solver.type               = Type::automatic;
      p.linear_solver.maximum_iterations = maximum_iterations;
      return p;
    }

    const ModelProblem::TwoCubes &problem_;
    Profile                       profile_;
    ChosenSolver                  solver_;
  };
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  dealii::ConditionalOStream out(std::cout, dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);

  ModelProblem::Options options;
  options.n_cells = 6;
  const ModelProblem::TwoCubes problem(options);
  out << "displacements: " << problem.layout.n_u << std::endl;

  BlockVector  reference;
  DirectSolver direct(problem.layout);
  const double estimate = direct.estimate(problem.system);
  const double work     = direct.solve(problem.system, reference).work;
  out << "work of the direct solver within 2 % of its estimate: " << (std::abs(work / estimate - 1.) < 0.02)
      << std::endl;
  const auto difference = [&](BlockVector x)
  {
    x -= reference;
    return x.l2_norm() / reference.l2_norm();
  };

  Run coarse(problem, 500), fine(problem, 500), failing(problem, 1);
  out << "tolerance 1e-2: " << coarse.solve(1e-2) << std::endl;
  out << "cut back: " << coarse.solve(1e-2, true) << std::endl;
  out << "the next increment: " << coarse.solve(1e-2) << std::endl;
  out << "condensed costs less: " << (coarse.condensed_work < work) << std::endl;
  out << "tolerance 1e-10: " << fine.solve(1e-10) << std::endl;
  // a condensation for each system and one hierarchy
  out << "condensed costs less than the direct solver at least: "
      << (fine.condensed_work < DirectSolver::least_work(problem.system).solve)
      << ", and that is not analysed: " << fine.set_ups() << " set-ups" << std::endl;
  out << "condensed costs less: " << (fine.condensed_work < work) << std::endl;
  out << "difference below 1e-8: " << (difference(fine.solution) < 1e-8) << std::endl;
  out << "one iteration allowed: " << failing.solve(1e-10) << std::endl;
  out << "difference below 1e-10: " << (difference(failing.solution) < 1e-10) << std::endl;

  options.slip_norm       = .3;
  options.threshold_range = 1e4;
  const ModelProblem::TwoCubes hard(options);
  Run                          many(hard, 500);
  out << "many iterations: " << many.solve(1e-10) << std::endl;
  out << "condensed costs less: " << (many.condensed_work < many.direct_work) << std::endl;
}
