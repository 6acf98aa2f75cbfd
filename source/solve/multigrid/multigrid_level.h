#ifndef nodus_solve_multigrid_multigrid_level_h
#define nodus_solve_multigrid_multigrid_level_h

#include "solve/displacement_nodes.h"
#include "solve/multigrid/transfer.h"

#include <array>
#include <memory>
#include <vector>

namespace Nodus
{
  /// One level of Multigrid: Chebyshev smoothing with 3x3 diagonal blocks, and the transfer to the next coarser level.
  class MultigridLevel
  {
  public:
    /// Keeps a reference to @p A, not to @p K of which it was made. @p modes of the owned unknowns, six one after the
    /// other. @p corners of degree 2, from which the next level has degree 1; null: it has aggregates.
    /// Collective.
    MultigridLevel(const BlockCsrMatrix    &K,
                   const ConstrainedMatrix &A,
                   std::vector<double>      modes,
                   const DisplacementNodes *corners,
                   unsigned int             smoother_sweeps);

    Transfer &transfer()
    {
      return *transfer_;
    }
    /// Sweeps on A x = b from x = 0 and hands the residual to @p coarse. Collective.
    void pre_smooth(double *x, const double *b, double *coarse) const;
    /// Adds the correction @p coarse and sweeps again. Collective.
    void post_smooth(double *x, const double *b, const double *coarse) const;

  private:
    void   make_diagonal(const BlockCsrMatrix &K);
    double largest_eigenvalue() const;
    void   apply_diagonal(double *dst, const double *src) const;
    /// Chebyshev iteration on x with the residual r = b - A x, which it keeps up to date but for the last sweep when
    /// @p last.
    void smooth(double *x, double *r, bool last) const;

    const ConstrainedMatrix           &A_;
    const unsigned int                 sweeps_;
    std::vector<std::array<double, 9>> D_inverse_;
    double                             largest_eigenvalue_; ///< of D^-1 A
    std::unique_ptr<Transfer>          transfer_;
    mutable std::vector<double>        residual_, update_, product_;
  };
} // namespace Nodus

#endif
