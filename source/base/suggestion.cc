#include "base/suggestion.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Number of letters to change, insert or delete to turn @p a into @p b, or into any part of @p b; blind to upper
    /// and lower case.
    unsigned int edit_distance(const std::string &a, const std::string &b, const bool part)
    {
      std::vector<unsigned int> row(b.size() + 1);
      for (unsigned int j = 0; j <= b.size(); ++j)
        row[j] = part ? 0 : j;
      for (unsigned int i = 0; i < a.size(); ++i)
      {
        unsigned int diagonal = row[0];
        row[0]                = i + 1;
        for (unsigned int j = 0; j < b.size(); ++j)
        {
          const unsigned int change = diagonal + (std::tolower(a[i]) != std::tolower(b[j]) ? 1 : 0);
          diagonal                  = row[j + 1];
          row[j + 1]                = std::min({change, row[j] + 1, row[j + 1] + 1});
        }
      }
      return part ? *std::min_element(row.begin(), row.end()) : row[b.size()];
    }

    std::vector<std::string> nearest(const std::string              &name,
                                     const std::vector<std::string> &candidates,
                                     const unsigned int              n,
                                     const bool                      part,
                                     const std::size_t               farthest)
    {
      std::vector<std::pair<unsigned int, std::string>> near;
      for (const auto &candidate : candidates)
        if (name.size() <= candidate.size() + farthest) // otherwise as many letters at least are too many
          if (const unsigned int distance = edit_distance(name, candidate, part); distance <= farthest)
            near.emplace_back(distance, candidate);
      std::stable_sort(near.begin(), near.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
      std::vector<std::string> names;
      for (const auto &[distance, candidate] : near)
        if (names.size() < n)
          names.push_back(candidate);
      return names;
    }
  } // namespace

  std::vector<std::string> nearest(const std::string &name, const std::vector<std::string> &candidates)
  {
    auto names = nearest(name, candidates, 1, false, name.size() < 5 ? 1 : std::max<std::size_t>(2, name.size() / 3));
    if (names.empty() && name.size() >= 4)
      names = nearest(name, candidates, 3, true, name.size() / 4);
    return names;
  }

  std::string did_you_mean(const std::vector<std::string> &names)
  {
    std::string text = "; did you mean ";
    for (std::size_t i = 0; i < names.size(); ++i)
      text += (i == 0 ? "'" : i + 1 == names.size() ? " or '" : ", '") + names[i] + "'";
    return text + '?';
  }

  std::string suggestion(const std::string &name, const std::vector<std::string> &candidates)
  {
    if (const auto near = nearest(name, candidates); !near.empty())
      return did_you_mean(near);
    std::string list;
    for (const auto &candidate : candidates)
      list += (list.empty() ? "; there are: " : ", ") + candidate;
    return list;
  }
} // namespace Nodus
