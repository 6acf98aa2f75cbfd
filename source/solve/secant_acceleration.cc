#include <nodus/solve/secant_acceleration.h>

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
  } // namespace

  std::vector<double> SecantAcceleration::next(const std::vector<double> &value, const std::vector<double> &image)
  {
    std::vector<double> error(value.size());
    double              sums[3] = {0., 0., 0.}; // (G - G').(f - f'), |f - f'|^2, |f|^2
    const bool          first   = error_.empty();
    for (unsigned int i = 0; i < value.size(); ++i)
    {
      error[i] = image[i] - value[i];
      sums[2] += error[i] * error[i];
      if (first)
        continue;
      const double change = error[i] - error_[i];
      sums[0] += (image[i] - image_[i]) * change;
      sums[1] += change * change;
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
    return result;
  }
} // namespace Nodus
