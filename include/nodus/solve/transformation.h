#ifndef nodus_solve_transformation_h
#define nodus_solve_transformation_h

#include <nodus/solve/coupling_matrix.h>

#include <vector>

namespace Nodus
{
  /// u = T y: the displacements of some nodes by those of others; at all other nodes T is the identity.
  class Transformation
  {
  public:
    /// @param nodes that are replaced: owned, counted from the first owned one @param entries of T: row 3k + c, counted
    /// from @p nodes owned by lower ranks, is component c of nodes[k]. Collective.
    Transformation(std::vector<unsigned int>       nodes,
                   const std::vector<MatrixEntry> &entries,
                   const Ownership                &rows,
                   const Ownership                &displacements);

    /// x = T x over the owned displacements; keeps what it replaces. Collective.
    void apply(double *x) const;
    /// Puts back what the last apply() replaced.
    void restore(double *x) const;
    /// f = T^T f over the owned displacements. Collective.
    void apply_transposed(double *f) const;

  private:
    const std::vector<unsigned int> nodes_;
    const CouplingMatrix            T_;
    mutable std::vector<double>     values_, kept_; ///< at the nodes
  };
} // namespace Nodus

#endif
