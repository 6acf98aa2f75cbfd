#ifndef nodus_tests_numbers_h
#define nodus_tests_numbers_h

// How tests print numbers: rounded, so that round-off does not change a digit, and scaled, because numdiff does not see
// differences below 1e-6. A value that agrees with its reference to less than the last digit is printed as the
// reference.

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace Numbers
{
  /// Deviations below this are round-off and what iterations leave; above they are of the discretisation.
  constexpr double tight = 1e-5;

  /// The power of ten of the first digit of @p magnitude.
  inline int exponent(const double magnitude)
  {
    return magnitude > 0. ? int(std::floor(std::log10(magnitude * (1. + 1e-7)))) : 0;
  }

  /// @p value with as many digits as give @p digits to @p magnitude (by default its own). What is not between 0.1 and
  /// 1e5 is written as 1.2345*1e-3, which numdiff compares as text.
  inline std::string number(const double value, const int digits = 5, const double magnitude = 0.)
  {
    const int          first = exponent(magnitude > 0. ? magnitude : std::abs(value));
    const int          shift = first < -1 || first > 4 ? first : 0;
    std::ostringstream text;
    text.setf(std::ios::fixed);
    text.precision(std::max(0, digits - 1 - (first - shift)));
    text << value * std::pow(10., -shift);
    std::string result = text.str();
    if (result[0] == '-' && result.find_first_of("123456789") == std::string::npos)
      result.erase(0, 1);
    return result + (shift != 0 ? "*1e" + std::to_string(shift) : "");
  }

  /// A relative deviation or another measure of an error with three digits, the last one not below 1e-6.
  inline std::string small(const double error, const int digits = 3)
  {
    if (error < 1e-6)
      return "0";
    std::ostringstream text;
    text.setf(std::ios::fixed);
    text.precision(std::min(6, std::max(0, digits - 1 - exponent(error))));
    text << error;
    return text.str();
  }

  inline std::string plain(const double value, const int precision = 9)
  {
    std::ostringstream text;
    text.precision(precision);
    text << value;
    return text.str();
  }

  /// @p value against @p reference, the tolerance relative to @p scale (the reference itself when 0). Ends with "NO"
  /// and all digits when it is not met.
  inline std::string
  comparison(const double value, const double reference, const double tolerance, const double scale = 0.)
  {
    const double      size    = scale > 0. ? scale : std::abs(reference);
    const double      allowed = tolerance * size, difference = std::abs(value - reference);
    const double      magnitude = std::max(std::abs(value), std::abs(reference));
    const std::string limit     = plain(tolerance) + (scale > 0. && scale != 1. ? " of " + number(scale) : "");
    if (!(difference <= allowed))
      return plain(value, 10) + " (reference " + plain(reference) + ", within " + limit + "), deviation " +
             plain(difference / size) + ": NO";
    if (tolerance == 0.) // a count
      return plain(value);
    if (std::abs(reference) <= allowed) // zero
      return (tolerance > tight ? small(difference / size)
              : scale == 1.     ? "yes"
                                : "0") +
             " (reference 0, within " + limit + ")";
    int    digits = 5;
    double unit   = std::pow(10., exponent(magnitude) - digits + 1);
    for (; tolerance <= tight && digits > 1 && unit / 2. < allowed; unit *= 10.)
      --digits;
    const bool snap = tolerance <= tight || difference < unit / 100.;
    return number(snap ? reference : value, digits, magnitude) + " (reference " + plain(reference) + ", within " +
           limit + (tolerance <= tight ? "" : ", off by " + small(difference / size)) + ")";
  }

  /// Whether @p error stays below @p tolerance, with the error itself where it is more than round-off.
  inline std::string error_below(const double error, const double tolerance, const int digits = 3)
  {
    if (!(error <= tolerance))
      return plain(error) + " (at most " + plain(tolerance) + "): NO";
    if (tolerance <= tight)
      return "yes";
    return small(error, digits) + " (at most " + plain(tolerance) + ")";
  }
} // namespace Numbers

#endif
