#ifndef nodus_parameters_parameter_file_h
#define nodus_parameters_parameter_file_h

#include "parameters/value_pattern.h"

#include <boost/property_tree/ptree_fwd.hpp>

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace Nodus
{
  /// The key at the top level that names the plug-ins.
  constexpr const char *libraries_key = "Additional shared libraries";

  /// What a ParameterHandler declares, in the order of declaration.
  struct DeclaredKey
  {
    std::string  section; ///< "Body 1/Material"; empty at the top
    std::string  key;
    std::string  default_value;
    ValuePattern pattern; ///< what it takes
    std::string  documentation;

    /// "Body 1/Name"
    std::string path() const
    {
      return section.empty() ? key : section + '/' + key;
    }
    /// What stands in the first square brackets of the documentation; empty without.
    std::string unit() const;
  };

  std::vector<DeclaredKey> declared_keys(const dealii::ParameterHandler &prm);

  /// "Slave " and "Body" make the key "Slave body"; an empty prefix leaves the key alone.
  std::string prefixed(const std::string &prefix, const std::string &key);

  /// The text of a .prm or .json file and of the "--set" overrides as a list of entries that know where they were
  /// written.
  ///
  /// JSON: one object, its subsections are objects in it, values of lists may be arrays; what deal.II's
  /// ParameterHandler prints, short or with documentation, is accepted. ParameterHandler::parse_input() forgets the
  /// lines and lets the last of two equal keys win; going through this list gives every message, also one of a later
  /// check, its file and line.
  class ParameterFile
  {
  public:
    /// @throws InputError: no such file, lines that are none of subsection/end/set, JSON that does not parse, a key or
    /// a subsection twice.
    ParameterFile(const std::string &file, const std::vector<std::string> &overrides);

    /// How many subsections "<name> 1", "<name> 2", ... the file has. @throws InputError on a gap.
    unsigned int count(const std::string &name) const;

    /// Sets every entry. @throws InputError on unknown keys and on values outside of their pattern.
    void apply_to(dealii::ParameterHandler &prm) const;

    /// What the file and the overrides set in @p section.
    std::vector<std::string> keys(const std::string &section) const;
    /// The entries of a list of texts, separated by ','; none where it is not set.
    std::vector<std::string> list(const std::string &section, const std::string &key) const;

    /// Refuses keys in the subsections of plug-ins that no key beside the subsection chooses. @throws InputError
    void refuse_idle_plugins() const;

    /// Throws InputError "file:line: 'section': message", with the line of the section, or of the one around it.
    [[noreturn]] void refuse_section(const std::string &section, const std::string &message) const;
    /// Throws InputError "file:line: 'key' in 'section' message", with the line of the key or else of its section.
    [[noreturn]] void refuse(const std::string &section, const std::string &key, const std::string &message) const;

  private:
    struct Entry
    {
      std::string              section, key, value;
      std::string              origin;    ///< "case.prm:17" or "--set"
      std::vector<std::string> list = {}; ///< of a JSON array, instead of value
    };
    struct JsonKey; ///< where a key stands in a .json file

    void read_prm(std::istream &stream);
    void read_json(std::istream &stream);
    /// @p next: of the keys of the file, the one that the first child of @p object has.
    void read_json_object(const boost::property_tree::ptree    &object,
                          const std::string                    &section,
                          std::vector<JsonKey>::const_iterator &next);
    void open_section(const std::string &section, const std::string &origin);
    void read_statement(const std::string &line, const std::string &origin, std::string &section);
    void add(const Entry &entry);
    void override_with(const std::string &text);
    /// Where the section begins, or the one around it.
    std::string origin_of(std::string section) const;

    std::string                        file_;
    std::vector<Entry>                 entries_;
    std::map<std::string, std::string> sections_; ///< path -> origin
  };
} // namespace Nodus

#endif
