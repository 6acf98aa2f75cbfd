#include "output/results_folder.h"
#include "parallel/throw_everywhere.h"
#include <nodus/base/types.h>

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace Nodus
{
  namespace
  {
    /// Fields, tables and profile as their writers name them; Diagnosis removes its own files.
    const std::regex results("(bodies|contact)(_[0-9]+([.][0-9]+)?[.]p?vtu|[.]pvd)|"
                             "(contact|masters|reactions|rigid_bodies|preload|points|lines|energy|convergence)[.]csv|("
                             "profile|status)[.]json");
  } // namespace

  ResultsFolder::ResultsFolder(const std::string &path, const MPI_Comm communicator)
      : path_(path)
      , communicator_(communicator)
  {
    std::string problem;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      problem = take(path);
    throw_everywhere<InputError>(problem.empty() ? "" : problem + "; choose another with Output/Results folder",
                                 communicator);
  }

  ResultsFolder::~ResultsFolder()
  {
    if (lock_ >= 0)
      close(lock_);
  }

  unsigned int ResultsFolder::remove_results() const
  {
    unsigned int n = 0;
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0)
    {
      std::error_code                    ignored;
      std::vector<std::filesystem::path> found;
      for (const auto &entry : std::filesystem::directory_iterator(path_, ignored))
        if (entry.is_regular_file(ignored) && std::regex_match(entry.path().filename().string(), results))
          found.push_back(entry.path());
      for (const auto &file : found)
        n += std::filesystem::remove(file, ignored);
    }
    return dealii::Utilities::MPI::broadcast(communicator_, n);
  }

  /// @returns what is in the way.
  std::string ResultsFolder::take(const std::string &path)
  {
    namespace fs = std::filesystem;
    std::error_code error, ignored;
    fs::create_directories(path, error);
    if (!fs::is_directory(path, ignored))
      return "cannot create the results folder " + path + ": " + error.message();

    // The system lifts the lock when the process ends, however it does. Some file systems cannot lock: go without.
    lock_ = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      return "another run is writing to the results folder " + path + ": wait for its end";

    if (const fs::path checkpoints = fs::path(path) / "checkpoints";
        fs::exists(checkpoints, ignored) && !fs::is_directory(checkpoints, ignored))
      return checkpoints.string() + " is no folder, but checkpoints of the run go there: remove it";
    for (const auto &entry : fs::directory_iterator(path, ignored))
      if (entry.is_directory(ignored) && std::regex_match(entry.path().filename().string(), results))
        return entry.path().string() + " is a folder, but the run writes a file of this name: remove it";
    const fs::path probe = fs::path(path) / ".writable";
    if (!std::ofstream(probe))
      return "cannot write in the results folder " + path;
    fs::remove(probe, ignored);
    for (const auto &entry : fs::directory_iterator(path, ignored))
      if (entry.path().extension() == ".incomplete")
        fs::remove(entry.path(), ignored);
    return "";
  }
} // namespace Nodus
