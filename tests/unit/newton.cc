// Newton and the loop record alone, without physics: a 2 x 2 system x^2 + y^2 = 4, x y = 1 (solution
// x = (sqrt 6 + sqrt 2)/2, y = 1/x) converges quadratically; failures throw; a step into inverted cells is halved, and
// so is, with line search, one that does not decrease the largest residual; any other failure goes up after one trial,
// and of a trial that is rejected nothing is left; progress is measured from the first correction on. Newton's iterates
// for arctan(x) = 0 go away from 0 by themselves from 1.4 on (1.5, -1.69, 2.32, -5.11, ...): the steps are halved once
// they have, but not while choices change. The tangent of an iterate that is expected to be the last one waits: one
// that converges quadratically ends there, one that gains two digits each time goes on once. Where the next to last
// iterate is close to the end the tangent before will do: x^2 = 2 takes as many iterations with it.

#include "solve/newton.h"
#include "run/fixed_point_loop.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/la_parallel_block_vector.h>

#include <cmath>
#include <iostream>

using namespace Nodus;

namespace
{
  struct TwoByTwo : public NewtonProblem
  {
    double              x, y, from_x = 0., from_y = 0.;
    double              domain; ///< evaluate() fails for x above it
    SolverFailure::Kind kind   = SolverFailure::Kind::inverted_cell;
    unsigned int        trials = 0, accepted = 0;
    TwoByTwo(const double x0, const double y0, const double upper = 1e9)
        : x(x0)
        , y(y0)
        , domain(upper)
    {
    }
    double force() const
    {
      return std::abs(x * x + y * y - 4);
    }
    Norms norms() const
    {
      Norms norms;
      norms.force   = force();
      norms.contact = std::abs(x * y - 1);
      return norms;
    }
    Norms evaluate(const bool measure, bool) override
    {
      ++trials;
      if (x > domain)
        throw SolverFailure("outside the domain", kind);
      return measure ? norms() : Norms();
    }
    Norms accept(unsigned int) override
    {
      ++accepted;
      return norms();
    }
    unsigned int solve(BlockVector &correction, double, bool) override
    {
      const double     r0 = 4 - x * x - y * y, r1 = 1 - x * y, det = 2 * x * x - 2 * y * y;
      dealii::IndexSet all(2);
      all.add_range(0, 2);
      correction             = BlockVector(std::vector<dealii::IndexSet>{all}, MPI_COMM_WORLD);
      correction.block(0)(0) = (x * r0 - 2 * y * r1) / det;
      correction.block(0)(1) = (-y * r0 + 2 * x * r1) / det;
      from_x                 = x;
      from_y                 = y;
      return 3;
    }
    void move(const double factor, const BlockVector &correction) override
    {
      x = from_x + factor * correction.block(0)(0);
      y = from_y + factor * correction.block(0)(1);
    }
  };

  /// Starts close to a solution, from where a change leads far away; residuals then fall by @p factor from @p first.
  struct Returning : public NewtonProblem
  {
    double       factor, first;
    unsigned int assembled = 0;
    explicit Returning(const double f, const double first_residual = 1.)
        : factor(f)
        , first(first_residual)
    {
    }
    Norms evaluate(bool, bool) override
    {
      return {};
    }
    Norms accept(unsigned int) override
    {
      Norms norms;
      norms.force   = assembled == 0 ? 1e-3 : first * std::pow(factor, assembled);
      norms.changes = assembled == 0 ? 0 : 1;
      if (norms.force < 1e-12)
        norms.changes = 0;
      ++assembled;
      return norms;
    }
    unsigned int solve(BlockVector &, double, bool) override
    {
      return 0;
    }
    void move(double, const BlockVector &) override
    {
    }
  };

  /// arctan(x) = 0.
  struct Arctan : public NewtonProblem
  {
    double       x = 1.5, from = 0.;
    unsigned int trials = 0, changes = 0; ///< changes: of every iterate
    Norms        norms() const
    {
      Norms norms;
      norms.force = std::abs(std::atan(x));
      return norms;
    }
    Norms evaluate(bool, bool) override
    {
      ++trials;
      return norms();
    }
    Norms accept(unsigned int) override
    {
      Norms result   = norms();
      result.changes = changes;
      return result;
    }
    unsigned int solve(BlockVector &correction, double, bool) override
    {
      dealii::IndexSet all(1);
      all.add_range(0, 1);
      correction             = BlockVector(std::vector<dealii::IndexSet>{all}, MPI_COMM_WORLD);
      correction.block(0)(0) = -std::atan(x) * (1 + x * x);
      from                   = x;
      return 0;
    }
    void move(const double factor, const BlockVector &correction) override
    {
      x = from + factor * correction.block(0)(0);
    }
  };

  /// Residuals that fall by two digits with each correction.
  struct TwoDigits : public NewtonProblem
  {
    double       residual = 5e-4;
    bool         waits    = false;    ///< the tangent
    unsigned int late = 0, never = 0; ///< tangents
    Norms        evaluate(bool, const bool last) override
    {
      waits = last;
      never += last;
      return {};
    }
    Norms accept(unsigned int) override
    {
      Norms norms;
      norms.force = residual;
      return norms;
    }
    unsigned int solve(BlockVector &, double, bool) override
    {
      late += waits;
      never -= waits;
      return 0;
    }
    void move(double, const BlockVector &) override
    {
      residual *= 1e-2;
    }
  };

  /// x^2 = 2.
  struct Square : public NewtonProblem
  {
    double       x = 2., from = 0., slope = 0.;
    unsigned int kept = 0; ///< slopes
    Norms        evaluate(bool, bool) override
    {
      return {};
    }
    Norms accept(unsigned int) override
    {
      Norms norms;
      norms.force = std::abs(x * x - 2.);
      return norms;
    }
    unsigned int solve(BlockVector &correction, double, const bool again) override
    {
      kept += again;
      slope = again ? slope : 2. * x;
      dealii::IndexSet all(1);
      all.add_range(0, 1);
      correction             = BlockVector(std::vector<dealii::IndexSet>{all}, MPI_COMM_WORLD);
      correction.block(0)(0) = (2. - x * x) / slope;
      from                   = x;
      return 0;
    }
    void move(const double factor, const BlockVector &correction) override
    {
      x = from + factor * correction.block(0)(0);
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

  TwoDigits two_digits;
  report = Newton(parameters).solve(two_digits, none);
  std::cout << "two digits each: iterations " << report.iterations << ", tangents late " << two_digits.late
            << ", never " << two_digits.never << std::endl;

  Square square;
  report = Newton(parameters).solve(square, none);
  std::cout << "root of 2: iterations " << report.iterations << ", tangents kept " << square.kept << ", error < 1e-12 "
            << (std::abs(square.x - std::sqrt(2.)) < 1e-12) << std::endl;

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

  // The full first step from here leaves the domain, x = 4.6; half of it does not.
  parameters.maximum_iterations = 25;
  TwoByTwo narrow(0.5, 0.3, 3);
  report = Newton(parameters).solve(narrow, none);
  std::cout << "inside the domain: " << (narrow.x < 3) << ", solution " << (std::abs(narrow.x - exact) < 1e-12)
            << std::endl;

  std::cout << "trials " << narrow.trials << ", accepted " << narrow.accepted << std::endl;

  // No halved step can cure another failure: it goes up after its first trial.
  TwoByTwo other(0.5, 0.3, 3);
  other.kind = SolverFailure::Kind::status_cycle;
  try
  {
    Newton(parameters).solve(other, none);
    std::cout << "no failure" << std::endl;
  }
  catch (const SolverFailure &failure)
  {
    std::cout << failure.what() << " after " << other.trials << " trials, accepted " << other.accepted << std::endl;
  }

  // The first correction from here overshoots: the full step has force residual 17.6, half of it 2.6, the start 3.7.
  parameters.line_search = true;
  TwoByTwo searched(0.5, 0.3);
  report = Newton(parameters).solve(searched, none);
  std::cout << "with line search: iterations " << report.iterations << ", trials " << searched.trials << ", x "
            << searched.x << std::endl;

  // Here forces balance, as where a status has just changed: the full step, which solves the other equation, has a
  // force residual of 0.25, and so is not halved.
  TwoByTwo balanced(2, 0);
  report = Newton(parameters).solve(balanced, none);
  std::cout << "from balanced forces: iterations " << report.iterations << ", trials " << balanced.trials << std::endl;
  parameters.line_search = false;

  for (const unsigned int changes : {0, 1})
  {
    Arctan away;
    away.changes = changes;
    try
    {
      report = Newton(parameters).solve(away, none);
      std::cout << "away: iterations " << report.iterations << ", trials " << away.trials << ", |x| < 1e-12 "
                << (std::abs(away.x) < 1e-12) << std::endl;
    }
    catch (const SolverFailure &failure)
    {
      std::cout << "away, with changes: " << std::string(failure.what()).substr(0, 24) << std::endl;
    }
  }

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

  // What was never near balance is lost, and halved at once; other remedies are for what comes half-way.
  for (const double first : {0.6, 0.4})
    try
    {
      Returning stalls(1., first);
      Newton(parameters, 2).solve(stalls, none);
    }
    catch (const SolverFailure &failure)
    {
      std::cout << first << " out of balance: " << (failure.kind() == SolverFailure::Kind::newton_lost ? "lost" : "")
                << (failure.kind() == SolverFailure::Kind::newton_stalled ? "stalled" : "") << std::endl;
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
