#ifndef nodus_parallel_ownership_h
#define nodus_parallel_ownership_h

#include <nodus/base/types.h>

#include <deal.II/base/index_set.h>

#include <mpi.h>

#include <vector>

namespace Nodus
{
  /// An entry of a distributed matrix, on its way to the rank that owns the row.
  struct MatrixEntry
  {
    DoFIndex row, column;
    double   value;

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &row &column &value;
    }
  };

  /// Contiguous index ranges of the ranks, known to every rank.
  class Ownership
  {
  public:
    Ownership(const dealii::IndexSet &owned, MPI_Comm communicator);
    /// @p n_owned indices here, numbered through from rank to rank. Collective.
    Ownership(unsigned int n_owned, MPI_Comm communicator);

    unsigned int owner(DoFIndex i) const;

    /// The owned indices number @p factor times as many when each one is replaced by that many consecutive ones.
    Ownership times(unsigned int factor) const;

    dealii::IndexSet owned() const;
    /// The first owned index, and the one behind the last.
    DoFIndex begin() const
    {
      return start_[rank_];
    }
    DoFIndex end() const
    {
      return start_[rank_ + 1];
    }
    /// First index of each rank, and the number of all.
    const std::vector<DoFIndex> &start() const
    {
      return start_;
    }
    MPI_Comm communicator() const
    {
      return communicator_;
    }

    /// Adds up the entries of all ranks and keeps the rows owned here, sorted by row and column. Collective.
    std::vector<MatrixEntry> exchange(std::vector<MatrixEntry> entries) const;

  private:
    void sort(std::vector<MatrixEntry> &entries) const;

    std::vector<DoFIndex> start_;
    MPI_Comm              communicator_;
    unsigned int          rank_;
  };
} // namespace Nodus

#endif
