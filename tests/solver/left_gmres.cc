// GMRES with a basis in single precision reaches any tolerance, as each cycle begins with a residual in double
// precision, and goes on until the residual itself is there, not the preconditioned one.

#include "model_problem.h"

#include "solve/block_preconditioner.h"
#include "solve/left_gmres.h"

#include <deal.II/base/conditional_ostream.h>

#include <iostream>

using namespace ModelProblem;

namespace
{
  double relative_residual(const SaddlePointOperator &A, const BlockVector &b, const BlockVector &x)
  {
    BlockVector r(b);
    A.vmult(r, x);
    r.sadd(-1., 1., b);
    return r.l2_norm() / b.l2_norm();
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  dealii::ConditionalOStream out(std::cout, dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);
  const auto                 check = [&](const std::string &what, const bool holds)
  { out << what << ": " << (holds ? "yes" : "NO") << std::endl; };

  Options options;
  options.n_cells = 3;
  TwoCubes                  problem(options);
  const SaddlePointOperator A(problem.system);
  const BlockVector         b = A.scaled(problem.system.rhs);
  BlockVector               x(b), solution, reference;
  make_linear_solver(LinearSolverParameters(), problem.layout, problem.nodes())->solve(problem.system, reference);

  const auto                amg = make_displacement_preconditioner(LinearSolverParameters::Preconditioner::nodus, 3);
  const BlockPreconditioner preconditioner(A, 3., problem.nodes(), *amg);
  const auto                multigrid = [&](BlockVector &z, const BlockVector &r) { preconditioner.vmult(z, r); };
  for (const double tolerance : {1e-4, 1e-8, 1e-13})
  {
    const KrylovReport report = left_gmres(A, multigrid, b, tolerance, 200, x);
    out << "Tolerance " << tolerance << std::endl;
    check("  the residual is below", relative_residual(A, b, x) <= tolerance);
    check("  and what is reported", std::abs(report.residual - relative_residual(A, b, x)) < 1e-15);
    check("  no iterations are lost", report.iterations < 2. * -std::log10(tolerance) + 2.);
  }
  A.to_solution(x, solution);
  check("As the direct solver to 1e-11", difference(solution, reference) < 1e-11);

  const auto         none   = [](BlockVector &z, const BlockVector &r) { z = r; };
  const KrylovReport report = left_gmres(A, none, b, 1e-9, 20000, x);
  check("Without a preconditioner, more than one cycle of 60", report.iterations > 60);
  check("  the residual is below 1e-9", relative_residual(A, b, x) <= 1e-9);

  // What the preconditioner makes small is seen late in the preconditioned residual, whose targets then go down many
  // times.
  const auto hiding = [&](BlockVector &z, const BlockVector &r)
  {
    preconditioner.vmult(z, r);
    for (unsigned int i = 0; i < z.block(0).locally_owned_size(); i += 100)
      z.block(0).local_element(i) *= 1e-6;
  };
  for (const double tolerance : {1e-2, 1e-4})
  {
    const KrylovReport hidden = left_gmres(A, hiding, b, tolerance, 400, x);
    out << "Hidden residuals, tolerance " << tolerance << std::endl;
    check("  the residual is below", relative_residual(A, b, x) <= tolerance);
    check("  and what is reported", std::abs(hidden.residual / relative_residual(A, b, x) - 1.) < 1e-6);
  }

  const KrylovReport cut_off = left_gmres(A, multigrid, b, 1e-13, 7, x);
  check("Cut off after seven iterations", cut_off.iterations == 7);
  check("  the residual says so",
        cut_off.residual > 1e-13 && std::abs(cut_off.residual / relative_residual(A, b, x) - 1.) < 1e-6);
}
