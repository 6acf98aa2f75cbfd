// The direct solver on two cubes in contact: residual, inertia, null pivots, changing patterns, bad input.

#include "model_problem.h"

#include <deal.II/base/conditional_ostream.h>

#include <iostream>
#include <limits>

using namespace Nodus;
using ModelProblem::Options;
using ModelProblem::TwoCubes;

namespace
{
  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  dealii::ConditionalOStream out(std::cout, dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);

  Options base;
  base.tilt            = .5;
  base.threshold_range = 1e6;
  TwoCubes   problem(base);
  const auto solver = make_linear_solver(LinearSolverParameters(), problem.layout, problem.nodes());

  const auto report = [&](const std::string          &title,
                          const Options              &options,
                          const LinearSolver::Report &result,
                          const BlockVector          &x,
                          const TwoCubes             &p)
  {
    out << title << ": residual < 1e-12: " << yes(result.relative_residual < 1e-12)
        << ", one negative pivot for each multiplier: "
        << yes(result.negative_pivots == static_cast<long>(3 * p.layout.n_slave_nodes))
        << ", null pivots: " << result.null_pivots.size() << std::endl;
    out << "  1000 x norms:";
    for (const double norm : ModelProblem::norms(x, options))
      out << ' ' << 1000. * norm;
    out << std::endl;
  };
  out.get_stream().precision(9);

  BlockVector x, y;
  report("Open, slip and stick", base, solver->solve(problem.system, x), x, problem);
  problem.system.rhs *= 2.;
  solver->solve(problem.system, y);
  y *= .5;
  out << "  same pattern again, linear: " << yes(ModelProblem::difference(y, x) < 1e-10) << std::endl;

  Options options    = base;
  options.all_closed = true;
  {
    TwoCubes p(options);
    report("All closed, solver used before", options, solver->solve(p.system, y), y, p);
  }
  options      = base;
  options.unit = 2.1e11;
  {
    TwoCubes p(options);
    report("In other units", options, solver->solve(p.system, y), y, p);
  }
  options                 = base;
  options.stiffness_ratio = 1e-3;
  options.floating        = true;
  {
    TwoCubes p(options);
    report("Soft slave held by contact", options, solver->solve(p.system, y), y, p);
  }
  options            = base;
  options.consistent = true;
  {
    TwoCubes p(options);
    report("Consistent weights", options, solver->solve(p.system, y), y, p);
  }

  options            = base;
  options.all_closed = true;
  options.void_node  = 7;
  {
    TwoCubes   p(options);
    const auto result = solver->solve(p.system, y);
    out << "Void multiplier: residual < 1e-12: " << yes(result.relative_residual < 1e-12)
        << ", null pivots: " << result.null_pivots.size()
        << ", at the multiplier: " << yes(result.null_pivots.size() == 1 && result.null_pivots[0] == p.layout.lambda(7))
        << std::endl;
  }
  options.void_node      = -1;
  options.duplicate_node = 7;
  {
    TwoCubes   p(options);
    const auto result = solver->solve(p.system, y);
    out << "Redundant multiplier: residual < 1e-12: " << yes(result.relative_residual < 1e-12)
        << ", null pivots: " << result.null_pivots.size() << ", at one of the two: "
        << yes(result.null_pivots.size() == 1 &&
               (result.null_pivots[0] == p.layout.lambda(0) || result.null_pivots[0] == p.layout.lambda(7)))
        << std::endl;
  }
  options          = base;
  options.floating = true;
  options.friction = false;
  {
    TwoCubes p(options);
    out << "Body free to slide: null pivots found: " << yes(!solver->solve(p.system, y).null_pivots.empty())
        << std::endl;
  }

  // Bad values on one rank only must stop all of them.
  if (!problem.layout.owned[1].is_empty() && problem.layout.owned[1].is_element(problem.layout.n_slave_nodes - 1))
    for (double &value : problem.system.contact.value)
      value = std::numeric_limits<double>::quiet_NaN();
  try
  {
    solver->solve(problem.system, y);
  }
  catch (const SolverFailure &failure)
  {
    out << failure.what() << std::endl;
  }

  // What was refused had another pattern than what was solved before; what comes next has that pattern.
  report("After that", base, solver->solve(TwoCubes(base).system, y), y, problem);
  y -= x;
  out << "  as before: " << yes(y.l2_norm() < 1e-10 * x.l2_norm()) << std::endl;
}
