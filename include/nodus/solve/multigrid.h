#ifndef nodus_solve_multigrid_h
#define nodus_solve_multigrid_h

#include <nodus/solve/linear_solver.h>

#include <deal.II/lac/trilinos_precondition.h>

#include <Epetra_RowMatrix.h>

#include <vector>

namespace Nodus
{
  /// Rigid-body modes of all bodies together at the owned displacements: three translations, three rotations, one after
  /// the other; zero where nothing but the diagonal of @p K couples. Collective.
  std::vector<double> rigid_body_modes(const NodeMatrix &K, const RigidBodyData &data);

  /// Smoothed aggregation multigrid (ML), one cycle.
  class Multigrid
  {
  public:
    /// Keeps a reference to @p matrix and a copy of the six @p modes. Collective.
    Multigrid(const Epetra_RowMatrix &matrix, std::vector<double> modes, unsigned int smoother_sweeps);

    void vmult(Vector &dst, const Vector &src) const
    {
      multigrid_.vmult(dst, src);
    }

  private:
    const std::vector<double>                 modes_;
    dealii::TrilinosWrappers::PreconditionAMG multigrid_;
  };
} // namespace Nodus

#endif
