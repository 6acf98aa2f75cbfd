#ifndef nodus_base_complete_file_h
#define nodus_base_complete_file_h

#include <nodus/base/types.h>

#include <deal.II/base/mpi.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <system_error>

namespace Nodus
{
  /// A text file that appears under its name complete or not at all: written under a temporary name, renamed by
  /// finish(). Not collective; failures are kept as a text, because the other ranks must hear of them before anyone
  /// throws.
  class CompleteFile
  {
  public:
    CompleteFile(const std::string &folder, const std::string &name)
        : name_((std::filesystem::path(folder) / name).string())
        , temporary_(name_ + ".incomplete")
        , stream_(temporary_)
    {
      stream_.precision(std::numeric_limits<double>::max_digits10);
    }

    ~CompleteFile()
    {
      if (!finished_)
      {
        std::error_code ignored;
        std::filesystem::remove(temporary_, ignored);
      }
    }

    CompleteFile(const CompleteFile &)            = delete;
    CompleteFile &operator=(const CompleteFile &) = delete;

    std::ostream &stream()
    {
      return stream_;
    }

    /// Empty when the file is in place, otherwise what went wrong.
    std::string finish()
    {
      stream_.close();
      if (!stream_)
        return "cannot write " + name_ + ": is the folder writable, is the disk full?";
      std::error_code error;
      std::filesystem::rename(temporary_, name_, error);
      if (error)
        return "cannot write " + name_ + ": " + error.message();
      finished_ = true;
      return "";
    }

  private:
    std::string   name_, temporary_;
    std::ofstream stream_;
    bool          finished_ = false;
  };

  /// @throws InputError on every rank when any rank's @p problem is not empty. Collective.
  inline void throw_on_every_rank(const std::string &problem, MPI_Comm communicator)
  {
    for (const std::string &text : dealii::Utilities::MPI::all_gather(communicator, problem))
      if (!text.empty())
        throw InputError(text);
  }

  /// Creates @p folder, tries to write in it and removes what a run that was killed left incomplete, from rank 0.
  /// Collective. @throws InputError on every rank.
  inline void make_results_folder(const std::string &folder, MPI_Comm communicator)
  {
    std::string problem;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    {
      std::error_code error;
      std::filesystem::create_directories(folder, error);
      const std::filesystem::path probe = std::filesystem::path(folder) / ".writable";
      if (!std::filesystem::is_directory(folder))
        problem = "cannot create the results folder " + folder + ": " + error.message();
      else if (!std::ofstream(probe))
        problem = "cannot write in the results folder " + folder;
      std::filesystem::remove(probe, error);
      for (const auto &entry : std::filesystem::directory_iterator(folder, error))
        if (entry.path().extension() == ".incomplete")
          std::filesystem::remove(entry.path(), error);
      if (!problem.empty())
        problem += "; choose another with Output/Results folder";
    }
    throw_on_every_rank(problem, communicator);
  }
} // namespace Nodus

#endif
