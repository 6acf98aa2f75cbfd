#ifndef nodus_solve_secant_acceleration_h
#define nodus_solve_secant_acceleration_h

#include <deal.II/base/mpi.h>

#include <deque>
#include <vector>

namespace Nodus
{
  /// Next value of a fixed-point iteration x -> G(x) by the crossed secant method (Ramiere & Helfer 2015): with the
  /// error f = G(x) - x of two passes,
  ///
  ///     x_next = G - omega f,   omega = (G - G') . (f - f') / |f - f'|^2.
  ///
  /// and x_next = G where that contracts by a factor of 2 at least. A map that contracts, or grows, by one factor in
  /// every direction is solved in one secant, which is what thresholds of friction do along a load path (factor
  /// -mu/slope, theory section 12; eq. L3). Where the error hardly shrinks even so, it has several directions: then the
  /// last secants are combined, x_next = G - sum_i gamma_i dG_i with the gamma that minimise |f - sum_i gamma_i df_i|
  /// (Anderson).
  class SecantAcceleration
  {
  public:
    explicit SecantAcceleration(MPI_Comm communicator)
        : communicator_(communicator)
    {
    }

    /// @p value x and its image @p image G(x), each rank its part. Without a pass before it is G. Collective.
    std::vector<double> next(const std::vector<double> &value, const std::vector<double> &image);

    /// |f| of this pass over that of the one before, 0 in the first pass: < 1 where the iteration contracts.
    double contraction() const
    {
      return contraction_;
    }

  private:
    struct Secant
    {
      std::vector<double> image, error; ///< changes of G and of f
    };
    std::vector<double> combined() const;

    MPI_Comm            communicator_;
    std::deque<Secant>  secants_; ///< the oldest first
    std::vector<double> image_, error_;
    double              contraction_ = 0., norm_ = 0.;
  };
} // namespace Nodus

#endif
