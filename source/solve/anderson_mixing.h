#ifndef nodus_solve_anderson_mixing_h
#define nodus_solve_anderson_mixing_h

#include <mpi.h>

#include <deque>
#include <vector>

namespace Nodus
{
  /// Anderson's mixing for a fixed point x = g(x) (eq. L3), each rank with its part of x. With the last changes dg_i of
  /// the image and df_i of the error f = g(x) - x from pass to pass, the next x is g - sum_i gamma_i dg_i with the
  /// gamma that minimise |f - sum_i gamma_i df_i|. A map that contracts, or grows, by one factor in every direction is
  /// solved in one mixed step, one with n factors in n.
  class AndersonMixing
  {
  public:
    explicit AndersonMixing(MPI_Comm communicator)
        : communicator_(communicator)
    {
    }

    /// Takes a pass in, @p value x and its @p image g(x). Collective.
    void add(const std::vector<double> &value, const std::vector<double> &image);
    /// |f| of the last pass over that of the one before, 0 after the first: < 1 where the iteration contracts.
    double contraction() const
    {
      return contraction_;
    }
    /// The next x by all passes that are kept; g(x) after a single one. Collective.
    std::vector<double> mixed() const;

  private:
    struct Change
    {
      std::vector<double> image, error; ///< dg, df
    };

    MPI_Comm            communicator_;
    std::deque<Change>  changes_; ///< the oldest first
    std::vector<double> image_, error_;
    double              contraction_ = 0., norm_ = -1.; ///< norm_ < 0: there is no pass yet
  };
} // namespace Nodus

#endif
