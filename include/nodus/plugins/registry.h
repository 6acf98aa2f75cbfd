#ifndef nodus_plugins_registry_h
#define nodus_plugins_registry_h

#include <nodus/plugins/plugin.h>

#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// The classes that plug-ins and the program have registered, the same for the whole process.
  namespace Plugins
  {
    struct Entry
    {
      std::string kind;    ///< "material law"
      std::string name;    ///< that the parameter file chooses it by
      std::string meaning; ///< a sentence
      std::string library; ///< file that it came with; empty: the program itself
      Plugin *(*make)();
    };

    /// Loads the shared library @p file, which registers its classes; a second time nothing happens.
    /// @throws InputError with the fix: no such file, no shared library, one that is built for another nodus or deal.II
    /// (NODUS_BUILT_FOR), that registers nothing, or a name that is none or that is taken. Nothing of it is registered
    /// then.
    /// @param taken names that no class may have
    void load(const std::string &file, const std::vector<std::string> &taken = {});

    /// Those of one kind, in the order of their names. @throws InputError where the program has registered wrongly.
    std::vector<Entry> registered(const std::string &kind);

    /// Whether some class of any kind has the name.
    bool is_registered(const std::string &name);

    template <typename Interface>
    std::shared_ptr<Interface> make(const Entry &entry)
    {
      return std::shared_ptr<Interface>(static_cast<Interface *>(entry.make()));
    }
  } // namespace Plugins
} // namespace Nodus

#endif
