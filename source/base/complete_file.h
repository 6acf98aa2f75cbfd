#ifndef nodus_base_complete_file_h
#define nodus_base_complete_file_h

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
} // namespace Nodus

#endif
