#ifndef nodus_parallel_largest_h
#define nodus_parallel_largest_h

#include <nodus/base/types.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Nodus
{
  /// The largest absolute value of numbers: infinity where one of them is none. Norms of vectors and std::max() pass
  /// over those.
  class Largest
  {
  public:
    void add(const double number)
    {
      value_ = std::isfinite(number) ? std::max(value_, std::abs(number)) : std::numeric_limits<double>::infinity();
    }
    /// Collective.
    double on_all_ranks(const MPI_Comm communicator) const
    {
      return dealii::Utilities::MPI::max(value_, communicator);
    }

  private:
    double value_ = 0.;
  };

  /// Of the entries of a vector. Collective.
  inline double largest_entry(const Vector &v)
  {
    Largest             largest;
    const double *const values = v.begin();
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      largest.add(values[i]);
    return largest.on_all_ranks(v.get_mpi_communicator());
  }
} // namespace Nodus

#endif
