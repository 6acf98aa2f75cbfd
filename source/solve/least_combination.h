#ifndef nodus_solve_least_combination_h
#define nodus_solve_least_combination_h

#include <Eigen/Dense>

#include <cmath>

namespace Nodus
{
  /// The gamma that minimise |f - sum_i gamma_i y_i|, from @p A = y_i . y_j and @p b = y_i . f; combinations of the y_i
  /// that are round-off do not count.
  inline Eigen::VectorXd least_combination(const Eigen::MatrixXd &A, const Eigen::VectorXd &b)
  {
    constexpr double rank_tolerance = 1e-8; // of the scaled normal equations
    Eigen::VectorXd  scale(b.size());
    for (unsigned int i = 0; i < b.size(); ++i)
      scale(i) = A(i, i) > 0. ? 1. / std::sqrt(A(i, i)) : 0.;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(rank_tolerance);
    solver.compute(scale.asDiagonal() * A * scale.asDiagonal());
    return scale.cwiseProduct(solver.solve(scale.cwiseProduct(b)));
  }
} // namespace Nodus

#endif
