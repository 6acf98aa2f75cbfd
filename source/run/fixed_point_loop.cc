#include "run/fixed_point_loop.h"

#include <sstream>

namespace Nodus
{
  FixedPointLoop::FixedPointLoop(const std::string &name, const LoopParameters &parameters)
      : name_(name)
      , limit_(parameters.maximum_passes)
      , tolerance_(parameters.tolerance)
  {
  }

  bool FixedPointLoop::finished(const double value, const std::string &locus)
  {
    ++counter_;
    value_ = value;
    if (value <= tolerance_)
      return true;
    if (counter_ >= limit_)
    {
      std::ostringstream message;
      message << "the " << name_ << " loop did not converge in " << limit_ << " passes: criterion " << value
              << ", tolerance " << tolerance_ << (locus.empty() ? "" : "; worst at " + locus);
      throw SolverFailure(message.str(), SolverFailure::Kind::loop_limit);
    }
    return false;
  }
} // namespace Nodus
