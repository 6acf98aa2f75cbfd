#ifndef nodus_solve_trilinos_outside_multigrid_h
#define nodus_solve_trilinos_outside_multigrid_h

#include <mpi.h>

#include <cstddef>
#include <vector>

namespace Nodus
{
  /// The rows of a symmetric matrix that a rank owns, entry by entry. The three unknowns of a node follow each other;
  /// each rank owns a contiguous range. Columns have local numbers: the owned unknowns first, then others.
  struct AssembledMatrix
  {
    MPI_Comm                 communicator = MPI_COMM_NULL;
    int                      n_owned      = 0;
    std::vector<long long>   unknowns; ///< global number of each column
    std::vector<std::size_t> start;    ///< of the rows, and the number of all entries
    std::vector<int>         column;   ///< ascending in each row, the diagonal among them
    std::vector<double>      value;

    /// Whether the entries of this rank are at the same places.
    bool has_places_of(const AssembledMatrix &other) const
    {
      return start == other.start && unknowns == other.unknowns && column == other.column;
    }
  };

  /// Algebraic multigrid of another library. Each is in a shared library of its own, which the program opens when it is
  /// asked for: neither the program nor this header knows what that is linked to.
  class OutsideMultigrid
  {
  public:
    virtual ~OutsideMultigrid() = default;

    /// Makes the hierarchy of @p A. What the library can keep of the one before, it may keep where the entries are at
    /// the same places. @param modes six of the owned unknowns, one after the other. Collective. @throws std::exception
    virtual void set_up(AssembledMatrix A, const std::vector<double> &modes) = 0;

    /// One cycle on the owned unknowns, symmetric. Collective. @throws std::exception
    virtual void vmult(double *dst, const double *src) const = 0;
  };

  /// The function that a library exports.
  using MakeOutsideMultigrid = OutsideMultigrid *();

  /// Its name, which changes with the classes above, so that no library of another version is taken.
#define NODUS_OUTSIDE_MULTIGRID nodus_outside_multigrid_1
} // namespace Nodus

#endif
