#include <nodus/parameter_file.h>
#include <nodus/parameters.h>

#include <deal.II/base/parameter_handler.h>

#include <regex>

namespace Nodus
{
  namespace
  {
    /// "Body 1/Material" -> "Body <n> / Material", and what would end a cell of a Markdown table escaped.
    std::string title_of(const std::string &section)
    {
      const std::string numbered = std::regex_replace(section, std::regex(" 1(?=/|$)"), " `<n>`");
      return std::regex_replace(numbered, std::regex("/"), " / ");
    }

    std::string cell(const std::string &text)
    {
      const std::string escaped = std::regex_replace(text, std::regex("[|<>*]"), "\\$&");
      return escaped.empty() ? " " : ' ' + escaped + ' ';
    }
  } // namespace

  std::string Parameters::documentation()
  {
    Parameters parameters;
    parameters.bodies.resize(1);
    parameters.boundary_conditions.resize(1);
    parameters.contact_pairs.resize(1);
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm);

    std::string text    = R"(# Parameters

Written by `nodus --document`; edit the descriptions in source/parameters*.cc.

A case is a text file. `set Key = value` sets a key, `subsection Name` ... `end` enclose the keys of a section, `#`
starts a comment and a `\` at the end of a line continues it. Bodies, boundary conditions and contact pairs are
numbered 1, 2, 3, ... without gaps. Unknown keys, keys set twice and values out of range are refused. On the command
line `--set "Section/Key=value"` replaces a value of the file, for example
`--set "Body 1/Material/Poisson's ratio=0.4"`.

Units are yours to choose, but consistently: N, mm and MPa, or N, m and Pa. The time t orders the loads and has no
unit. Expressions may use x, y, z (reference coordinates), t where a value depends on time, `pi` and the functions of
muParser and deal.II's FunctionParser.
)";
    std::string section = "none yet";
    for (const auto &key : declared_keys(prm))
    {
      if (key.section != section)
        text += "\n## " + (key.section.empty() ? "Top level" : title_of(key.section)) +
                "\n\n| Key | Default | Allowed | Meaning |\n|---|---|---|---|\n";
      section = key.section;
      text += '|' + cell(key.key) + '|' + cell(key.default_value) + '|' + cell(key.allowed) + '|' +
              cell(key.documentation) + "|\n";
    }
    return text;
  }
} // namespace Nodus
