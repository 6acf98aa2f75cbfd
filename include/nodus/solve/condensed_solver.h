#ifndef nodus_solve_condensed_solver_h
#define nodus_solve_condensed_solver_h

#include <nodus/solve/block_solver.h>
#include <nodus/solve/corrected_matrix.h>
#include <nodus/solve/multigrid.h>

#include <memory>
#include <vector>

namespace Nodus
{
  class Condensation;

  /// Conjugate gradients with multigrid on the displacements that are left when condensation.h has eliminated the
  /// multipliers. The hierarchy is kept over several systems while it pays. Systems that cannot be condensed go to the
  /// block solver.
  class CondensedSolver : public LinearSolver
  {
  public:
    CondensedSolver(const LinearSolverParameters &parameters, const RigidBodyData &rigid_body_data);

    Report solve(const LinearSystem &system, BlockVector &solution) override;

  private:
    void         make_multigrid(const LinearSystem &system, const Condensation &condensation);
    bool         hierarchy_fits(const std::vector<char> &signature, MPI_Comm communicator) const;
    unsigned int iterate(const Condensation &condensation, const Vector &rhs, double tolerance, Vector &y) const;

    const LinearSolverParameters     parameters_;
    const RigidBodyData              rigid_body_data_;
    BlockSolver                      block_solver_;
    std::unique_ptr<CorrectedMatrix> matrix_;
    std::unique_ptr<Multigrid>       multigrid_;
    std::vector<char>                signature_; ///< of the system that the hierarchy was made for
    unsigned int                     first_iterations_ = 0, last_iterations_ = 0; ///< with this hierarchy
  };
} // namespace Nodus

#endif
