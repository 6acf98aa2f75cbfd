// The largest absolute value of a vector on all ranks: it is infinite where a number is none, on any rank and at any
// place, so that no iterate of that kind passes for a solution.

#include "parallel/largest.h"

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <iostream>
#include <limits>

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int                       n    = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  dealii::IndexSet                         owned(4 * n);
  owned.add_range(4 * rank, 4 * rank + 4);
  Nodus::Vector v(owned, MPI_COMM_WORLD);
  const auto    print = [&](const std::string &what)
  {
    const double largest = Nodus::largest_entry(v);
    if (rank == 0)
      std::cout << what << ": " << largest << std::endl;
  };
  print("zeros");
  for (const auto i : owned)
    v(i) = i % 2 == 0 ? 1. : -3.;
  v.compress(dealii::VectorOperation::insert);
  print("1 and -3");
  for (const unsigned int place : {0u, 2u, 3u})
    for (const double number : {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()})
    {
      if (rank == n - 1)
        v(4 * rank + place) = number;
      v.compress(dealii::VectorOperation::insert);
      print("the last rank has " + std::to_string(number) + " at " + std::to_string(place));
      if (rank == n - 1)
        v(4 * rank + place) = 1.;
      v.compress(dealii::VectorOperation::insert);
    }
}
