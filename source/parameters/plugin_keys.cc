#include "parameters/plugin_keys.h"
#include <nodus/base/types.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <filesystem>

namespace Nodus
{
  namespace
  {
    using ParameterKeys::Candidate;

    /// Names of sections, keys and choices of nodus itself.
    std::vector<std::string> taken_names(const std::vector<DeclaredKey> &keys)
    {
      std::vector<std::string> names;
      for (const DeclaredKey &key : keys)
      {
        const auto sections = dealii::Utilities::split_string_list(key.section, '/');
        if (std::any_of(sections.begin(), sections.end(), Plugins::is_registered))
          continue; // of another plug-in
        names.insert(names.end(), sections.begin(), sections.end());
        names.push_back(key.key);
        for (const std::string &name : key.pattern.choices)
          if (!Plugins::is_registered(name))
            names.push_back(name);
      }
      return names;
    }

    /// Whether it leaves the subsections that it enters, and no more.
    bool is_balanced(Plugin &object)
    {
      const std::string        here = "here", mark = "end of the keys";
      dealii::ParameterHandler prm;
      prm.enter_subsection(here);
      object.add_parameters(prm);
      prm.declare_entry(mark, "");
      const auto keys = declared_keys(prm);
      return std::any_of(
          keys.begin(), keys.end(), [&](const DeclaredKey &key) { return key.key == mark && key.section == here; });
    }
  } // namespace

  std::vector<std::string> load_plugins(const ParameterFile                             &text,
                                        const std::string                               &file,
                                        const std::function<std::vector<DeclaredKey>()> &shipped)
  {
    std::vector<std::string> libraries;
    for (const std::string &library : text.list("", libraries_key))
    {
      libraries.push_back((std::filesystem::path(file).parent_path() / library).lexically_normal().string());
      try
      {
        Plugins::load(libraries.back(), taken_names(shipped()));
      }
      catch (const InputError &error)
      {
        text.refuse("", libraries_key, std::string("cannot be used: ") + error.what());
      }
    }
    return libraries;
  }

  std::vector<DeclaredKey> without_idle_plugins(const std::vector<DeclaredKey> &keys)
  {
    std::vector<DeclaredKey> used;
    for (const DeclaredKey &key : keys)
    {
      const auto        slash = key.section.rfind('/');
      const std::string name  = key.section.substr(slash + 1);
      const std::string place = slash == std::string::npos ? "" : key.section.substr(0, slash);
      if (!Plugins::is_registered(name) ||
          std::any_of(keys.begin(),
                      keys.end(),
                      [&](const DeclaredKey &other) { return other.section == place && other.default_value == name; }))
        used.push_back(key);
    }
    return used;
  }

  namespace ParameterKeys
  {
    std::vector<Candidate> candidates(const std::string             &kind,
                                      const std::string             &name,
                                      const std::shared_ptr<Plugin> &chosen,
                                      const std::string             &shipped)
    {
      const auto             own_names = dealii::Utilities::split_string_list(shipped, '|');
      bool                   found     = chosen == nullptr;
      std::vector<Candidate> all;
      for (const Plugins::Entry &entry : Plugins::registered(kind))
      {
        if (std::find(own_names.begin(), own_names.end(), entry.name) != own_names.end())
          throw InputError("The " + kind + " '" + entry.name + "' of " +
                           (entry.library.empty() ? "the program" : entry.library) +
                           " has the name of one of nodus's own; give it another name");
        const bool is_chosen = chosen != nullptr && entry.name == name;
        found                = found || is_chosen;
        all.push_back({entry.name, entry.meaning, is_chosen ? chosen : std::shared_ptr<Plugin>(entry.make())});
      }
      if (!found)
        all.push_back({name, "Of the program.", chosen});
      return all;
    }

    std::string meanings(const std::vector<Candidate> &candidates)
    {
      std::string text;
      for (const Candidate &candidate : candidates)
        text += ' ' + candidate.name + ": " + candidate.meaning;
      return text;
    }

    void add_subsections(ParameterHandler &prm, const std::vector<Candidate> &candidates)
    {
      for (const Candidate &candidate : candidates)
        try
        {
          if (!is_balanced(*candidate.object))
            throw InputError("it enters a subsection without leaving it, or the other way round");
          prm.enter_subsection(candidate.name);
          candidate.object->add_parameters(prm);
          prm.leave_subsection();
        }
        catch (const std::exception &error)
        {
          throw InputError("The plug-in '" + candidate.name + "' declares its keys wrongly: " + error.what());
        }
    }
  } // namespace ParameterKeys

  namespace ParameterChecks
  {
    void initialize(const Section &section, const std::string &name, Plugin &object)
    {
      try
      {
        object.initialize();
      }
      catch (const std::exception &error)
      {
        section.file.refuse_section(section.name + '/' + name, error.what());
      }
    }
  } // namespace ParameterChecks
} // namespace Nodus
