#ifndef nodus_solve_displacement_preconditioner_h
#define nodus_solve_displacement_preconditioner_h

#include "solve/constrained_matrix.h"
#include "solve/displacement_nodes.h"
#include "solve/linear_solver.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// Multigrid on the displacements, nodus's own or that of another library: what the block and the condensed solver
  /// precondition with.
  class DisplacementPreconditioner
  {
  public:
    virtual ~DisplacementPreconditioner() = default;

    /// Sets up for T^T K T + R^T D R + d, in place of what there was before. @p modes as of rigid_body_modes(), in the
    /// unknowns of that matrix. Keeps no reference to @p K and @p nodes. Collective. @throws SolverFailure
    virtual void set_up(const BlockCsrMatrix    &K,
                        Constraints              constraints,
                        std::vector<double>      modes,
                        const DisplacementNodes &nodes) = 0;

    /// Symmetric. Collective. @throws SolverFailure
    virtual void vmult(Vector &dst, const Vector &src) const = 0;

    /// The next use is set_up(): forgets what that does not build on.
    virtual void release() = 0;
  };

  /// @param smoother_sweeps of nodus's own, before and after the coarse correction @throws InputError where the library
  /// is not installed
  std::unique_ptr<DisplacementPreconditioner>
  make_displacement_preconditioner(LinearSolverParameters::Preconditioner choice, unsigned int smoother_sweeps);

  /// Refuses a choice that some rank cannot open. Collective. @throws InputError on every rank
  void require_preconditioner(LinearSolverParameters::Preconditioner choice, MPI_Comm communicator);
} // namespace Nodus

#endif
