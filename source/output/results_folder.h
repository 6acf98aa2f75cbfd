#ifndef nodus_output_results_folder_h
#define nodus_output_results_folder_h

#include <mpi.h>

#include <string>

namespace Nodus
{
  /// The folder that a run writes to: it exists, can be written to, holds nothing that a run that was killed left
  /// incomplete, and is this run's alone as long as the object exists.
  class ResultsFolder
  {
  public:
    /// Collective. @throws InputError on every rank when the folder cannot be made or written to, or when another run
    /// holds it.
    ResultsFolder(const std::string &path, MPI_Comm communicator);
    ~ResultsFolder();

    /// Removes what an earlier run has written, but for checkpoints; other files stay. Collective. @returns how many
    /// files.
    unsigned int remove_results() const;

    ResultsFolder(const ResultsFolder &)            = delete;
    ResultsFolder &operator=(const ResultsFolder &) = delete;

  private:
    std::string take(const std::string &path);

    std::string path_;
    MPI_Comm    communicator_;
    int         lock_ = -1; ///< descriptor of the folder, on rank 0; < 0: none
  };
} // namespace Nodus

#endif
