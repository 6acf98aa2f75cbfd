#include "solve/anderson_mixing.h"

#include <deal.II/base/mpi.h>

#include <Eigen/Dense>

#include <cmath>
#include <numeric>

namespace Nodus
{
  namespace
  {
    /// Changes that are kept.
    constexpr unsigned int depth = 5;

    /// The gamma that minimise |f - sum_i gamma_i y_i|, from @p A = y_i . y_j and @p b = y_i . f; combinations of the
    /// y_i that are round-off do not count.
    Eigen::VectorXd least_combination(const Eigen::MatrixXd &A, const Eigen::VectorXd &b)
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

    double product(const std::vector<double> &a, const std::vector<double> &b)
    {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
    }

    std::vector<double> difference(const std::vector<double> &a, const std::vector<double> &b)
    {
      std::vector<double> result(a.size());
      for (unsigned int i = 0; i < a.size(); ++i)
        result[i] = a[i] - b[i];
      return result;
    }
  } // namespace

  void AndersonMixing::add(const std::vector<double> &value, const std::vector<double> &image)
  {
    std::vector<double> error = difference(image, value);
    const double        norm  = std::sqrt(dealii::Utilities::MPI::sum(product(error, error), communicator_));
    if (norm_ >= 0.)
    {
      contraction_ = norm_ > 0. ? norm / norm_ : 0.;
      changes_.push_back({difference(image, image_), difference(error, error_)});
      if (changes_.size() > depth)
        changes_.pop_front();
    }
    norm_  = norm;
    image_ = image;
    error_ = std::move(error);
  }

  std::vector<double> AndersonMixing::mixed() const
  {
    const unsigned int  n = changes_.size();
    std::vector<double> sums; // df_i . df_j, then df_i . f
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        sums.push_back(product(changes_[i].error, changes_[j].error));
    for (unsigned int i = 0; i < n; ++i)
      sums.push_back(product(changes_[i].error, error_));
    dealii::Utilities::MPI::sum(sums, communicator_, sums);
    std::vector<double> result(image_);
    if (n == 0)
      return result;
    const Eigen::VectorXd gamma = least_combination(Eigen::Map<const Eigen::MatrixXd>(sums.data(), n, n),
                                                    Eigen::Map<const Eigen::VectorXd>(sums.data() + n * n, n));
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int l = 0; l < result.size(); ++l)
        result[l] -= gamma(i) * changes_[i].image[l];
    return result;
  }
} // namespace Nodus
