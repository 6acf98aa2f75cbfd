#ifndef nodus_run_fixed_point_loop_h
#define nodus_run_fixed_point_loop_h

#include <nodus/parameters/parameters.h>

#include <string>

namespace Nodus
{
  /// Record of one of the nested loops: counter, criterion, and where it is worst.
  class FixedPointLoop
  {
  public:
    FixedPointLoop(const std::string &name, const LoopParameters &parameters);

    /// Counts a pass that ended with @p value of the criterion, worst at @p locus. True when the loop has converged.
    /// @throws SolverFailure when the maximum number of passes is used up.
    bool finished(double value, const std::string &locus);

    const std::string &name() const
    {
      return name_;
    }
    double tolerance() const
    {
      return tolerance_;
    }
    /// Passes done so far.
    unsigned int counter() const
    {
      return counter_;
    }
    double value() const
    {
      return value_;
    }

  private:
    std::string  name_;
    unsigned int counter_ = 0, limit_;
    double       tolerance_, value_ = 0.;
  };
} // namespace Nodus

#endif
