#ifndef nodus_base_law_check_h
#define nodus_base_law_check_h

#include <cmath>
#include <string>

namespace Nodus
{
  /// One comparison of a law with what follows from it (`nodus --check-law`).
  struct LawCheck
  {
    std::string what;       ///< "tangent against differences of the stress"
    double      error = 0.; ///< the largest, relative
    std::string where;      ///< the argument that it was found at

    /// Beyond this a law is wrong: differences are more accurate.
    static constexpr double tolerance = 1e-6;
    bool                    holds() const
    {
      return error <= tolerance; // false for NaN, too
    }

    void add(const double another, const std::string &place)
    {
      if (where.empty() || another > error || std::isnan(another))
      {
        error = another;
        where = place;
      }
    }
  };
} // namespace Nodus

#endif
