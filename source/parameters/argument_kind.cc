#include "parameters/argument_kind.h"

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <regex>

namespace Nodus
{
  namespace
  {
    /// Whether @p text is a list of @p n (0: any number of) what @p is says.
    template <typename Predicate>
    bool is_list(const std::string &text, const char separator, const std::size_t n, const Predicate &is)
    {
      const auto items = dealii::Utilities::split_string_list(text, separator);
      return (n == 0 || items.size() == n) && std::all_of(items.begin(), items.end(), is);
    }

    bool is_number(const std::string &text)
    {
      try
      {
        dealii::Utilities::string_to_double(text);
        return true;
      }
      catch (const std::exception &)
      {
        return false;
      }
    }
  } // namespace

  std::string in_words(const ArgumentKind kind)
  {
    switch (kind)
    {
      case ArgumentKind::number:
        return "a number";
      case ArgumentKind::positive:
        return "a number > 0";
      case ArgumentKind::whole:
        return "a whole number >= 0";
      case ArgumentKind::natural:
        return "a whole number > 0";
      case ArgumentKind::point:
        return "x,y,z";
      case ArgumentKind::points:
        return "x,y,z; x,y,z; ...";
      case ArgumentKind::cells:
        return "three whole numbers > 0 separated by ','";
      case ArgumentKind::steps:
        return "three whole numbers > 0 separated by ',', or for each direction the widths of the cells, e.g. "
               "0.5,0.5; 1; 1";
      case ArgumentKind::wholes:
        return "six whole numbers >= 0 separated by ','";
      case ArgumentKind::choice:
        break;
    }
    return "true or false";
  }

  bool matches(const ArgumentKind kind, const std::string &text)
  {
    const auto positive = [](const std::string &t)
    { return is_number(t) && dealii::Utilities::string_to_double(t) > 0.; };
    const auto whole   = [](const std::string &t) { return std::regex_match(t, std::regex("\\d{1,9}")); };
    const auto natural = [&](const std::string &t) { return whole(t) && positive(t); };
    const auto point   = [](const std::string &t) { return is_list(t, ',', 3, is_number); };
    const auto widths  = [&](const std::string &t) { return is_list(t, ',', 0, positive); };
    switch (kind)
    {
      case ArgumentKind::number:
        return is_number(text);
      case ArgumentKind::positive:
        return positive(text);
      case ArgumentKind::whole:
        return whole(text);
      case ArgumentKind::natural:
        return natural(text);
      case ArgumentKind::point:
        return point(text);
      case ArgumentKind::points:
        return is_list(text, ';', 8, point);
      case ArgumentKind::cells:
        return is_list(text, ',', 3, natural);
      case ArgumentKind::steps:
        return is_list(text, ',', 3, natural) || is_list(text, ';', 3, widths);
      case ArgumentKind::wholes:
        return is_list(text, ',', 6, whole);
      case ArgumentKind::choice:
        break;
    }
    return text == "true" || text == "false";
  }
} // namespace Nodus
