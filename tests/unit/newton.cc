// Newton and the loop record alone, without physics: a 2 x 2 system x^2 + y^2 = 4, x y = 1 (solution
// x = (sqrt 6 + sqrt 2)/2, y = 1/x) converges quadratically; failures throw; a step out of the domain is halved;
// progress is measured from the first correction on.

#include "solve/newton.h"
#include "run/fixed_point_loop.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_parallel_block_vector.h>

#include <cmath>
#include <iostream>

using namespace Nodus;

namespace
{
  struct TwoByTwo : public NewtonProblem
  {
    double x, y;
    double domain; ///< assemble() fails for x below it
    TwoByTwo(const double x0, const double y0, const double lower = -1e9)
        : x(x0)
        , y(y0)
        , domain(lower)
    {
    }
    Norms assemble() override
    {
      if (x < domain)
        throw SolverFailure("outside the domain");
      Norms norms;
      norms.force   = std::abs(x * x + y * y - 4);
      norms.contact = std::abs(x * y - 1);
      return norms;
    }
    unsigned int solve(BlockVector &correction, double) override
    {
      const double     r0 = 4 - x * x - y * y, r1 = 1 - x * y, det = 2 * x * x - 2 * y * y;
      dealii::IndexSet all(2);
      all.add_range(0, 2);
      correction.reinit(std::vector<dealii::IndexSet>{all}, MPI_COMM_WORLD);
      correction.block(0)(0) = (x * r0 - 2 * y * r1) / det;
      correction.block(0)(1) = (-y * r0 + 2 * x * r1) / det;
      return 3;
    }
    void advance(const double factor, const BlockVector &correction) override
    {
      x += factor * correction.block(0)(0);
      y += factor * correction.block(0)(1);
    }
  };

  /// Starts close to a solution, from where a change leads far away; residuals then fall by @p factor.
  struct Returning : public NewtonProblem
  {
    double       factor;
    unsigned int assembled = 0;
    explicit Returning(const double f)
        : factor(f)
    {
    }
    Norms assemble() override
    {
      Norms norms;
      norms.force   = assembled == 0 ? 1e-3 : std::pow(factor, assembled);
      norms.changes = assembled == 0 ? 0 : 1;
      if (norms.force < 1e-12)
        norms.changes = 0;
      ++assembled;
      return norms;
    }
    unsigned int solve(BlockVector &, double) override
    {
      return 0;
    }
    void advance(double, const BlockVector &) override
    {
    }
  };

  void none(unsigned int, const NewtonProblem::Norms &, unsigned int)
  {
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  NewtonParameters                         parameters;
  parameters.force_tolerance = parameters.contact_tolerance = 1e-12;

  TwoByTwo     problem(2, 0.3);
  const double exact  = (std::sqrt(6.) + std::sqrt(2.)) / 2;
  auto         report = Newton(parameters).solve(problem, none);
  std::cout << "solution to 1e-12: " << (std::abs(problem.x - exact) + std::abs(problem.y - 1 / exact) < 1e-12)
            << std::endl;
  std::cout << "iterations " << report.iterations << ", Krylov iterations " << report.krylov_iterations << std::endl;

  report = Newton(parameters).solve(problem, none);
  std::cout << "from the solution, iterations " << report.iterations << std::endl;

  parameters.maximum_iterations = 2;
  TwoByTwo far(20, 0.1);
  try
  {
    Newton(parameters).solve(far, none);
    std::cout << "no failure" << std::endl;
  }
  catch (const SolverFailure &failure)
  {
    std::cout << std::string(failure.what()).substr(0, 42) << std::endl;
  }

  // The full first step from here leaves the domain; halved steps get through.
  parameters.maximum_iterations = 25;
  TwoByTwo narrow(4, 0.2, 1.9);
  report = Newton(parameters).solve(narrow, none);
  std::cout << "inside the domain: " << (narrow.x > 1.9) << ", solution " << (std::abs(narrow.x - exact) < 1e-12)
            << std::endl;

  for (const double factor : {0.05, 1.})
    try
    {
      Returning returning(factor);
      std::cout << "iterations with patience 2: " << Newton(parameters, 2).solve(returning, none).iterations
                << std::endl;
    }
    catch (const SolverFailure &failure)
    {
      std::cout << failure.what() << std::endl;
    }

  FixedPointLoop loop("status", {3, 0.});
  std::cout << "loop: " << loop.finished(2, "") << loop.finished(1, "") << " passes " << loop.counter() << std::endl;
  try
  {
    loop.finished(1, "node (0 0 0)");
  }
  catch (const SolverFailure &failure)
  {
    std::cout << failure.what() << std::endl;
  }
}
