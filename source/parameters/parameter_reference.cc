#include "parameters/parameter_reference.h"
#include "base/suggestion.h"
#include "parameters/generators.h"
#include <nodus/base/types.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <regex>

namespace Nodus
{
  namespace
  {
    const std::regex numbered(" 1(?=/|$)");

    /// "Body 1/Material" -> "Body <n> / Material"
    std::string title_of(const std::string &section)
    {
      return std::regex_replace(std::regex_replace(section, numbered, " `<n>`"), std::regex("/"), " / ");
    }

    /// "Body 1/Name" -> "Body <n>/Name"
    std::string any_number_in(const std::string &path)
    {
      return std::regex_replace(path, numbered, " <n>");
    }

    std::string lower_case(std::string text)
    {
      std::transform(text.begin(), text.end(), text.begin(), [](const unsigned char c) { return std::tolower(c); });
      return text;
    }

    /// What would end a cell of a Markdown table is escaped.
    std::string cell(const std::string &text)
    {
      const std::string escaped = std::regex_replace(text, std::regex("[|<>*]"), "\\$&");
      return escaped.empty() ? " " : ' ' + escaped + ' ';
    }
    bool has(const std::string &text, const std::string &wanted)
    {
      return lower_case(text).find(wanted) != std::string::npos;
    }

    bool has_words(const std::string &text, const std::string &wanted)
    {
      const auto words = dealii::Utilities::split_string_list(wanted, ' ');
      return std::all_of(words.begin(), words.end(), [&](const std::string &word) { return has(text, word); });
    }

    /// "direct, block"; empty where there is no choice.
    std::string choices(const DeclaredKey &key)
    {
      const ValuePattern &pattern = key.pattern.entries.empty() ? key.pattern : key.pattern.entries[0];
      std::string         text;
      for (const std::string &choice : pattern.choices)
        text += (text.empty() ? "" : ", ") + choice;
      return text;
    }

    /// All that is to be said about the keys that are @p meant.
    template <typename Predicate>
    std::string entries(const std::vector<DeclaredKey> &keys, const Predicate &meant)
    {
      std::string text;
      for (const auto &k : keys)
        if (meant(k))
          text += (text.empty() ? "" : "\n") + any_number_in(k.path()) + "\n  default  " +
                  (k.default_value.empty() ? "(empty)" : k.default_value) + "\n  allowed  " + k.pattern.in_words() +
                  "\n  unit     " + k.unit() + "\n  meaning  " + k.documentation + '\n';
      return text;
    }

    /// The mesh generators that have @p wanted in their names.
    std::string generators(const std::string &wanted)
    {
      std::string text;
      for (const std::string &name : Generators::names())
        if (has(name, wanted))
          text += "\nGenerator " + name + "\n  arguments  " +
                  std::regex_replace(Generators::arguments(name), std::regex(" : "), "\n           : ") +
                  "\n  example    " + Generators::example(name) + '\n';
      return text;
    }

    /// The names of generators, keys and choices that look like @p wanted, of which the last part of a path counts.
    /// @p words: the same in lower case.
    std::vector<std::string>
    similar_names(const std::vector<DeclaredKey> &keys, const std::string &wanted, const std::string &words)
    {
      std::vector<std::string> names = Generators::names();
      for (const auto &k : keys)
      {
        std::vector<std::string> list = dealii::Utilities::split_string_list(choices(k), ',');
        list.insert(list.begin(), k.key);
        for (const std::string &name : list)
          if (std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
      }
      std::vector<std::string> near;
      if (!words.empty())
        near = nearest(wanted.substr(wanted.rfind('/') + 1), names);
      // several words, some of which may be right
      for (const std::string &word : dealii::Utilities::split_string_list(words, ' '))
        if (near.empty() && word.size() > 2)
          near = nearest(word, names);
      return near;
    }
  } // namespace

  std::string ParameterReference::explain(const std::vector<DeclaredKey> &keys, const std::string &wanted)
  {
    // any number of a body, condition or pair, and blanks around '/' as in the titles of the reference
    std::string words = std::regex_replace(lower_case(dealii::Utilities::trim(wanted)), std::regex("\\s*/\\s*"), "/");
    words = std::regex_replace(words, std::regex("(body|condition|pair|point|line) ([0-9]+|<n>)(?=/|$)"), "$1 1");

    std::string text;
    // What is meant is a part of a path or of a choice, or else words of a path in any order, or else of a meaning.
    if (!words.empty())
    {
      text = entries(keys, [&](const DeclaredKey &k) { return has(k.path(), words) || has(choices(k), words); });
      if (const std::string more = generators(words); !more.empty())
        text += text.empty() ? more.substr(1) : more;
      if (text.empty())
        text = entries(keys, [&](const DeclaredKey &k) { return has_words(k.path(), words); });
      if (text.empty())
        text = entries(keys, [&](const DeclaredKey &k) { return has_words(k.documentation, words); });
    }
    if (text.empty())
    {
      const std::vector<std::string> near = similar_names(keys, wanted, words);
      throw InputError("--explain: there is no key like '" + wanted + "'" +
                       (near.empty() ? "; nodus --document lists all keys" : did_you_mean(near)));
    }
    return text;
  }

  std::string ParameterReference::page(const std::vector<DeclaredKey> &keys)
  {
    std::string text    = R"(# Parameters

Written by `nodus --document`; edit the descriptions in source/parameters*.cc.

A case is a text file. `set Key = value` sets a key, `subsection Name` ... `end` enclose the keys of a section, `#`
starts a comment and a `\` at the end of a line continues it. Bodies, boundary conditions, contact pairs, output
points and output lines are numbered 1, 2, 3, ... without gaps. Unknown keys, keys set twice and values out of range are
refused. On the command line `--set "Section/Key=value"` replaces a value of the file, for example
`--set "Body 1/Material/Poisson's ratio=0.4"`, and `nodus --explain "friction"` prints what is said here about all keys
with that word in their path or among their choices, or else in their meaning.

A file that ends in .json says the same as nested objects, with arrays for lists if you like:
`{"Title": "...", "Body 1": {"Name": "block", "Material": {"Young's modulus": 2000}}, "Load stepping": {"Increments":
[4, 20]}}`.

Units are yours to choose, but consistently: N, mm and MPa, or N, m and Pa. The unit of a key is in square brackets,
[-] is none. The time t orders the loads and has no unit. Expressions may use x, y, z (reference coordinates), t where
a value depends on time, `pi` and the functions of muParser and deal.II's FunctionParser.
)";
    std::string section = "none yet";
    for (const auto &key : keys)
    {
      if (key.section != section)
        text += "\n## " + (key.section.empty() ? "Top level" : title_of(key.section)) +
                "\n\n| Key | Default | Allowed | Meaning |\n|---|---|---|---|\n";
      section = key.section;
      text += '|' + cell(key.key) + '|' + cell(key.default_value) + '|' + cell(key.pattern.in_words()) + '|' +
              cell(key.documentation) + "|\n";
    }
    text += "\n## Generators\n\nAll arguments are to be given, separated by ':'.\n\n"
            "| Generator | Arguments | Example |\n|---|---|---|\n";
    for (const std::string &name : Generators::names())
      text += '|' + cell(name) + '|' + cell(Generators::arguments(name)) + "| `" + Generators::example(name) + "` |\n";
    return text;
  }

  std::string ParameterReference::json(const std::vector<DeclaredKey> &keys)
  {
    std::string text = "{\n\"numbered\": [";
    for (const auto &key : keys)
      if (std::smatch match; std::regex_search(key.section, match, std::regex("^([^/]*) 1$")))
        if (const std::string name = json_text(match[1]); text.find(name) == std::string::npos)
          text += (text.back() == '[' ? "" : ", ") + name;
    text += "],\n\"keys\": [";
    for (const auto &key : keys)
      text += (text.back() == '[' ? "\n" : ",\n") + ("{\"path\": " + json_text(any_number_in(key.path()))) +
              ", \"default\": " + json_text(key.default_value) + ", \"type\": " + key.pattern.in_json() +
              ", \"allowed\": " + json_text(key.pattern.in_words()) + ", \"unit\": " + json_text(key.unit()) +
              ", \"meaning\": " + json_text(key.documentation) + '}';
    text += "\n],\n\"generators\": [";
    for (const std::string &name : Generators::names())
      text += (text.back() == '[' ? "\n" : ",\n") + ("{\"name\": " + json_text(name)) +
              ", \"arguments\": " + json_text(Generators::arguments(name)) +
              ", \"example\": " + json_text(Generators::example(name)) + '}';
    return text + "\n]\n}\n";
  }
} // namespace Nodus
