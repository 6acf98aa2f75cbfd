#ifndef nodus_solve_transformation_h
#define nodus_solve_transformation_h

#include "solve/coupling_matrix.h"

#include <array>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Sum of 3x3 blocks, row by row, times the displacements of nodes.
  using NodeRow = std::vector<std::pair<DoFIndex, std::array<double, 9>>>;

  /// Appends rows @p first, first + 1 and first + 2.
  void append_entries(std::vector<MatrixEntry> &entries, DoFIndex first, const NodeRow &row);

  /// u = T y: the displacements of some nodes by those of others; at all other nodes T is the identity.
  class Transformation
  {
  public:
    /// @param rows of the local nodes that are replaced, ascending, the @p n_owned that are owned here first; local
    /// numbers count from the first node of @p displacements. Collective.
    Transformation(std::vector<std::pair<unsigned int, NodeRow>> rows,
                   unsigned int                                  n_owned,
                   const Ownership                              &displacements);

    const std::vector<std::pair<unsigned int, NodeRow>> &rows() const
    {
      return rows_;
    }
    /// x = T x over the owned displacements; keeps what it replaces. Collective.
    void apply(double *x) const;
    /// Puts back what the last apply() replaced.
    void restore(double *x) const;
    /// f = T^T f over the owned displacements. Collective.
    void apply_transposed(double *f) const;

  private:
    const std::vector<std::pair<unsigned int, NodeRow>> rows_;
    const unsigned int                                  n_owned_;
    const CouplingMatrix                                T_;
    mutable std::vector<double>                         values_, kept_; ///< at the owned ones
  };
} // namespace Nodus

#endif
