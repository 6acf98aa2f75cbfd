#ifndef nodus_solve_direct_solver_h
#define nodus_solve_direct_solver_h

#include "solve/coupled_unknowns.h"
#include "solve/flat_vectors.h"
#include "solve/linear_solver.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// Sparse factorisation of the whole system by MUMPS, distributed as it was assembled: of the upper triangle where
  /// the system is symmetric (indefinite). The symbolic analysis is kept while the positions of the entries do not
  /// change. MUMPS gets the unknowns that are coupled to others. Negative pivots are counted in symmetric systems only.
  class DirectSolver : public LinearSolver
  {
  public:
    /// The layout is only used for its communicator and size; each system brings its own.
    explicit DirectSolver(const BlockLayout &layout);
    ~DirectSolver() override;

    using LinearSolver::solve;
    Report solve(const LinearSystem                     &system,
                 const std::vector<const BlockVector *> &rhs,
                 std::vector<BlockVector>               &solutions,
                 double                                  relative_tolerance) override;
    bool   solve_again(const LinearSystem &system, const BlockVector &rhs, BlockVector &solution) override;

    /// LinearSolver::Report::work that solve() would take, from the symbolic analysis, which is kept for it.
    /// Collective.
    /// @throws SolverFailure
    double estimate(const LinearSystem &system);
    /// That of estimate() itself, and what solve() takes of a symmetric system at least, both without contact.
    /// Collective.
    struct LeastWork
    {
      double estimate, solve;
    };
    static LeastWork least_work(const LinearSystem &system);

  private:
    struct Instance;

    /// Refills the triplets with the equilibrated entries, one for each place on this rank. @returns whether the
    /// pattern differs from that of the previous call, on any rank.
    bool collect_entries(const LinearSystem &system, const FlatVectors &flat);

    /// Its size and entries. @returns whether their pattern is new.
    bool take(const LinearSystem &system, const FlatVectors &flat);
    /// Looks for an order of elimination where the pattern is new, and eliminates if it is to.
    void set_up(bool pattern_changed, bool with_factors);
    /// @throws SolverFailure with what MUMPS says.
    [[noreturn]] void give_up(const std::string &where = "");
    /// LinearSolver::Report::work of an elimination with so many operations.
    double work(double n_operations) const;

    /// With the factors at hand. @returns the relative residual.
    double substitute(const FlatVectors &flat, const BlockVector &rhs, BlockVector &solution);

    /// @p x is the right-hand side on entry and the solution on return, on every rank.
    void apply_inverse(std::vector<double> &x);

    /// r = b - A x, all in full length on every rank.
    std::vector<double> residual(const std::vector<double> &b, const std::vector<double> &x) const;

    MPI_Comm                  communicator_;
    int                       size_; ///< number of unknowns
    bool                      symmetric_;
    std::unique_ptr<Instance> instance_;
    std::vector<int>          row_, column_; ///< of this rank's entries, starting at 1
    std::vector<double>       value_;        ///< MUMPS points here and into
    CoupledUnknowns           coupled_;      ///< these
  };
} // namespace Nodus

#endif
