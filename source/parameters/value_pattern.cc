#include "parameters/value_pattern.h"

#include <deal.II/base/utilities.h>

#include <map>
#include <regex>
#include <sstream>

namespace Nodus
{
  ValuePattern::ValuePattern(const std::string &description)
  {
    static const std::regex list("\\[List of <(.*)> of length (\\d+)\\.\\.\\.(\\d+) \\(inclusive\\)"
                                 "(?: separated by <(.)>)?\\]"),
        selection("\\[Selection (.*?) ?\\]"), range("\\[(Double|Integer).* (\\S+)\\.\\.\\.(\\S+) \\(inclusive\\)\\]");
    std::smatch match;
    if (std::regex_match(description, match, list))
    {
      kind      = Kind::list;
      entries   = {ValuePattern(match[1])};
      shortest  = std::stoul(match[2]);
      longest   = std::stoul(match[3]);
      separator = match[4].matched ? match[4].str()[0] : ',';
    }
    else if (std::regex_match(description, match, selection))
    {
      kind    = Kind::choice;
      choices = dealii::Utilities::split_string_list(match[1], '|');
    }
    else if (description == "[Id or name]")
      kind = Kind::id_or_name;
    else if (description == "[Bool]")
      kind = Kind::truth;
    else if (description.compare(0, 9, "[FileName") == 0)
      kind = Kind::file;
    else if (description.compare(0, 7, "[Double") == 0 || description.compare(0, 8, "[Integer") == 0)
    {
      kind = description[1] == 'D' ? Kind::number : Kind::whole_number;
      if (std::regex_match(description, match, range))
      {
        open = match[2] == "2.22507e-308"; // the smallest positive double, because patterns have no open end
        if (match[2] != "-MAX_DOUBLE" && match[2] != "-2147483648")
          least = open ? "0" : match[2].str();
        if (match[3] != "MAX_DOUBLE" && match[3] != "2147483647")
          most = match[3];
      }
    }
  }

  std::string ValuePattern::in_words() const
  {
    std::string words;
    switch (kind)
    {
      case Kind::list:
        words = (shortest == longest ? std::to_string(shortest) + " entries" : "a list") + " separated by '" +
                separator + "'";
        return words + (entries[0].kind == Kind::text ? "" : ", each " + entries[0].in_words());
      case Kind::choice:
        for (const std::string &choice : choices)
          words += (words.empty() ? "one of: " : ", ") + choice;
        return words;
      case Kind::truth:
        return "true or false";
      case Kind::id_or_name:
        return "a whole number >= 0 or a name";
      case Kind::text:
      case Kind::file:
        return "text";
      default:
        words = kind == Kind::whole_number ? "a whole number" : "a number";
        if (!least.empty())
          words += (open ? " > " : " >= ") + least;
        if (!most.empty())
          words += (least.empty() ? " <= " : " and <= ") + most;
        return words;
    }
  }

  std::string ValuePattern::in_json() const
  {
    static const std::map<Kind, const char *> names = {{Kind::text, "text"},
                                                       {Kind::file, "file"},
                                                       {Kind::truth, "bool"},
                                                       {Kind::whole_number, "integer"},
                                                       {Kind::number, "number"},
                                                       {Kind::id_or_name, "id or name"},
                                                       {Kind::choice, "choice"},
                                                       {Kind::list, "list"}};
    std::string                               json  = std::string("{\"kind\": \"") + names.at(kind) + '"';
    if (kind == Kind::list)
    {
      json += std::string(", \"separator\": \"") + separator + "\", \"least\": " + std::to_string(shortest);
      if (longest != std::numeric_limits<unsigned int>::max())
        json += ", \"most\": " + std::to_string(longest);
      json += ", \"of\": " + entries[0].in_json();
    }
    if (!least.empty())
      json += (open ? ", \"above\": " : ", \"least\": ") + least;
    if (!most.empty())
      json += ", \"most\": " + most;
    for (std::size_t i = 0; i < choices.size(); ++i)
      json += (i == 0 ? ", \"choices\": [" : ", ") + json_text(choices[i]);
    return json + (choices.empty() ? "}" : "]}");
  }

  std::string json_text(const std::string &text)
  {
    std::ostringstream out;
    out << '"';
    for (const char c : text)
      if (c == '"' || c == '\\')
        out << '\\' << c;
      else if (c == '\n')
        out << "\\n";
      else
        out << c;
    out << '"';
    return out.str();
  }
} // namespace Nodus
