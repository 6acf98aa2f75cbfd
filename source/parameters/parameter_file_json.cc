#include "parameters/parameter_file.h"
#include <nodus/base/types.h>

#define BOOST_BIND_GLOBAL_PLACEHOLDERS // silences a remark of boost 1.74 about its own JSON reader
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <iterator>
#include <sstream>

// Boost reads the JSON but does not tell where: its keys come in the order of the text, and there they are counted
// again.

namespace Nodus
{
  struct ParameterFile::JsonKey
  {
    std::string origin; ///< "case.json:17"
    char        value;  ///< first character of the value: '{', '[', '"', a digit, ...
  };

  namespace
  {
    using boost::property_tree::ptree;

    /// Text of an array inside of an array, or of a scalar.
    std::string item_text(const ptree &item, const std::string &origin, const std::string &key)
    {
      if (item.empty())
        return item.data();
      std::string text;
      for (const auto &[name, part] : item)
      {
        if (!name.empty() || !part.empty())
          throw InputError(origin + ": '" + key + "' nests too much; give a text, a number, a list or a list of lists");
        text += (text.empty() ? "" : ",") + part.data();
      }
      return text;
    }

    /// Boost calls itself once for each object or list inside another one, as deep as they are.
    void refuse_depth(const std::string &text, const std::string &file)
    {
      constexpr int deepest = 20;
      int           depth   = 0;
      unsigned int  line    = 1;
      bool          quoted  = false;
      for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\n')
          ++line;
        else if (quoted && text[i] == '\\')
          ++i;
        else if (text[i] == '"')
          quoted = !quoted;
        else if (!quoted && (text[i] == '{' || text[i] == '['))
        {
          if (++depth > deepest)
            throw InputError(file + ':' + std::to_string(line) + ": more than " + std::to_string(deepest) +
                             " objects and lists inside each other; subsections of nodus are two deep");
        }
        else if (!quoted && (text[i] == '}' || text[i] == ']'))
          --depth;
    }
  } // namespace

  void ParameterFile::read_json(std::istream &stream)
  {
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    refuse_depth(text, file_);
    ptree tree;
    try
    {
      std::istringstream copy(text);
      boost::property_tree::read_json(copy, tree);
    }
    catch (const boost::property_tree::json_parser_error &error)
    {
      throw InputError(file_ + ':' + std::to_string(error.line()) + ": this is no JSON: " + error.message() +
                       "; check the commas, quotes and braces up to here");
    }

    const char *const    blanks = " \t\r\n";
    std::vector<JsonKey> keys;
    unsigned int         line = 1;
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n')
        ++line;
      else if (text[i] == '"')
      {
        for (++i; text[i] != '"'; ++i)
          if (text[i] == '\\')
            ++i;
        const std::size_t colon = text.find_first_not_of(blanks, i + 1);
        if (colon != std::string::npos && text[colon] == ':')
          keys.push_back({file_ + ':' + std::to_string(line), text[text.find_first_not_of(blanks, colon + 1)]});
      }

    if (text[text.find_first_not_of(blanks)] != '{')
      throw InputError(file_ + ":1: the file must be one object: { \"Title\": ..., \"Body 1\": { ... }, ... }");
    auto next = keys.cbegin();
    read_json_object(tree, "", next);
  }

  void ParameterFile::read_json_object(const ptree                          &object,
                                       const std::string                    &section,
                                       std::vector<JsonKey>::const_iterator &next)
  {
    for (const auto &[name, node] : object)
    {
      const auto [origin, value] = *next++;
      if (name.empty() || name.find('/') != std::string::npos)
        throw InputError(origin + ": '" + name + "' is no name of a key or subsection; nest objects instead of '/'");
      if (value == 'n')
        throw InputError(origin + ": '" + name + "' is null; give a value or remove it");

      // ParameterHandler prints {"value": "0.3", "default_value": "0", ...} for a key.
      const auto written = node.get_optional<std::string>("value");
      if (value == '{' && written && node.count("default_value") > 0)
      {
        add({section, name, *written, origin});
        next += node.size();
      }
      else if (value == '{')
      {
        const std::string inner = section.empty() ? name : section + '/' + name;
        open_section(inner, origin);
        read_json_object(node, inner, next);
      }
      else if (value == '[')
      {
        Entry entry = {section, name, "", origin};
        for (const auto &[no_name, item] : node)
          entry.list.push_back(item_text(item, origin, name));
        add(entry);
      }
      else
        add({section, name, node.data(), origin});
    }
  }
} // namespace Nodus
