#ifndef nodus_solve_multigrid_h
#define nodus_solve_multigrid_h

#include <nodus/solve/aggregation.h>
#include <nodus/solve/linear_solver.h>

#include <deal.II/lac/trilinos_precondition.h>

#include <array>
#include <vector>

namespace Nodus
{
  /// Rigid-body modes of all bodies together at the owned displacements: three translations, three rotations, one after
  /// the other; zero where nothing but the diagonal of @p K couples. Collective.
  std::vector<double> rigid_body_modes(const NodeMatrix &K, const RigidBodyData &data);

  /// Smoothed aggregation multigrid, one cycle: Chebyshev smoothing with 3x3 diagonal blocks and an aggregation in
  /// blocks on the finest level; ML on the coarse ones.
  class Multigrid
  {
  public:
    /// Keeps a reference to @p A, not to the stiffness @p K of which it was made. @p modes as of rigid_body_modes().
    /// Collective.
    Multigrid(const NodeMatrix          &K,
              const CorrectedMatrix     &A,
              const std::vector<double> &modes,
              unsigned int               smoother_sweeps);

    /// Symmetric. Collective.
    void vmult(Vector &dst, const Vector &src) const;

  private:
    void   make_diagonal(const NodeMatrix &K);
    double largest_eigenvalue() const;
    void   apply_diagonal(double *dst, const double *src) const;
    /// Chebyshev iteration on x with the residual r = b - A x, which it keeps up to date but for the last sweep when
    /// @p last.
    void smooth(double *x, double *r, bool last) const;

    const CorrectedMatrix                      &A_;
    const unsigned int                          sweeps_;
    std::vector<std::array<double, 9>>          D_inverse_;
    double                                      largest_eigenvalue_; ///< of D^-1 A
    std::unique_ptr<Aggregation>                coarse_;
    dealii::TrilinosWrappers::PreconditionAMG   ml_;
    mutable std::vector<double>                 residual_, update_, product_;
    mutable std::unique_ptr<Epetra_MultiVector> coarse_residual_, coarse_correction_;
  };
} // namespace Nodus

#endif
