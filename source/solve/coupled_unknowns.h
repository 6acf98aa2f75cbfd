#ifndef nodus_solve_coupled_unknowns_h
#define nodus_solve_coupled_unknowns_h

#include <mpi.h>

#include <vector>

namespace Nodus
{
  /// Divides the unknowns of a matrix into those that are coupled to others and those that are alone, with nothing but
  /// an entry on the diagonal: prescribed displacements, multipliers of nodes without partner. In general contact these
  /// may be most, and a nested dissection takes longer for them than for all others.
  class CoupledUnknowns
  {
  public:
    /// Of a matrix of @p size rows, of which this rank has entries at @p row and @p column, numbered from 1. At least
    /// one unknown counts as coupled. Collective.
    void find(int size, const std::vector<int> &row, const std::vector<int> &column, MPI_Comm communicator);
    /// Takes the diagonal entries of what is alone from the @p value of the entries. Collective.
    void take_diagonal(const std::vector<int> &row, const std::vector<double> &value, MPI_Comm communicator);

    /// Rows and columns of the entries of find() among the coupled unknowns, from 1; 0: of one that is alone.
    std::vector<int> row, column;

    int size() const
    {
      return static_cast<int>(coupled_.size());
    }
    /// The unknown, from 0, that is number @p i of those that are coupled, from 1.
    int unknown(const int i) const
    {
      return coupled_[i - 1];
    }
    /// The part of a vector of all unknowns.
    std::vector<double> part(const std::vector<double> &x) const;
    /// Solves for what is alone, 0 for null pivots, with right-hand side @p x; the others get their part @p y.
    void solve(const std::vector<double> &y, std::vector<double> &x) const;
    /// Of what is alone.
    int              n_negative() const;
    std::vector<int> null_pivots() const; ///< from 0

  private:
    std::vector<int>    coupled_;
    std::vector<int>    number_;   ///< of each unknown among these, from 1; 0: alone
    std::vector<double> diagonal_; ///< of each that is alone
  };
} // namespace Nodus

#endif
