#include "run/checkpoint.h"
#include "parallel/all_gather.h"
#include "parallel/throw_everywhere.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <boost/crc.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <unistd.h>

namespace Nodus
{
  namespace
  {
    namespace fs = std::filesystem;

    constexpr unsigned int format          = 21;
    constexpr auto         format_line     = "nodus checkpoint ";
    constexpr auto         last_line       = "end";
    constexpr auto         unfinished_mark = ".incomplete";
    constexpr std::size_t  n_kept          = 2;

    unsigned int checksum(const std::vector<char> &bytes)
    {
      boost::crc_32_type crc;
      crc.process_bytes(bytes.data(), bytes.size());
      return crc.checksum();
    }

    /// Waits until a file or the entries of a folder are on the disk. @returns what went wrong.
    std::string synchronize(const fs::path &path)
    {
      const int file = open(path.c_str(), O_RDONLY);
      if (file < 0)
        return "cannot write " + path.string() + ": " + std::strerror(errno);
      const bool done = fsync(file) == 0;
      close(file);
      return done ? "" : "cannot write " + path.string() + ": " + std::strerror(errno);
    }

    std::string write_file(const fs::path &path, const std::vector<char> &bytes)
    {
      std::ofstream file(path, std::ios::binary);
      file.write(bytes.data(), bytes.size());
      file.close();
      return file ? synchronize(path) : "cannot write " + path.string() + ": is the folder writable, is the disk full?";
    }

    /// Nothing where it is no file.
    std::vector<char> read_file(const fs::path &path)
    {
      std::error_code unknown;
      if (!fs::is_regular_file(path, unknown))
        return {};
      std::ifstream file(path, std::ios::binary);
      return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }

    std::string index_entry(const std::string &name, const std::size_t bytes, const unsigned int checksum)
    {
      return name + ' ' + std::to_string(bytes) + ' ' + std::to_string(checksum) + '\n';
    }

    /// @returns what is wrong with a checkpoint, empty when it is complete. @p pieces: its pieces. @throws InputError
    /// when it is of another format.
    std::string damage(const fs::path &checkpoint, std::vector<fs::path> &pieces)
    {
      std::ifstream index(checkpoint / "index");
      std::string   line;
      std::getline(index, line);
      if (line.compare(0, std::strlen(format_line), format_line) != 0)
        return "has no index";
      if (line != format_line + std::to_string(format))
        throw InputError("the checkpoint " + checkpoint.string() + " is of another version of nodus ('" + line +
                         "', this one reads '" + format_line + std::to_string(format) +
                         "'): continue with that version, or begin without --restart");
      pieces.clear();
      bool has_common = false;
      while (std::getline(index, line) && line != last_line)
      {
        std::istringstream entry(line);
        std::string        name;
        std::size_t        bytes = 0;
        unsigned int       crc   = 0;
        if (!(entry >> name >> bytes >> crc) || name.find('/') != std::string::npos)
          return "its index has the line '" + line + "', which names no file";
        if (std::find(pieces.begin(), pieces.end(), checkpoint / name) != pieces.end())
          return "its index has " + name + " twice";
        const std::vector<char> content = read_file(checkpoint / name);
        if (content.size() != bytes)
          return name + " has " + std::to_string(content.size()) + " bytes instead of " + std::to_string(bytes);
        if (checksum(content) != crc)
          return name + " has been changed";
        if (name == "common")
          has_common = true;
        else
          pieces.push_back(checkpoint / name);
      }
      return line == last_line && has_common && !pieces.empty() ? "" : "its index is not complete";
    }

    /// Increments that there are folders of, the newest first.
    std::vector<unsigned int> increments_in(const fs::path &folder)
    {
      std::vector<unsigned int> found;
      std::error_code           ignored;
      for (const auto &entry : fs::directory_iterator(folder, ignored))
      {
        const std::string name = entry.path().filename();
        if (!name.empty() && name.size() < 10 && name.find_first_not_of("0123456789") == std::string::npos)
          found.push_back(std::stoul(name));
      }
      std::sort(found.rbegin(), found.rend());
      return found;
    }

    /// What a run that was killed was about to write.
    void remove_unfinished(const fs::path &folder)
    {
      std::error_code ignored;
      for (const auto &entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == unfinished_mark)
          fs::remove_all(entry.path(), ignored);
    }

    std::string name_of(const unsigned int increment)
    {
      return dealii::Utilities::int_to_string(increment, 6);
    }
  } // namespace

  Checkpoints::Checkpoints(const std::string &results_folder, MPI_Comm communicator)
      : folder_(fs::path(results_folder) / "checkpoints")
      , communicator_(communicator)
  {
  }

  std::string Checkpoints::set_aside()
  {
    fs::path before = folder_;
    before += ".before";
    std::string problem;
    bool        moved = false;
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0 && !increments_in(folder_).empty())
    {
      std::error_code error;
      fs::remove_all(before, error);
      fs::rename(folder_, before, error);
      if (error)
        problem = "cannot rename " + folder_.string() + ": " + error.message();
      moved = !error;
    }
    throw_everywhere<InputError>(problem, communicator_);
    return moved ? before.string() : "";
  }

  void Checkpoints::write(const unsigned int increment, const std::vector<char> &common, const Piece &piece)
  {
    if (!kept_.empty() && kept_.back() == increment)
      return;
    const unsigned int rank       = dealii::Utilities::MPI::this_mpi_process(communicator_);
    const fs::path     unfinished = folder_ / (name_of(increment) + unfinished_mark);
    std::error_code    error;
    std::string        problem;
    if (rank == 0)
    {
      remove_unfinished(folder_);
      if (!fs::create_directories(unfinished, error))
        problem = "cannot create the folder " + unfinished.string() + ": " + error.message();
    }
    throw_everywhere<InputError>(problem, communicator_);

    const std::string       name  = "piece." + dealii::Utilities::int_to_string(rank, 4);
    const std::vector<char> bytes = dealii::Utilities::pack(piece);
    problem                       = write_file(unfinished / name, bytes);
    if (rank == 0 && problem.empty())
      problem = write_file(unfinished / "common", common);

    std::string index = format_line + std::to_string(format) + '\n';
    for (const auto &entry : all_gather(communicator_, index_entry(name, bytes.size(), checksum(bytes))))
      index += entry;
    index += index_entry("common", common.size(), checksum(common)) + last_line + '\n';
    try
    {
      throw_everywhere<InputError>(problem, communicator_);
      throw_everywhere<InputError>(rank == 0 ? finish(unfinished, increment, index) : "", communicator_);
    }
    catch (const InputError &)
    {
      if (rank == 0)
        fs::remove_all(unfinished, error);
      throw;
    }

    kept_.push_back(increment);
    if (kept_.size() > n_kept)
      kept_.erase(kept_.begin());
    if (rank == 0)
      for (const unsigned int other : increments_in(folder_))
        if (std::find(kept_.begin(), kept_.end(), other) == kept_.end())
          fs::remove_all(folder_ / name_of(other), error);
  }

  /// Completes a checkpoint whose pieces are there. @returns what went wrong.
  std::string Checkpoints::finish(const fs::path &unfinished, const unsigned int increment, const std::string &index)
  {
    std::string problem = write_file(unfinished / "index", {index.begin(), index.end()});
    if (problem.empty())
      problem = synchronize(unfinished);
    if (!problem.empty())
      return problem;
    std::error_code error;
    const fs::path  final_name = folder_ / name_of(increment);
    fs::remove_all(final_name, error); // of an earlier run
    fs::rename(unfinished, final_name, error);
    return error ? "cannot write " + final_name.string() + ": " + error.message() : synchronize(folder_);
  }

  std::optional<Checkpoints::Found> Checkpoints::find()
  {
    std::string              problem, remark;
    unsigned int             chosen = dealii::numbers::invalid_unsigned_int;
    std::vector<std::string> names; // of the pieces that its index has
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0)
      try
      {
        remove_unfinished(folder_);
        std::vector<fs::path> pieces;
        for (const unsigned int increment : increments_in(folder_))
        {
          const std::string what = damage(folder_ / name_of(increment), pieces);
          if (what.empty())
          {
            chosen = increment;
            for (const fs::path &piece : pieces)
              names.push_back(piece.filename().string());
            break;
          }
          remark += (remark.empty() ? "" : "; ") + (folder_ / name_of(increment)).string() + " is damaged: " + what;
        }
        if (chosen == dealii::numbers::invalid_unsigned_int && !remark.empty())
          problem = "no checkpoint can be used: " + remark + "; begin without --restart";
      }
      catch (const InputError &error)
      {
        problem = error.what();
      }
    throw_everywhere<InputError>(problem, communicator_);
    chosen = dealii::Utilities::MPI::broadcast(communicator_, chosen);
    if (chosen == dealii::numbers::invalid_unsigned_int)
      return {};

    const fs::path checkpoint = folder_ / name_of(chosen);
    Found          found{chosen, read_file(checkpoint / "common"), {}, remark};
    for (const std::string &name : dealii::Utilities::MPI::broadcast(communicator_, names))
      found.pieces.push_back(checkpoint / name);
    kept_.assign(1, chosen);
    return found;
  }

  Checkpoints::Piece Checkpoints::read(const fs::path &piece)
  {
    return dealii::Utilities::unpack<Piece>(read_file(piece));
  }
} // namespace Nodus
