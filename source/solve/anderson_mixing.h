#ifndef nodus_solve_anderson_mixing_h
#define nodus_solve_anderson_mixing_h

#include <nodus/base/types.h>

#include <deal.II/lac/trilinos_vector.h>

#include <deque>
#include <utility>

namespace Nodus
{
  /// Anderson's mixing for a fixed point x = g(x) of displacements (eq. L4). With the last steps s_i and the changes
  /// y_i of the correction d = g(x) - x that they brought about, the next step is d - sum_i gamma_i (s_i + y_i) with
  /// the gamma that minimise |d - sum_i gamma_i y_i|: the secant method where errors have one direction.
  class AndersonMixing
  {
  public:
    /// The step from here, where the correction is @p correction: that itself, or mixed with those before if @p mix.
    /// The next call is for the place where it leads. Collective.
    const Vector &next(const Vector &correction, bool mix);

  private:
    Vector                                step_, correction_;
    std::deque<std::pair<Vector, Vector>> pairs_; ///< steps and changes of the correction, the oldest first
  };
} // namespace Nodus

#endif
