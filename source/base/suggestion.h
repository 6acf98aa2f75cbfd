#ifndef nodus_base_suggestion_h
#define nodus_base_suggestion_h

#include <string>
#include <vector>

// What a misspelt name was meant to be.

namespace Nodus
{
  /// The candidate that differs from @p name in a third of its letters or less; otherwise up to three that have a part
  /// like it. Blind to upper and lower case.
  std::vector<std::string> nearest(const std::string &name, const std::vector<std::string> &candidates);

  /// "; did you mean 'A', 'B' or 'C'?"
  std::string did_you_mean(const std::vector<std::string> &names);

  /// did_you_mean() the nearest candidates or, when nothing is near, the list of what there is.
  std::string suggestion(const std::string &name, const std::vector<std::string> &candidates);
} // namespace Nodus

#endif
