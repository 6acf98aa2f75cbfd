#ifndef nodus_solve_multigrid_multigrid_h
#define nodus_solve_multigrid_multigrid_h

#include "solve/displacement_nodes.h"
#include "solve/linear_solver.h"
#include "solve/multigrid/coarse_solver.h"
#include "solve/multigrid/multigrid_level.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// Rigid-body modes of all bodies together at the owned displacements: three translations, three rotations, one after
  /// the other; zero where nothing but the diagonal of @p K couples. Collective.
  std::vector<double> rigid_body_modes(const BlockCsrMatrix &K, const std::vector<Point> &node_positions);

  /// One V cycle: from displacements of degree 2 to those of degree 1, smoothed aggregation below, levels in node
  /// blocks down to 400 unknowns, which are solved exactly (section 27).
  class Multigrid
  {
  public:
    /// Keeps a reference to @p A, not to the stiffness @p K of which it was made. @p modes as of rigid_body_modes().
    /// Collective.
    Multigrid(const BlockCsrMatrix    &K,
              const ConstrainedMatrix &A,
              std::vector<double>      modes,
              const DisplacementNodes &nodes,
              unsigned int             smoother_sweeps);

    /// Symmetric. Collective.
    void vmult(Vector &dst, const Vector &src) const;

  private:
    struct Level
    {
      std::unique_ptr<ConstrainedMatrix> matrix; ///< of the coarse levels
      std::unique_ptr<MultigridLevel>    level;
      mutable std::vector<double>        coarse_residual, coarse_correction; ///< of the next level
    };

    std::unique_ptr<BlockCsrMatrix> add_level(const BlockCsrMatrix              &K,
                                              std::unique_ptr<ConstrainedMatrix> owned,
                                              const ConstrainedMatrix           *A,
                                              std::vector<double>               &modes,
                                              const DisplacementNodes           *corners,
                                              unsigned int                       smoother_sweeps);

    std::vector<Level>            levels_;
    std::unique_ptr<CoarseSolver> coarsest_;
  };
} // namespace Nodus

#endif
