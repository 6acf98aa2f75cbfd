#include "solve/anderson_mixing.h"
#include "solve/least_combination.h"

namespace Nodus
{
  namespace
  {
    /// Steps that are mixed.
    constexpr unsigned int depth = 5;
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
    Eigen::VectorXd    rhs(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      for (unsigned int j = 0; j <= i; ++j)
        A(i, j) = A(j, i) = pairs_[i].second * pairs_[j].second;
      rhs(i) = pairs_[i].second * correction;
    }
    const Eigen::VectorXd gamma = least_combination(A, rhs);
    for (unsigned int i = 0; i < n; ++i)
      step_.add(-gamma(i), pairs_[i].first, -gamma(i), pairs_[i].second);
    return step_;
  }
} // namespace Nodus
