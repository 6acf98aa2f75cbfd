#ifndef nodus_solve_block_preconditioner_h
#define nodus_solve_block_preconditioner_h

#include "solve/displacement_preconditioner.h"
#include "solve/saddle_point_operator.h"

#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <vector>

namespace Nodus
{
  /// Augmented block preconditioner of a SaddlePointOperator (eq. M3): with D = node-diagonal blocks of C, plus k/gamma
  /// where the multiplier is coupled to displacements, k being the stiffness that it sees (eq. M2), it applies
  ///
  ///     u = AMG(f + B^T D^-1 g),   AMG: a cycle on K + B^T D^-1 B,
  ///     m = D^-1 (B u - g),
  ///
  /// the inverse, up to AMG, of the system with D in place of C. gamma is the augmentation factor, a number without
  /// unit; open nodes have D = C and are solved exactly.
  class BlockPreconditioner
  {
  public:
    /// Keeps references to @p system and @p multigrid, which it sets up. Collective.
    BlockPreconditioner(const SaddlePointOperator  &system,
                        double                      augmentation_factor,
                        const DisplacementNodes    &nodes,
                        DisplacementPreconditioner &multigrid);
    BlockPreconditioner(const BlockPreconditioner &)            = delete;
    BlockPreconditioner &operator=(const BlockPreconditioner &) = delete;
    ~BlockPreconditioner()
    {
      multigrid_.release();
    }

    void vmult(BlockVector &dst, const BlockVector &src) const;

  private:
    void        make_multiplier_blocks(double augmentation_factor);
    Constraints augmentation() const;

    /// D^-1 times @p m, in place.
    void apply_multiplier_blocks(double *m) const;

    const SaddlePointOperator         &system_;
    DisplacementPreconditioner        &multigrid_;
    std::vector<std::array<double, 9>> D_inverse_; ///< per owned slave node, row by row
    mutable Vector                     augmented_rhs_;
    mutable std::vector<double>        multiplier_part_;
  };
} // namespace Nodus

#endif
