#ifndef nodus_tests_solver_iterative_solver_h
#define nodus_tests_solver_iterative_solver_h

#include "model_problem.h"

#include <deal.II/base/conditional_ostream.h>

#include <iostream>
#include <limits>

namespace ModelProblem
{
  inline const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  /// An iterative solver against the direct one, relative @p tolerance, and its iteration counts: they may not depend
  /// on the mesh, the units, the spread of the friction thresholds, the stiffness ratio or the direction of the
  /// normals.
  /// @param not_condensable added to the titles of systems that have to go to the block solver
  inline void
  check_iterative_solver(LinearSolverParameters parameters, const double tolerance, const std::string &not_condensable)
  {
    dealii::ConditionalOStream out(std::cout, dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);

    LinearSolverParameters direct;

    const auto run = [&](const std::string &title,
                         const Options     &options,
                         const unsigned int fewest,
                         const unsigned int most,
                         const bool         compare)
    {
      TwoCubes    problem(options);
      BlockVector x, reference;
      const auto  result = make_linear_solver(parameters, problem.layout, problem.nodes())->solve(problem.system, x);
      out << title << ": iterations between " << fewest << " and " << most << ": ";
      if (result.iterations >= fewest && result.iterations <= most)
        out << "yes";
      else
        out << "NO, " << result.iterations;
      if (compare)
      {
        make_linear_solver(direct, problem.layout, problem.nodes())->solve(problem.system, reference);
        out << ", as direct to " << tolerance << ": " << yes(difference(x, reference) < tolerance);
      }
      out << std::endl;
    };

    Options base;
    base.n_cells = 8;
    run("Open, slip and stick", base, 10, 30, true);
    {
      Options options = base;
      options.n_cells = 16;
      run("Half the mesh size", options, 10, 30, false);
    }
    {
      Options options         = base;
      options.tilt            = .5;
      options.threshold_range = 1e6;
      options.unit            = 2.1e11;
      run("Thresholds over six decades, other units, oblique normals", options, 10, 30, true);
    }
    {
      Options options  = base;
      options.tilt     = .5;
      options.friction = false;
      run("Frictionless", options, 10, 30, true);
    }
    {
      Options options    = base;
      options.all_closed = true;
      options.floating   = true;
      run("Slave held by contact", options, 10, 35, true);
    }
    {
      Options options         = base;
      options.stiffness_ratio = 1e-4;
      run("Soft slave", options, 10, 35, true);
    }
    {
      Options options   = base;
      options.slip_norm = .7;
      run("Slip inside the threshold" + not_condensable, options, 10, 40, true);
    }
    {
      Options options    = base;
      options.consistent = true;
      run("Consistent weights" + not_condensable, options, 20, 70, true);
    }
    {
      Options options    = base;
      options.all_closed = true;
      options.void_node  = 7;
      run("Void multiplier", options, 10, 35, true);
    }
    {
      Options options = base;
      options.buckles = true;
      run("Not positive definite", options, 10, 100, true);
    }

    parameters.maximum_iterations = 3;
    try
    {
      run("Too few iterations allowed", base, 0, 0, false);
    }
    catch (const SolverFailure &failure)
    {
      out << "After three iterations: failure with advice: "
          << yes(std::string(failure.what()).find("'Type = direct'") != std::string::npos) << std::endl;
    }

    TwoCubes problem(base);
    if (!problem.layout.owned[1].is_empty())
      for (double &value : problem.system.contact.value)
        value = std::numeric_limits<double>::quiet_NaN();
    try
    {
      BlockVector x;
      make_linear_solver(parameters, problem.layout, problem.nodes())->solve(problem.system, x);
    }
    catch (const SolverFailure &failure)
    {
      out << failure.what() << std::endl;
    }
  }
} // namespace ModelProblem

#endif
