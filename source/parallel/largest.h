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

  /// Makes @p value, which @p site of this rank has, the largest of all ranks; on the others @p site becomes invalid.
  /// Collective.
  inline void keep_largest(double &value, unsigned int &site, const MPI_Comm communicator)
  {
    const auto all = dealii::Utilities::MPI::min_max_avg(value, communicator);
    if (all.max_index != dealii::Utilities::MPI::this_mpi_process(communicator))
      site = dealii::numbers::invalid_unsigned_int;
    value = all.max;
  }

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
