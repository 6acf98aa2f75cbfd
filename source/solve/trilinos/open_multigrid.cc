#include "solve/trilinos/open_multigrid.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

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

    /// Where the program looks for libraries.
    std::vector<std::string> search_path()
    {
      std::vector<std::string> folders;
      void *const              program = dlopen(nullptr, RTLD_NOW);
      Dl_serinfo               size;
      if (!program || dlinfo(program, RTLD_DI_SERINFOSIZE, &size) != 0)
        return folders;
      std::vector<std::max_align_t> memory(size.dls_size / sizeof(std::max_align_t) + 1);
      auto *const                   info = reinterpret_cast<Dl_serinfo *>(memory.data());
      if (dlinfo(program, RTLD_DI_SERINFOSIZE, info) == 0 && dlinfo(program, RTLD_DI_SERINFO, info) == 0)
        for (unsigned int i = 0; i < info->dls_cnt; ++i)
          folders.emplace_back(info->dls_serpath[i].dls_name);
      return folders;
    }

    /// UCX, which some builds of Open MPI use, calls dlopen in our stead, and then only its own folders are searched:
    /// the file is found here. @returns null, with dlerror(), where it is not.
    void *open(const std::string &file)
    {
      for (const std::string &folder : search_path())
      {
        std::error_code unknown;
        if (const auto path = std::filesystem::path(folder) / file; std::filesystem::exists(path, unknown))
          return dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
      }
      return dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL); // in the cache of the linker, or not at all
    }

    /// Stays open as long as the program. @throws InputError
    MakeOutsideMultigrid *find(const LinearSolverParameters::Preconditioner choice)
    {
      const auto [file, package] = library(choice);
      const std::string key      = "'Preconditioner' in 'Linear solver' is '" + text_of(choice) + "', but ";
      void *const       handle   = open(file);
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
