#include "solve/trilinos/open_multigrid.h"

#include <string>

#include <dlfcn.h>

namespace Nodus
{
  namespace
  {
#define NODUS_TEXT_OF(name) #name
#define NODUS_NAME_OF(name) NODUS_TEXT_OF(name)

    struct Library
    {
      const char *file, *package;
    };

    Library library(const LinearSolverParameters::Preconditioner choice)
    {
      using Preconditioner = LinearSolverParameters::Preconditioner;
      return choice == Preconditioner::ml ? Library{"libnodus_ml.so", "libtrilinos-ml-dev"}
                                          : Library{"libnodus_muelu.so", "libtrilinos-muelu-dev"};
    }

    /// Stays open as long as the program. @throws InputError
    MakeOutsideMultigrid *find(const LinearSolverParameters::Preconditioner choice)
    {
      const auto [file, package] = library(choice);
      const std::string key      = "'Preconditioner' in 'Linear solver' is '" + text_of(choice) + "', but ";
      void *const       handle   = dlopen(file, RTLD_NOW | RTLD_LOCAL);
      if (!handle)
      {
        const char *const reason = dlerror();
        throw InputError(key + "this build of nodus comes without it (" + (reason ? reason : file) +
                         "); install the package " + package + " and build nodus anew, or give nodus");
      }
      const auto make = reinterpret_cast<MakeOutsideMultigrid *>(dlsym(handle, NODUS_NAME_OF(NODUS_OUTSIDE_MULTIGRID)));
      if (!make)
        throw InputError(key + file + " is that of another version of nodus; install both from the same build");
      return make;
    }
  } // namespace

  std::unique_ptr<OutsideMultigrid> open_multigrid(const LinearSolverParameters::Preconditioner choice)
  {
    return std::unique_ptr<OutsideMultigrid>(find(choice)());
  }
} // namespace Nodus
