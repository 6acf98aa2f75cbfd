// What the coarsest level of the multigrid is solved with, on stiffnesses of two cubes: positive and not, dense and,
// with more than 1200 unknowns, sparse, and one that leaves a body free, whose load is in equilibrium.

#include "solve/multigrid/coarse_solver.h"

#include "../numbers.h"
#include "model_problem.h"

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

using namespace Nodus;

namespace
{
  double norm(const std::vector<double> &v)
  {
    double sum = 0.;
    for (const double x : v)
      sum += x * x;
    return std::sqrt(dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD));
  }

  void check(const std::string &title, const ModelProblem::Options &options)
  {
    const ModelProblem::TwoCubes problem(options);
    const BlockCsrMatrix        &K = problem.system.bulk;
    const unsigned int           n = dim * K.map().n_owned();
    std::vector<double>          solution(n), load(n), found(n), product(n);
    for (unsigned int i = 0; i < n; ++i)
      solution[i] = std::cos(3. * (dim * K.map().global(i / dim) + i % dim));
    K.vmult(load.data(), solution.data());
    CoarseSolver(K).solve(load, found);
    K.vmult(product.data(), found.data());
    for (unsigned int i = 0; i < n; ++i)
    {
      product[i] -= load[i];
      found[i] -= solution[i];
    }
    const double error = norm(found) / norm(solution), left = norm(product) / norm(load);
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
      return;
    std::cout << title << ", " << dim * K.map().n_global() << " unknowns:\n  load that is left "
              << Numbers::error_below(left, 1e-8) << '\n';
    if (!options.floating)
      std::cout << "  error of the solution " << Numbers::error_below(error, 1e-8) << '\n';
    std::cout << std::flush;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const unsigned int n_cells : {4, 5})
  {
    ModelProblem::Options options;
    options.n_cells = n_cells;
    check("positive", options);
    options.floating = true;
    check("free", options);
    options.floating = false;
    options.buckles  = true;
    check("not positive", options);
  }
}
