#ifndef nodus_parameters_argument_kind_h
#define nodus_parameters_argument_kind_h

#include <string>

namespace Nodus
{
  /// What an argument of a mesh generator may be.
  enum class ArgumentKind
  {
    number,
    positive,
    whole,
    natural,
    point,
    points,
    cells,
    steps,
    wholes,
    choice
  };

  /// "a whole number > 0", "x,y,z".
  std::string in_words(ArgumentKind kind);
  /// Whether @p text is written as the kind asks for.
  bool matches(ArgumentKind kind, const std::string &text);
} // namespace Nodus

#endif
