#include "parameters/id_or_name.h"
#include "parameters/argument_kind.h"

#include <limits>

namespace Nodus
{
  bool is_id(const std::string &text)
  {
    return !text.empty() && text.size() <= 10 && text.find_first_not_of("0123456789") == std::string::npos &&
           std::stoul(text) <= std::numeric_limits<int>::max();
  }

  std::string joined(const std::vector<unsigned int> &ids, const std::vector<std::string> &names)
  {
    std::string text;
    for (const unsigned int id : ids)
      text += (text.empty() ? "" : ", ") + std::to_string(id);
    for (const std::string &name : names)
      text += (text.empty() ? "" : ", ") + name;
    return text;
  }

  bool IdOrName::match(const std::string &text) const
  {
    return is_id(text) || (!text.empty() && !matches(ArgumentKind::number, text));
  }

  std::string IdOrName::description(const OutputStyle) const
  {
    return "[Id or name]";
  }

  std::unique_ptr<dealii::Patterns::PatternBase> IdOrName::clone() const
  {
    return std::make_unique<IdOrName>();
  }
} // namespace Nodus
