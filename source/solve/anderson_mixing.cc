#include <nodus/solve/anderson_mixing.h>

#include <Eigen/Dense>

#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Steps that are mixed.
    constexpr unsigned int depth = 5;
    /// Of the scaled normal equations: directions below do not count.
    constexpr double rank_tolerance = 1e-8;
  } // namespace

  const Vector &AndersonMixing::next(const Vector &correction, const bool mix)
  {
    if (step_.size() > 0)
    {
      Vector change(correction);
      change -= correction_;
      pairs_.emplace_back(step_, change);
      if (pairs_.size() > depth)
        pairs_.pop_front();
    }
    correction_ = correction;
    step_       = correction;
    if (!mix)
      return step_;

    const unsigned int n = pairs_.size();
    Eigen::MatrixXd    A(n, n);
    Eigen::VectorXd    rhs(n), scale(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      for (unsigned int j = 0; j <= i; ++j)
        A(i, j) = A(j, i) = pairs_[i].second * pairs_[j].second;
      rhs(i)   = pairs_[i].second * correction;
      scale(i) = A(i, i) > 0. ? 1. / std::sqrt(A(i, i)) : 0.;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(rank_tolerance);
    solver.compute(scale.asDiagonal() * A * scale.asDiagonal());
    const Eigen::VectorXd scaled = solver.solve(scale.cwiseProduct(rhs));
    for (unsigned int i = 0; i < n; ++i)
      step_.add(-scale(i) * scaled(i), pairs_[i].first, -scale(i) * scaled(i), pairs_[i].second);
    return step_;
  }
} // namespace Nodus
