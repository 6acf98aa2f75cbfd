#ifndef nodus_tests_messages_h
#define nodus_tests_messages_h

#include "cases.h"

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

namespace Cases
{
  /// That a message has all of these words; the message itself where it has not.
  inline void check_words(const std::string &what, const std::string &message, const std::vector<std::string> &words)
  {
    const bool all =
        std::all_of(words.begin(), words.end(), [&](const auto &w) { return message.find(w) != std::string::npos; });
    check(what, all);
    if (!all && root())
      std::cout << "  " << message << std::endl;
  }
} // namespace Cases

#endif
