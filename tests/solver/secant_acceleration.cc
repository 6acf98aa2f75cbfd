// Fixed points of linear maps x -> a + k x by crossed secants: one secant solves any factor k in its bounds, those that
// a plain iteration cycles with (-1) or runs away from (-1.74, the wedge of theory section 12; 1.5) included; with two
// factors the error still falls. Where a plain iteration contracts by 2 it is left alone.

#include "solve/secant_acceleration.h"

#include <deal.II/base/utilities.h>

#include <cmath>
#include <iostream>

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int                       n    = rank == 0 ? 3 : 2; // the norms are those of all ranks

  for (const double k : {-1.74, -1., -0.6, 0., 0.6, 0.85, 1.5})
  {
    Nodus::SecantAcceleration secant(MPI_COMM_WORLD);
    std::vector<double>       x(n, 0.), image(n);
    double                    error = 0.;
    for (unsigned int pass = 0; pass < 3; ++pass)
    {
      error = 0.;
      for (unsigned int i = 0; i < n; ++i)
      {
        image[i] = (i + 1.) + k * x[i];
        error    = std::max(error, std::abs(x[i] - (i + 1.) / (1. - k)));
      }
      x = secant.next(x, image);
    }
    error = dealii::Utilities::MPI::max(error, MPI_COMM_WORLD);
    if (rank == 0)
      std::cout << "factor " << k << ": error after one secant below 1e-12: " << (error < 1e-12 ? "yes" : "NO")
                << std::endl;
  }

  {
    Nodus::SecantAcceleration plain(MPI_COMM_WORLD);
    std::vector<double>       x(1, 0.);
    for (unsigned int pass = 0; pass < 3; ++pass)
      x = plain.next(x, {1. - 0.3 * x[0]});
    if (rank == 0)
      std::cout << "factor -0.3: plain: " << (std::abs(x[0] - (1. - 0.3 + 0.09)) < 1e-14 ? "yes" : "NO") << std::endl;
  }

  Nodus::SecantAcceleration secant(MPI_COMM_WORLD);
  std::vector<double>       x(2, 0.);
  unsigned int              passes = 0;
  for (; passes < 30; ++passes)
  {
    const std::vector<double> image = {1. - 1.5 * x[0], 2. - 0.5 * x[1]};
    const double              error = std::max(std::abs(x[0] - 0.4), std::abs(x[1] - 4. / 3.));
    if (error < 1e-8)
      break;
    x = secant.next(x, image);
  }
  if (rank == 0)
    std::cout << "factors -1.5 and -0.5 together, 1e-8 in less than 15 passes: " << (passes < 15 ? "yes" : "NO")
              << std::endl;
}
