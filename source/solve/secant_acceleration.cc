#include "solve/secant_acceleration.h"
#include "solve/least_combination.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Bounds of omega: factors of the map up to 0.9 (-9) and from 1.1 (11), and all that are negative (0 to 1);
    /// between, two passes tell too little.
    constexpr double smallest_omega = -9., largest_omega = 11.;
    /// Between these, factors from -0.5 to 0.5, the plain iteration is fast enough and does not mix directions.
    constexpr double plain_from = -1., plain_to = 1. / 3.;
    /// Errors that shrink by less than this have several directions.
    constexpr double slow_contraction = 0.8;
    /// Secants kept, and from how many on they are combined.
    constexpr unsigned int depth = 5, fewest = 3;
  } // namespace

  std::vector<double> SecantAcceleration::next(const std::vector<double> &value, const std::vector<double> &image)
  {
    std::vector<double> error(value.size()), d_image(value.size()), d_error(value.size());
    double              sums[3] = {0., 0., 0.}; // (G - G').(f - f'), |f - f'|^2, |f|^2
    const bool          first   = error_.empty();
    for (unsigned int i = 0; i < value.size(); ++i)
    {
      error[i] = image[i] - value[i];
      sums[2] += error[i] * error[i];
      if (first)
        continue;
      d_error[i] = error[i] - error_[i];
      d_image[i] = image[i] - image_[i];
      sums[0] += d_image[i] * d_error[i];
      sums[1] += d_error[i] * d_error[i];
    }
    dealii::Utilities::MPI::sum(
        dealii::ArrayView<const double>(sums, 3), communicator_, dealii::ArrayView<double>(sums, 3));
    const bool before = dealii::Utilities::MPI::max(first ? 0 : 1, communicator_) == 1;
    double     omega  = before && sums[1] > 0. ? std::clamp(sums[0] / sums[1], smallest_omega, largest_omega) : 0.;
    if (omega > plain_from && omega < plain_to)
      omega = 0.;
    std::vector<double> result(image);
    for (unsigned int i = 0; i < result.size(); ++i)
      result[i] -= omega * error[i];

    const double norm = std::sqrt(sums[2]);
    contraction_      = before && norm_ > 0. ? norm / norm_ : 0.;
    norm_             = norm;
    image_            = image;
    error_            = std::move(error);
    if (before)
      secants_.push_back({std::move(d_image), std::move(d_error)});
    if (secants_.size() > depth)
      secants_.pop_front();
    return contraction_ > slow_contraction && secants_.size() >= fewest ? combined() : result;
  }

  /// The images' combination whose error is smallest, by all secants (Anderson).
  std::vector<double> SecantAcceleration::combined() const
  {
    const unsigned int  n = secants_.size();
    std::vector<double> sums(n * (n + 1), 0.); // df_i . df_j, then df_i . f
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int l = 0; l < error_.size(); ++l)
      {
        for (unsigned int j = 0; j < n; ++j)
          sums[i * n + j] += secants_[i].error[l] * secants_[j].error[l];
        sums[n * n + i] += secants_[i].error[l] * error_[l];
      }
    dealii::Utilities::MPI::sum(sums, communicator_, sums);
    Eigen::MatrixXd A(n, n);
    Eigen::VectorXd rhs(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      for (unsigned int j = 0; j < n; ++j)
        A(i, j) = sums[i * n + j];
      rhs(i) = sums[n * n + i];
    }
    const Eigen::VectorXd gamma  = least_combination(A, rhs);
    std::vector<double>   result = image_;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int l = 0; l < result.size(); ++l)
        result[l] -= gamma(i) * secants_[i].image[l];
    return result;
  }
} // namespace Nodus
