#ifndef nodus_tests_solver_same_answers_h
#define nodus_tests_solver_same_answers_h

#include "../cases.h"

#include <deal.II/base/mpi.h>

namespace SameAnswers
{
  using namespace Cases;
  using Preconditioner = LinearSolverParameters::Preconditioner;
  using Solver         = LinearSolverParameters::Type;

  /// Two blocks with hanging nodes on both surfaces between them; a rigid plate presses the upper one, which is
  /// held at one side, with a given force. Friction on both sides of it.
  inline Parameters pressed_block()
  {
    Parameters p;
    p.bodies = {box("lower", "3,3,2", {0, 0, 0}, {1.2, 1, 0.6}, 1000, 0.3),
                box("upper", "2,2,2", {0.2, 0.1, 0.6}, {0.9, 0.8, 1.1}, 500, 0.4),
                box("plate", "2,1,1", {0, 0, 1.1}, {1.2, 1, 1.3}, 0, 0)};
    for (const unsigned int body : {0, 1})
    {
      p.bodies[body].material.law     = MaterialParameters::Law::neo_hookean;
      p.bodies[body].local_refinement = 1;
      p.bodies[body].refine_where     = "(x-0.6)*(x-0.6)+(y-0.5)*(y-0.5)+(z-0.6)*(z-0.6)<0.09";
    }
    p.bodies[2].material    = MaterialParameters();
    p.bodies[2].rigid       = true;
    p.bodies[2].rigid_free  = {2};
    p.bodies[2].rigid_force = {"0", "0", "-10*t"};
    p.boundary_conditions   = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                               hold("side", region(2, {x_minus}, "z>0.7"), {0, 1})};
    p.contact_pairs         = {pair(region(2, {z_minus}), region(1, {z_plus}), 0.4),
                               pair(region(2, {z_plus}), region(3, {z_minus}), 0.3)};
    for (auto &pair : p.contact_pairs)
    {
      pair.scheme       = ContactPairParameters::Scheme::averaged;
      pair.start.status = ContactPairParameters::InitialStatus::closed;
    }
    p.load_stepping               = {{1.}, {2}};
    p.newton.force_tolerance      = 1e-11;
    p.newton.largest_forcing_term = 0.;
    p.linear_solver.tolerance     = 1e-12;
    p.strategy.without            = {"direct solver"};
    p.output.write_vtu            = false;
    return p;
  }

  struct Answer
  {
    Vector3      forces[2], displacement;
    unsigned int slip, iterations, newton;
  };

  inline Answer run(const Solver solver, const Preconditioner preconditioner)
  {
    Parameters p                   = pressed_block();
    p.linear_solver.type           = solver;
    p.linear_solver.preconditioner = preconditioner;
    p.output.results_folder        = "same_answers_results";
    ContactProblem problem(p, world(), log());
    problem.run();
    Answer answer;
    answer.slip = 0;
    for (const unsigned int k : {0, 1})
    {
      answer.forces[k] = problem.contact_resultants()[k].slave_force;
      answer.slip += problem.contact_resultants()[k].slip;
    }
    answer.displacement = problem.displacement(2, {0.9, 0.8, 1.1});
    answer.iterations   = problem.iterations().krylov;
    answer.newton       = problem.iterations().newton;
    return answer;
  }

  /// Forces, displacements and statuses of both iterative solvers with the multigrid @p other are those with nodus's
  /// own.
  inline void compare(const Preconditioner other)
  {
    for (const Solver solver : {Solver::condensed, Solver::block})
    {
      const Answer own = run(solver, Preconditioner::nodus), theirs = run(solver, other);
      report(text_of(solver) + " solver", text_of(other) + " against nodus");
      check("  force between the blocks", theirs.forces[0], own.forces[0], 1e-9);
      check("  force of the rigid plate", theirs.forces[1], own.forces[1], 1e-9);
      check("  displacement", theirs.displacement, own.displacement, 1e-9);
      check_equal("  nodes that slip", theirs.slip, own.slip);
      check("  as many Newton iterations", theirs.newton == own.newton);
      check("  Krylov iterations: at most twice as many", theirs.iterations <= 2 * own.iterations);
      if (root() && std::getenv("NODUS_TEST_LOG") != nullptr)
        std::cout << "    " << own.iterations << " and " << theirs.iterations << " in " << own.newton << std::endl;
    }
  }
} // namespace SameAnswers

#endif
