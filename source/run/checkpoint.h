#ifndef nodus_run_checkpoint_h
#define nodus_run_checkpoint_h

#include <nodus/base/types.h>

#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <mpi.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Checkpoints of a run, in the folders checkpoints/<increment> of its results; the last two are kept. A folder gets
  /// its name when all that is in it is on the disk.
  ///
  /// index        format, then name, bytes and CRC-32 of every file
  /// common       what all ranks share
  /// piece.0000   values of the cells and slave faces of one rank, by names that do not depend on the ranks
  class Checkpoints
  {
  public:
    /// The folder need not exist.
    Checkpoints(const std::string &results_folder, MPI_Comm communicator);

    /// Renames the folder of an earlier run to checkpoints.before, in place of one that there is already. @returns its
    /// new name, on rank 0, empty where there was none. Collective. @throws InputError
    std::string set_aside();

    struct Piece
    {
      using CellKey = std::array<unsigned int, 4>; ///< CellId::to_binary() with Bodies::coarse_cell() first
      using FaceKey = std::pair<CellKey, unsigned int>;
      std::vector<std::pair<CellKey, std::vector<double>>> cells;
      std::vector<std::pair<CellKey, std::vector<double>>> histories; ///< of cells with a law that has one
      std::vector<std::pair<FaceKey, std::vector<double>>> faces;

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &cells &histories &faces;
      }
    };

    /// @p common: packed, of rank 0. Does nothing when this increment was the last one written. Collective. @throws
    /// InputError when the disk does not take it; older checkpoints are still there then.
    void write(unsigned int increment, const std::vector<char> &common, const Piece &piece);

    struct Found
    {
      unsigned int                       increment;
      std::vector<char>                  common;
      std::vector<std::filesystem::path> pieces;
      std::string                        remark; ///< about damaged ones that were passed over
    };
    /// The newest complete checkpoint, none when there is not any. Collective. @throws InputError when all are damaged
    /// or of another format.
    std::optional<Found> find();
    static Piece         read(const std::filesystem::path &piece);

  private:
    std::string finish(const std::filesystem::path &unfinished, unsigned int increment, const std::string &index);

    std::filesystem::path     folder_;
    MPI_Comm                  communicator_;
    std::vector<unsigned int> kept_; ///< increments of the checkpoints of this run, the newest last
  };
} // namespace Nodus

#endif
