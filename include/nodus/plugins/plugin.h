#ifndef nodus_plugins_plugin_h
#define nodus_plugins_plugin_h

#include <nodus/base/version.h>

#include <deal.II/base/config.h>

#include <memory>
#include <string>
#include <type_traits>

namespace dealii
{
  class ParameterHandler;
}

// What nodus and what it was built with must be alike in nodus and in a plug-in.
#ifdef DEAL_II_WITH_64BIT_INDICES
#  define NODUS_BUILT_WITH_INDICES ", 64-bit indices"
#else
#  define NODUS_BUILT_WITH_INDICES ""
#endif
#ifdef _LIBCPP_VERSION
#  define NODUS_BUILT_WITH_LIBRARY ", libc++"
#elif defined(_GLIBCXX_USE_CXX11_ABI) && _GLIBCXX_USE_CXX11_ABI
#  define NODUS_BUILT_WITH_LIBRARY ""
#else
#  define NODUS_BUILT_WITH_LIBRARY ", old ABI of libstdc++"
#endif
#ifdef DEBUG
#  define NODUS_BUILT_AS ", Debug"
#else
#  define NODUS_BUILT_AS ", Release"
#endif
#define NODUS_BUILT_FOR                                                                                                \
  "nodus " NODUS_VERSION                                                                                               \
  ", deal.II " DEAL_II_PACKAGE_VERSION NODUS_BUILT_WITH_INDICES NODUS_BUILT_WITH_LIBRARY NODUS_BUILT_AS

namespace Nodus
{
  /// What is common to all that users may add by name: a law, an indicator of refinement. The classes derived from it
  /// in include/nodus/plugins/ are the kinds that there are.
  class Plugin
  {
  public:
    Plugin() = default;
    virtual ~Plugin();

    /// Declares the keys of the class, each bound to a member, whose value at that time is the default:
    /// prm.add_parameter("Limit", limit_, "Largest I1 - 3 [-], > 0."). They stand in a subsection of its name beside
    /// the key that chooses it. Called again on an object with values, to compare them with those of a checkpoint: what
    /// initialize() computes goes to other members.
    virtual void add_parameters(dealii::ParameterHandler &prm);

    /// Once, when the members have their values: checks them and computes what follows from them. @throws InputError,
    /// or another std::exception, with the name of the key and the fix; file and line are added.
    virtual void initialize();
  };

  /// The object behind a name: one that the parameter file chooses, or that a program hands over, which then need not
  /// be registered. Copies of the parameters share it; it is not changed after initialize(), which the program calls
  /// itself.
  template <typename Interface>
  struct Chosen
  {
    std::shared_ptr<Interface> object;
    std::string                name = "own"; ///< not that of a registered one, unless it is one of these
  };

  namespace Plugins
  {
    /// Makes a class known under a name, see NODUS_REGISTER. Mistakes come to light when the library is loaded.
    struct Registration
    {
      Registration(const char *built_for, const char *kind, const char *name, const char *meaning, Plugin *(*make)());
    };

    /// @param Class has a default constructor
    template <typename Interface, typename Class>
    Plugin *make()
    {
      static_assert(std::is_base_of<Interface, Class>::value, "the class is not derived from the interface");
      return static_cast<Interface *>(new Class);
    }
  } // namespace Plugins
} // namespace Nodus

#define NODUS_JOIN_AGAIN(a, b) a##b
#define NODUS_JOIN(a, b) NODUS_JOIN_AGAIN(a, b)

/// One line at namespace scope, in a shared library or in a program: the class @p Class, derived from @p Interface, is
/// what
/// @p name in a parameter file chooses; @p meaning is a sentence for the reference of parameters.
#define NODUS_REGISTER(Interface, Class, name, meaning)                                                                \
  static const Nodus::Plugins::Registration NODUS_JOIN(nodus_registration_, __LINE__)(                                 \
      NODUS_BUILT_FOR, Interface::kind, name, meaning, &Nodus::Plugins::make<Interface, Class>)

#endif
