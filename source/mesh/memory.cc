#include "mesh/memory.h"
#include <nodus/base/types.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <sstream>
#include <unistd.h>

namespace Nodus
{
  namespace
  {
    constexpr double bytes_per_displacement = 2e3, gigabyte = 1e9;

    /// Of all machines that have a rank, in bytes; each machine's first rank speaks for it.
    double physical_memory(const MPI_Comm communicator)
    {
      MPI_Comm machine;
      MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
      const bool   first = dealii::Utilities::MPI::this_mpi_process(machine) == 0;
      const double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
      MPI_Comm_free(&machine);
      return dealii::Utilities::MPI::sum(first ? bytes : 0., communicator);
    }
  } // namespace

  void refuse_beyond_memory(const double n_cells, const unsigned int degree, const MPI_Comm communicator)
  {
    const double displacements = dim * std::pow(degree, dim) * n_cells;
    const double needed = bytes_per_displacement * displacements, there = physical_memory(communicator);
    if (needed <= there)
      return;
    std::ostringstream text;
    text.precision(3);
    text << "the mesh would have " << n_cells << " cells, with elements of degree " << degree << " some "
         << displacements << " displacements, which take about " << needed / gigabyte
         << " GB to solve for, more than the " << std::round(there / gigabyte)
         << " GB that there are; refine less, or take more machines";
    throw InputError(text.str());
  }
} // namespace Nodus
