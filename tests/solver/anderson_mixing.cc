// Fixed points of linear maps x -> g(x) = x* + A (x - x*) by mixed steps: n directions, each with a factor of its own,
// among them one that a plain iteration cycles with (-1) and some that it runs away from (-1.74, the wedge of theory
// section 12; -2.3, case 62 of the random cases; 1.5), take n mixed steps after a plain one.

#include "solve/anderson_mixing.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <vector>

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       rank  = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int                       ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);

  for (const std::vector<double> &factors :
       {std::vector<double>{-2.3}, {-1.74}, {-1.}, {0.85}, {1.5}, {1.5, 0.97}, {-1.5, -0.5}, {-2.3, -1., 0.97, 0.2}})
  {
    const unsigned int    n = factors.size();
    Nodus::AndersonMixing mixing(MPI_COMM_WORLD);
    std::vector<double>   x; // the parts of all ranks: directions rank, rank + ranks, ...
    std::vector<double>   contractions;
    const auto            solution = [](const unsigned int i) { return 2. + i; };
    for (unsigned int i = rank; i < n; i += ranks)
      x.push_back(1.);
    for (unsigned int pass = 0; pass < n + 1; ++pass)
    {
      std::vector<double> image;
      for (unsigned int l = 0, i = rank; l < x.size(); ++l, i += ranks)
        image.push_back(solution(i) + factors[i] * (x[l] - solution(i)));
      mixing.add(x, image);
      contractions.push_back(mixing.contraction());
      x = mixing.mixed(); // the first one is the image
    }
    double error = 0.;
    for (unsigned int l = 0, i = rank; l < x.size(); ++l, i += ranks)
      error = std::max(error, std::abs(x[l] - solution(i)));
    error = dealii::Utilities::MPI::max(error, MPI_COMM_WORLD);
    if (rank == 0)
      std::cout << n << " directions, first factor " << factors[0] << ": contraction of the plain step "
                << std::setprecision(5) << contractions[1] << ", error after " << n << " mixed steps "
                << (error < 1e-6 ? 0. : error) << std::endl;
  }
}
