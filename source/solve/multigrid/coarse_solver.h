#ifndef nodus_solve_multigrid_coarse_solver_h
#define nodus_solve_multigrid_coarse_solver_h

#include "solve/block_csr_matrix.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <vector>

namespace Nodus
{
  /// Solves exactly on the coarsest level of the multigrid. Every rank has the whole matrix and its factors: that takes
  /// less time than to share the few unknowns out.
  class CoarseSolver
  {
  public:
    /// @p matrix: symmetric; where it is singular, what it leaves free stays as it is. Collective.
    explicit CoarseSolver(const BlockCsrMatrix &matrix);

    /// Both have the owned unknowns of the matrix. Collective.
    void solve(const std::vector<double> &residual, std::vector<double> &correction) const;

  private:
    void factorise_dense(const std::vector<std::vector<double>> &entries);
    void factorise_sparse(const std::vector<std::vector<double>> &entries);

    MPI_Comm                                           communicator_;
    std::vector<int>                                   count_, start_; ///< unknowns of each rank, and the first of them
    unsigned int                                       n_;
    Eigen::LLT<Eigen::MatrixXd>                        positive_;   ///< up to some size,
    Eigen::LDLT<Eigen::MatrixXd>                       indefinite_; ///< where that finds no factors,
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> sparse_;     ///< and beyond
    mutable Eigen::VectorXd                            values_;
  };
} // namespace Nodus

#endif
