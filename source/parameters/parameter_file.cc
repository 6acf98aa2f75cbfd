#include "parameters/parameter_file.h"
#include "base/suggestion.h"
#include <nodus/base/types.h>
#include <nodus/plugins/registry.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#define BOOST_BIND_GLOBAL_PLACEHOLDERS // silences a remark of boost 1.74 about its own JSON reader
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace Nodus
{
  namespace
  {
    using dealii::Utilities::trim;

    std::string join(const std::string &section, const std::string &name)
    {
      return section.empty() ? name : section + '/' + name;
    }

    std::string parent(const std::string &section)
    {
      const auto slash = section.rfind('/');
      return slash == std::string::npos ? "" : section.substr(0, slash);
    }

    std::string last_name(const std::string &section)
    {
      return section.substr(section.rfind('/') + 1);
    }

    std::string in_section(const std::string &section)
    {
      return section.empty() ? "at the top level" : "in '" + section + "'";
    }

    void collect(const boost::property_tree::ptree &tree, const std::string &section, std::vector<DeclaredKey> &keys)
    {
      for (const auto &[name, node] : tree)
        if (node.find("pattern_description") != node.not_found())
        {
          const auto pattern = node.get<std::string>("pattern_description");
          keys.push_back({section,
                          name,
                          node.get<std::string>("default_value"),
                          ValuePattern(pattern),
                          node.get<std::string>("documentation")});
        }
        else
          collect(node, join(section, name), keys);
    }

    /// What to give instead of @p value, and what its first entry that is none of the choices was meant to be.
    std::string advice(const ValuePattern &pattern, const std::string &value)
    {
      const bool  is_list = pattern.kind == ValuePattern::Kind::list;
      const auto &choices = is_list ? pattern.entries.front().choices : pattern.choices;
      const auto  items =
          is_list ? dealii::Utilities::split_string_list(value, pattern.separator) : std::vector<std::string>{value};
      for (const std::string &item : items)
        if (std::find(choices.begin(), choices.end(), item) == choices.end())
          if (const auto near = nearest(item, choices); !near.empty())
            return "give " + pattern.in_words() + did_you_mean(near);
      return "give " + pattern.in_words();
    }
  } // namespace

  std::string DeclaredKey::unit() const
  {
    const auto begin = documentation.find('['), end = documentation.find(']', begin);
    return end == std::string::npos ? "" : documentation.substr(begin + 1, end - begin - 1);
  }

  std::vector<DeclaredKey> declared_keys(const dealii::ParameterHandler &prm)
  {
    // The JSON dump is the only public way to the documentation and the patterns.
    std::stringstream json;
    prm.print_parameters(json, dealii::ParameterHandler::JSON | dealii::ParameterHandler::KeepDeclarationOrder);
    boost::property_tree::ptree tree;
    boost::property_tree::read_json(json, tree);
    std::vector<DeclaredKey> keys;
    collect(tree, "", keys);
    return keys;
  }

  std::string prefixed(const std::string &prefix, const std::string &key)
  {
    return prefix.empty() ? key : prefix + static_cast<char>(std::tolower(key[0])) + key.substr(1);
  }

  ParameterFile::ParameterFile(const std::string &file, const std::vector<std::string> &overrides)
      : file_(file)
  {
    std::error_code unknown; // a name that is too long is one that cannot be opened
    if (std::filesystem::is_directory(file_, unknown))
      throw InputError(file_ + " is a folder; give the name of a .prm or .json file");
    std::ifstream stream(file_);
    if (!stream)
      throw InputError(file_ + ": cannot open the parameter file; check its name and the folder nodus is started in");
    char mark[3] = {}; // of the byte order, which some editors begin a file with
    stream.read(mark, 3);
    if (std::string(mark, 3) != "\xef\xbb\xbf")
    {
      stream.clear();
      stream.seekg(0);
    }
    if (std::filesystem::path(file_).extension() == ".json")
      read_json(stream);
    else
      read_prm(stream);
    for (const auto &text : overrides)
      override_with(text);
  }

  void ParameterFile::read_prm(std::istream &stream)
  {
    std::string section, line;
    for (unsigned int number = 1; std::getline(stream, line); ++number)
    {
      const std::string origin = file_ + ':' + std::to_string(number);
      line                     = trim(line.substr(0, line.find('#')));
      // A backslash at the end continues the statement on the next line, as in every deal.II file.
      for (std::string next; !line.empty() && line.back() == '\\' && std::getline(stream, next); ++number)
        line = trim(line.substr(0, line.size() - 1)) + ' ' + trim(next.substr(0, next.find('#')));
      if (!line.empty())
        read_statement(line, origin, section);
    }
    if (!section.empty())
      throw InputError(sections_[section] + ": 'subsection " + last_name(section) +
                       "' has no 'end'; add it after the last line of the subsection");
  }

  void ParameterFile::read_statement(const std::string &line, const std::string &origin, std::string &section)
  {
    if (line.substr(0, line.find('=')).find("\xc2\xa0") != std::string::npos)
      throw InputError(origin + ": there is a non-breaking space, as word processors and web pages write them; "
                                "replace it by a blank");
    const auto        blank = line.find_first_of(" \t");
    const std::string word  = line.substr(0, blank);
    const std::string rest  = blank == std::string::npos ? "" : trim(line.substr(blank));

    if (word == "subsection" && !rest.empty() && rest.find('/') == std::string::npos)
    {
      section = join(section, rest);
      open_section(section, origin);
    }
    else if (word == "end" && rest.empty())
    {
      if (section.empty())
        throw InputError(origin + ": 'end' without a 'subsection'; remove it");
      section = parent(section);
    }
    else if (word == "set" && rest.find('=') != std::string::npos)
    {
      const auto equals = rest.find('=');
      add({section, trim(rest.substr(0, equals)), trim(rest.substr(equals + 1)), origin});
    }
    else
      throw InputError(origin + ": cannot understand '" + line +
                       "'; write 'subsection <name>', 'end', 'set <key> = <value>' or '# comment'");
  }

  void ParameterFile::open_section(const std::string &section, const std::string &origin)
  {
    constexpr int deepest = 20; // each has the names of those around it
    if (std::count(section.begin(), section.end(), '/') >= deepest)
      throw InputError(origin + ": more than " + std::to_string(deepest) +
                       " subsections inside each other; those of nodus are two deep: add the 'end' of each");
    const auto [opened, is_new] = sections_.emplace(section, origin);
    if (!is_new)
      throw InputError(origin + ": subsection '" + section + "' is already at " + opened->second +
                       "; merge or renumber one of the two");
  }

  void ParameterFile::add(const Entry &entry)
  {
    for (const auto &other : entries_)
      if (other.section == entry.section && other.key == entry.key)
        throw InputError(entry.origin + ": '" + entry.key + "' " + in_section(entry.section) + " is already set (" +
                         other.origin + "); remove one of the two");
    entries_.push_back(entry);
  }

  void ParameterFile::override_with(const std::string &text)
  {
    const auto equals = text.find('=');
    if (equals == std::string::npos)
      throw InputError("--set \"" + text + "\": no '='; write --set \"Section/Key=value\"");
    const std::string path    = trim(text.substr(0, equals));
    const Entry       entry   = {parent(path), last_name(path), trim(text.substr(equals + 1)), "--set"};
    const auto        differs = [&](const Entry &e)
    { return e.section != entry.section || e.key != entry.key || e.origin == entry.origin; };
    // What the file says gives way; a second --set of the same key is a mistake like any other duplicate.
    entries_.erase(std::stable_partition(entries_.begin(), entries_.end(), differs), entries_.end());
    add(entry);
  }

  unsigned int ParameterFile::count(const std::string &name) const
  {
    std::map<unsigned long, std::string> numbers; // -> origin
    const std::regex                     numbered(name + " ([1-9][0-9]{0,8})");
    std::smatch                          match;
    for (const auto &[section, origin] : sections_)
      if (std::regex_match(section, match, numbered))
        numbers[std::stoul(match[1])] = origin;

    unsigned int expected = 1;
    for (const auto &[number, origin] : numbers)
    {
      const std::string wanted = "'" + name + ' ' + std::to_string(expected) + "'";
      if (number != expected)
        throw InputError(origin + ": there is a '" + name + ' ' + std::to_string(number) + "' but no " + wanted +
                         "; number the subsections 1, 2, 3, ... without gaps");
      ++expected;
    }
    return expected - 1;
  }

  void ParameterFile::apply_to(dealii::ParameterHandler &prm) const
  {
    const auto                                      declared = declared_keys(prm);
    std::map<std::string, std::vector<std::string>> keys;     // section -> keys
    std::map<std::string, std::vector<std::string>> children; // section -> names of its subsections
    for (const auto &d : declared)
    {
      keys[d.section].push_back(d.key);
      for (std::string s = d.section; !s.empty(); s = parent(s))
      {
        auto &siblings = children[parent(s)];
        if (std::find(siblings.begin(), siblings.end(), last_name(s)) == siblings.end())
          siblings.push_back(last_name(s));
      }
    }

    const auto require_section = [&](const std::string &section, const std::string &origin)
    {
      // The outermost name that is wrong is the one to complain about.
      std::string known;
      for (const auto &name : dealii::Utilities::split_string_list(section, '/'))
      {
        auto names = children[known];
        if (std::find(names.begin(), names.end(), name) == names.end())
        {
          if (known.empty())
            for (const char *const first :
                 {"Body 1", "Boundary condition 1", "Contact pair 1", "Output point 1", "Output line 1"})
              if (std::find(names.begin(), names.end(), first) == names.end())
                names.push_back(first); // the file may mean to have one
          throw InputError(origin + ": unknown subsection '" + name + "' " + in_section(known) +
                           (names.empty()
                                ? "; what a plug-in brings needs its library among the " + std::string(libraries_key)
                                : suggestion(name, names)));
        }
        known = join(known, name);
      }
    };
    for (const auto &[section, origin] : sections_)
      require_section(section, origin);

    for (const auto &entry : entries_)
    {
      require_section(entry.section, entry.origin);
      const auto found =
          std::find_if(declared.begin(),
                       declared.end(),
                       [&](const DeclaredKey &d) { return d.section == entry.section && d.key == entry.key; });
      if (found == declared.end())
      {
        // the right name in the wrong place, or one like it, unless the place has a name like it
        std::vector<std::string> elsewhere;
        if (nearest(entry.key, keys[entry.section]).empty())
          for (const bool exact : {true, false})
            if (elsewhere.empty())
              for (const auto &d : declared)
                if ((exact ? d.key == entry.key : !nearest(entry.key, {d.key}).empty()) && elsewhere.size() < 3)
                  elsewhere.push_back(d.path());
        throw InputError(entry.origin + ": unknown key '" + entry.key + "' " + in_section(entry.section) +
                         (elsewhere.empty() ? suggestion(entry.key, keys[entry.section]) : did_you_mean(elsewhere)));
      }
      if (!entry.list.empty() && found->pattern.separator == '\0')
        refuse(entry.section, entry.key, "is a list; give " + found->pattern.in_words());
      std::string value = entry.value;
      for (const auto &item : entry.list)
        value += (value.empty() ? "" : std::string(1, found->pattern.separator) + ' ') + item;

      const auto path = dealii::Utilities::split_string_list(entry.section, '/');
      for (const auto &name : path)
        prm.enter_subsection(name);
      try
      {
        prm.set(entry.key, value);
      }
      catch (const dealii::ExceptionBase &)
      {
        refuse(entry.section, entry.key, "is '" + value + "'; " + advice(found->pattern, value));
      }
      for (unsigned int i = 0; i < path.size(); ++i)
        prm.leave_subsection();
    }
  }

  std::vector<std::string> ParameterFile::keys(const std::string &section) const
  {
    std::vector<std::string> keys;
    for (const auto &entry : entries_)
      if (entry.section == section)
        keys.push_back(entry.key);
    return keys;
  }

  std::vector<std::string> ParameterFile::list(const std::string &section, const std::string &key) const
  {
    for (const auto &entry : entries_)
      if (entry.section == section && entry.key == key)
        return entry.list.empty() ? dealii::Utilities::split_string_list(entry.value, ',') : entry.list;
    return {};
  }

  void ParameterFile::refuse_idle_plugins() const
  {
    for (const auto &entry : entries_)
      if (const std::string name = last_name(entry.section), place = parent(entry.section);
          Plugins::is_registered(name) &&
          std::none_of(entries_.begin(),
                       entries_.end(),
                       [&](const Entry &other) { return other.section == place && other.value == name; }))
        refuse(entry.section, entry.key, "has no effect, because nothing beside it chooses '" + name + "'; remove it");
  }

  std::string ParameterFile::origin_of(std::string section) const
  {
    for (; !section.empty(); section = parent(section))
      if (const auto opened = sections_.find(section); opened != sections_.end())
        return opened->second;
    return file_;
  }

  void ParameterFile::refuse_section(const std::string &section, const std::string &message) const
  {
    throw InputError(origin_of(section) + ": '" + section + "': " + message);
  }

  void ParameterFile::refuse(const std::string &section, const std::string &key, const std::string &message) const
  {
    std::string origin = origin_of(section);
    for (const auto &entry : entries_)
      if (entry.section == section && entry.key == key)
        origin = entry.origin;
    throw InputError(origin + ": '" + key + "' " + in_section(section) + ' ' + message);
  }
} // namespace Nodus
