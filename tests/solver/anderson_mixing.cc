// Fixed points of linear maps x -> g(x) = x* + A (x - x*) by mixed steps: n directions, each with a factor of its own,
// among them one that a plain iteration cycles with (-1) and some that it runs away from (-2.3, case 62 of the random
// cases; 1.5), take n + 1 mixed steps; without mixing the steps are plain.

#include "solve/anderson_mixing.h"

#include <deal.II/base/utilities.h>

#include <cmath>
#include <iostream>
#include <vector>

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);

  for (const std::vector<double> &factors : {std::vector<double>{-2.3}, {-1.}, {1.5, 0.97}, {-2.3, -1., 0.97, 0.2}})
  {
    const auto            n     = factors.size();
    const auto            owned = dealii::Utilities::MPI::create_evenly_distributed_partitioning(MPI_COMM_WORLD, n);
    Nodus::AndersonMixing mixing;
    Nodus::Vector         error(owned, MPI_COMM_WORLD), correction(owned, MPI_COMM_WORLD);
    for (const auto i : owned)
      error(i) = 1. + i;
    error.compress(dealii::VectorOperation::insert);
    for (unsigned int pass = 0; pass < n + 2; ++pass)
    {
      for (const auto i : owned)
        correction(i) = (factors[i] - 1.) * error(i);
      correction.compress(dealii::VectorOperation::insert);
      const Nodus::Vector &step = mixing.next(correction, pass > 0);
      if (pass == 0)
        correction -= step;
      if (pass == 0 && correction.l2_norm() != 0.)
        std::cout << "the first step is not plain" << std::endl;
      error += step;
    }
    const double norm = error.linfty_norm();
    if (rank == 0)
      std::cout << n << " directions, first factor " << factors[0] << ": error after " << n + 1
                << " mixed steps below 1e-6: " << (norm < 1e-6 ? "yes" : "NO") << std::endl;
  }
}
