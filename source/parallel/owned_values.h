#ifndef nodus_parallel_owned_values_h
#define nodus_parallel_owned_values_h

#include <nodus/base/types.h>

#include <deal.II/lac/la_parallel_vector.h>

namespace Nodus
{
  /// The values of a vector that this rank owns, by global index: one memory access, and nothing is left to
  /// compress(), which is collective.
  class OwnedValues
  {
  public:
    explicit OwnedValues(Vector &v)
        : values_(v.begin())
        , first_(v.get_partitioner()->local_range().first)
    {
    }
    double &operator()(const DoFIndex i) const
    {
      return values_[i - first_];
    }

  private:
    double  *values_;
    DoFIndex first_;
  };
} // namespace Nodus

#endif
