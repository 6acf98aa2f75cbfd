#include <nodus/base/types.h>
#include <nodus/plugins/registry.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include <dlfcn.h>

namespace Nodus
{
  Plugin::~Plugin() = default;

  void Plugin::add_parameters(dealii::ParameterHandler & /*prm*/)
  {
  }

  void Plugin::initialize()
  {
  }

  namespace
  {
    struct Registry
    {
      std::vector<Plugins::Entry> entries;
      /// What is being registered: by the library that is loaded, or by the program before it starts.
      std::vector<Plugins::Entry>        arriving;
      std::string                        mistake;   ///< the first one among these; a sentence about the library
      std::map<std::string, std::string> libraries; ///< that were loaded, with what is wrong with them
    };

    /// Libraries register before main() begins.
    Registry &registry()
    {
      static Registry it;
      return it;
    }

    /// The characters that mean something in a parameter file, a list or a pattern of deal.II are left out.
    bool is_name(const std::string &name)
    {
      const auto allowed = [](const unsigned char c)
      { return std::isalnum(c) || c >= 128 || std::string(" -_'.+()").find(c) != std::string::npos; };
      return !name.empty() && std::all_of(name.begin(), name.end(), allowed) && name.front() != ' ' &&
             name.back() != ' ' && name.find("  ") == std::string::npos;
    }

    std::string clash(const Plugins::Entry &entry, const std::vector<Plugins::Entry> &others)
    {
      for (const Plugins::Entry &other : others)
        if (other.kind == entry.kind && other.name == entry.name)
          return "registers the " + entry.kind + " '" + entry.name + "', which " +
                 (other.library == entry.library ? "it has registered before"
                  : other.library.empty()        ? "the program has registered"
                                                 : other.library + " has registered") +
                 "; give one of the two another name";
      return "";
    }

    /// Takes over what has arrived. @returns what is wrong with it, a sentence about the library
    std::string take_over(const std::string &library, const std::vector<std::string> &taken)
    {
      Registry &r       = registry();
      auto      entries = std::move(r.arriving);
      auto      mistake = std::move(r.mistake);
      r.arriving.clear();
      r.mistake.clear();
      auto all = r.entries;
      for (Plugins::Entry &entry : entries)
      {
        entry.library = library;
        if (mistake.empty() && !is_name(entry.name))
          mistake = "registers the " + entry.kind + " '" + entry.name +
                    "'; a name has letters, digits, single blanks and any of -_'.+() ";
        if (mistake.empty())
          mistake = clash(entry, all);
        if (mistake.empty() && std::find(taken.begin(), taken.end(), entry.name) != taken.end())
          mistake = "registers the " + entry.kind + " '" + entry.name +
                    "', which is a name of nodus's own; give it another name";
        all.push_back(entry);
      }
      if (mistake.empty())
        r.entries = std::move(all);
      return mistake;
    }

    /// @returns what is wrong with the library, a sentence about it. @throws InputError with such a sentence where it
    /// has not been loaded at all
    std::string load_once(const std::string &file, const std::vector<std::string> &taken)
    {
      std::error_code unknown;
      if (!std::filesystem::is_regular_file(file, unknown))
        throw InputError("is no file; give the path of a shared library (in a .prm file relative to its folder)");
      if (dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD))
        return ""; // linked to the program: it has registered already
      // It stays: objects of its classes may live as long as the process.
      if (!dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL))
      {
        const char *const reason = dlerror();
        std::string       text   = reason ? reason : "the reason is unknown";
        if (text.compare(0, file.size() + 2, file + ": ") == 0)
          text.erase(0, file.size() + 2);
        registry().arriving.clear();
        registry().mistake.clear();
        throw InputError("cannot be loaded: " + text +
                         (text.find("undefined symbol") != std::string::npos
                              ? "; build it with the headers of this version of nodus (" NODUS_BUILT_FOR
                                "), and link it to the libraries that it uses"
                              : "; give a shared library, built for this machine"));
      }
      if (registry().arriving.empty() && registry().mistake.empty())
        return "registers nothing; it needs a line such as NODUS_REGISTER_MATERIAL(...), or is no plug-in of nodus";
      return take_over(file, taken);
    }
  } // namespace

  Plugins::Registration::Registration(const char *const built_for,
                                      const char *const kind,
                                      const char *const name,
                                      const char *const meaning,
                                      Plugin *(*const make)())
  {
    Registry &r = registry();
    if (const std::string theirs = built_for; theirs != NODUS_BUILT_FOR)
    {
      if (r.mistake.empty())
        r.mistake =
            "is built for " + theirs + ", and this is " NODUS_BUILT_FOR "; build it anew with the headers of this";
      return;
    }
    r.arriving.push_back({kind, name, meaning, "", make});
  }

  void Plugins::load(const std::string &file, const std::vector<std::string> &taken)
  {
    Registry &r = registry();
    registered(""); // what the program has registered by itself is no part of the library
    std::error_code   unknown;
    const std::string path = std::filesystem::weakly_canonical(file, unknown).string();
    try
    {
      if (r.libraries.count(path) == 0)
        r.libraries.emplace(path, load_once(path, taken));
      if (!r.libraries[path].empty())
        throw InputError(r.libraries[path]);
    }
    catch (const InputError &error)
    {
      throw InputError(file + ' ' + error.what());
    }
  }

  std::vector<Plugins::Entry> Plugins::registered(const std::string &kind)
  {
    Registry &r = registry();
    if (const std::string mistake = take_over("", {}); !mistake.empty())
      throw InputError("The program " + mistake);
    std::vector<Entry> entries;
    std::copy_if(r.entries.begin(),
                 r.entries.end(),
                 std::back_inserter(entries),
                 [&](const Entry &entry) { return entry.kind == kind; });
    std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) { return a.name < b.name; });
    return entries;
  }

  bool Plugins::is_registered(const std::string &name)
  {
    const auto &entries = registry().entries;
    return std::any_of(entries.begin(), entries.end(), [&](const Entry &entry) { return entry.name == name; });
  }
} // namespace Nodus
