#ifndef nodus_solve_bordered_system_h
#define nodus_solve_bordered_system_h

#include "solve/linear_solver.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <functional>
#include <vector>

namespace Nodus
{
  /// A LinearSystem with its border (eq. M1),
  ///
  ///     [ A  B ] [ x ]   [ a ]
  ///     [ C  D ] [ q ] = [ b ],   q = P y + p,
  ///
  /// where few components y of the motions q of rigid bodies are unknown, and as many of the lower equations count. It
  /// is solved by solving with A for a - B p and for the columns of B P, and then for y in the Schur complement: A, in
  /// which the rigid bodies stand still, is regular where the whole is, and any LinearSolver will do.
  class BorderedSystem
  {
  public:
    /// Takes the border of @p system apart; keeps a reference to that. Collective.
    explicit BorderedSystem(const LinearSystem &system);

    /// Solves A x = rhs for several right-hand sides.
    using Solve =
        std::function<LinearSolver::Report(const std::vector<const BlockVector *> &rhs, std::vector<BlockVector> &x)>;

    /// a, and p and b of all motions.
    struct RightHandSide
    {
      const BlockVector     *a;
      dealii::Vector<double> p, b;
    };
    /// @param P of the motions; @param rows the equations that count, as many as P has columns; @param rhs at least
    /// one. Collective.
    void eliminate(const Solve                      &solve,
                   const dealii::FullMatrix<double> &P,
                   const std::vector<unsigned int>  &rows,
                   const std::vector<RightHandSide> &rhs);

    /// Of A.
    const LinearSolver::Report &report() const
    {
      return report_;
    }
    /// The equations for y that are left: matrix, and each right-hand side.
    const dealii::FullMatrix<double> &schur_complement() const
    {
      return S_;
    }
    const dealii::Vector<double> &rhs(const unsigned int k) const
    {
      return s_[k];
    }
    /// x of right-hand side @p k at @p y.
    void expand(unsigned int k, const dealii::Vector<double> &y, BlockVector &x) const;

  private:
    const LinearSystem                 &system_;
    std::vector<BlockVector>            B_, C_; ///< columns and rows
    dealii::FullMatrix<double>          D_, S_;
    std::vector<dealii::Vector<double>> s_; ///< of each right-hand side
    std::vector<BlockVector>            x_; ///< of each at y = 0, then minus the derivatives by each y
    LinearSolver::Report                report_;
  };
} // namespace Nodus

#endif
