#include "solve/multigrid/coarse_solver.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Levels that do not coarsen, of hundreds of bodies, have more unknowns, which couple within bodies alone.
    constexpr unsigned int largest_dense = 1200;
    /// What is added to the diagonal of sparse matrices, relative to the largest entry: singular ones have factors
    /// then.
    constexpr double shift = 1e-12;
  } // namespace

  CoarseSolver::CoarseSolver(const BlockCsrMatrix &matrix)
      : communicator_(matrix.map().communicator())
      , n_(dim * matrix.map().n_global())
      , values_(n_)
  {
    const NodeMap &nodes = matrix.map();
    for (const auto n : all_gather(communicator_, dim * nodes.n_owned()))
    {
      start_.push_back(start_.empty() ? 0 : start_.back() + count_.back());
      count_.push_back(n);
    }
    std::vector<double> entries; // of the lower triangle: row, column, value
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      matrix.for_row(i,
                     [&](const unsigned int j, const double *block, const bool transposed)
                     {
                       for (unsigned int c = 0; c < dim; ++c)
                         for (unsigned int d = 0; d < dim; ++d)
                           if (const DoFIndex row = dim * nodes.global(i) + c, column = dim * nodes.global(j) + d;
                               column <= row)
                             for (const double number : {static_cast<double>(row),
                                                         static_cast<double>(column),
                                                         block[transposed ? dim * d + c : dim * c + d]})
                               entries.push_back(number);
                     });
    const auto of_all = all_gather(communicator_, entries);
    if (n_ <= largest_dense)
      factorise_dense(of_all);
    else
      factorise_sparse(of_all);
  }

  void CoarseSolver::factorise_dense(const std::vector<std::vector<double>> &entries)
  {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n_, n_);
    for (const std::vector<double> &part : entries)
      for (std::size_t k = 0; k < part.size(); k += 3)
        A(static_cast<unsigned int>(part[k]), static_cast<unsigned int>(part[k + 1])) += part[k + 2];
    positive_.compute(A);
    if (positive_.info() != Eigen::Success)
      indefinite_.compute(A);
  }

  void CoarseSolver::factorise_sparse(const std::vector<std::vector<double>> &entries)
  {
    std::vector<Eigen::Triplet<double>> triplets;
    double                              largest = 0.;
    for (const std::vector<double> &part : entries)
      for (std::size_t k = 0; k < part.size(); k += 3)
      {
        triplets.emplace_back(static_cast<int>(part[k]), static_cast<int>(part[k + 1]), part[k + 2]);
        largest = std::max(largest, std::abs(part[k + 2]));
      }
    Eigen::SparseMatrix<double> A(n_, n_);
    A.setFromTriplets(triplets.begin(), triplets.end());
    sparse_.setShift(shift * largest);
    sparse_.compute(A);
    if (sparse_.info() != Eigen::Success)
      throw SolverFailure("Multigrid: the matrix of the coarsest level has no factors.");
  }

  void CoarseSolver::solve(const std::vector<double> &residual, std::vector<double> &correction) const
  {
    MPI_Allgatherv(residual.data(),
                   static_cast<int>(residual.size()),
                   MPI_DOUBLE,
                   values_.data(),
                   count_.data(),
                   start_.data(),
                   MPI_DOUBLE,
                   communicator_);
    if (n_ > largest_dense)
      values_ = sparse_.solve(values_);
    else if (positive_.info() == Eigen::Success)
      positive_.solveInPlace(values_);
    else
      values_ = indefinite_.solve(values_);
    std::copy_n(values_.data() + start_[dealii::Utilities::MPI::this_mpi_process(communicator_)],
                correction.size(),
                correction.begin());
  }
} // namespace Nodus
