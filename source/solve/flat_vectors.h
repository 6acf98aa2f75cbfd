#ifndef nodus_solve_flat_vectors_h
#define nodus_solve_flat_vectors_h

#include "solve/linear_system.h"

#include <vector>

namespace Nodus
{
  /// Vectors of all unknowns of a system in full length on every rank, multipliers after the displacements in the order
  /// of the blocks, in the units of the equilibrated system: row and column i times scale(i).
  class FlatVectors
  {
  public:
    /// Of @p system, whose layout outlives it. Collective.
    explicit FlatVectors(const LinearSystem &system);

    double scale(const DoFIndex i) const
    {
      return i < n_u_ ? 1. : scale_[i - n_u_];
    }

    /// Of a distributed vector. Collective.
    std::vector<double> flatten(const BlockVector &v) const;
    /// The way back; @p v is reinitialised. Collective.
    void unflatten(const std::vector<double> &x, BlockVector &v) const;

  private:
    template <typename Function>
    void for_owned(const Function &f) const;

    const BlockLayout  &layout_;
    DoFIndex            n_u_;
    std::vector<double> scale_; ///< of all multipliers
  };
} // namespace Nodus

#endif
