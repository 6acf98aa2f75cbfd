#ifndef nodus_parameters_plugin_keys_h
#define nodus_parameters_plugin_keys_h

#include "parameters/parameter_checks.h"
#include "parameters/parameter_keys.h"
#include <nodus/plugins/registry.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

// Keys that plug-ins bring. A class that is registered as "Gent" is a choice of the key of its kind, and declares its
// own keys in the subsection "Gent" beside that key.

namespace Nodus
{
  /// Loads what @p text names there, relative to the folder of @p file. @param shipped gives the keys of nodus, whose
  /// names plug-ins may not take. @throws InputError with file and line. @returns the files
  std::vector<std::string> load_plugins(const ParameterFile                             &text,
                                        const std::string                               &file,
                                        const std::function<std::vector<DeclaredKey>()> &shipped);

  /// Without those of classes that are not chosen, by the default values of @p keys.
  std::vector<DeclaredKey> without_idle_plugins(const std::vector<DeclaredKey> &keys);

  namespace ParameterKeys
  {
    /// A registered class and an object of it.
    struct Candidate
    {
      std::string             name, meaning;
      std::shared_ptr<Plugin> object;
    };

    /// Those of a kind, each with a new object; @p chosen, if any, takes the place of that of its name.
    /// @param key, names for which they are choices, and what is shipped
    std::vector<Candidate> candidates(const std::string             &kind,
                                      const std::string             &name,
                                      const std::shared_ptr<Plugin> &chosen,
                                      const std::string             &shipped);

    /// What is said about them behind the documentation of the key.
    std::string meanings(const std::vector<Candidate> &candidates);

    /// Their keys, in subsections of their names. @throws InputError where one declares them wrongly.
    void add_subsections(ParameterHandler &prm, const std::vector<Candidate> &candidates);

    /// A choice between what is shipped and what is registered for the interface; the latter sets @p value to @p own
    /// and
    /// @p chosen to its object.
    template <typename Enum, typename Interface>
    void add_choice(ParameterHandler  &prm,
                    const std::string &key,
                    Enum              &value,
                    const Names<Enum> &names,
                    const Enum         own,
                    Chosen<Interface> &chosen,
                    const std::string &documentation)
    {
      const std::string shipped = selection(names);
      const auto        all     = candidates(Interface::kind, chosen.name, chosen.object, shipped);
      std::string       choices = shipped;
      for (const Candidate &candidate : all)
        choices += '|' + candidate.name;
      prm.declare_entry(key,
                        value == own ? chosen.name : text_of(value, names),
                        Patterns::Selection(choices),
                        documentation + meanings(all));
      prm.add_action(key,
                     [&value, &names, own, &chosen, all](const std::string &text)
                     {
                       for (const Candidate &candidate : all)
                         if (candidate.name == text)
                         {
                           value  = own;
                           chosen = {std::static_pointer_cast<Interface>(candidate.object), text};
                           return;
                         }
                       value = value_of(text, names);
                     });
      add_subsections(prm, all);
    }
  } // namespace ParameterKeys

  namespace ParameterChecks
  {
    /// Plugin::initialize() of what a key in @p section chooses. @throws InputError with file and line of the keys of
    /// the object where it does not like its values.
    void initialize(const Section &section, const std::string &name, Plugin &object);
  } // namespace ParameterChecks
} // namespace Nodus

#endif
