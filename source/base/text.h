#ifndef nodus_base_text_h
#define nodus_base_text_h

#include <sstream>
#include <string>

namespace Nodus
{
  /// Words and numbers one after the other, numbers with four digits.
  template <typename... Parts>
  std::string text(const Parts &...parts)
  {
    std::ostringstream stream;
    stream.precision(4);
    (stream << ... << parts);
    return stream.str();
  }
} // namespace Nodus

#endif
