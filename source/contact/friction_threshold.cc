#include "contact/status.h"
#include "parallel/largest.h"
#include "parallel/throw_everywhere.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

// The friction thresholds of a Status: what they follow and when they are frozen.

namespace Nodus
{
  namespace
  {
    /// Thresholds below this fraction of the largest count as frictionless: their friction rows would be singular.
    constexpr double relative_threshold_floor = 1e-6;
    /// s_v of the largest (eq. Q4): nodes with few points of friction need some hold, and thresholds a limit.
    constexpr double relative_void_threshold = 1e-2;
  } // namespace

  /// Eq. L2.
  Status::Change Status::threshold_change(const std::vector<double> &site_pressure) const
  {
    const MPI_Comm            communicator = surfaces_.layout().communicator;
    const std::vector<double> thresholds   = thresholds_at(site_pressure);
    std::vector<double>       largest(pairs_.size(), 0.);
    for (unsigned int k = 0; k < thresholds.size(); ++k)
      if (surfaces_.is_owned(k))
      {
        double &l = largest[surfaces_.pair(k)];
        l         = std::max(l, -thresholds[k]);
      }
    dealii::Utilities::MPI::max(largest, communicator, largest);
    Change change;
    for (unsigned int k = 0; k < thresholds.size(); ++k)
      if (surfaces_.is_owned(k))
      {
        const double l = largest[surfaces_.pair(k)];
        const double d = std::abs(thresholds[k] - now_.threshold[k]) / (l > 0. ? l : 1.);
        if (d > change.value)
          change = {d, k};
      }
    keep_largest(change.value, change.site, communicator);
    return change;
  }

  void Status::freeze_threshold(const std::vector<double> &site_pressure)
  {
    note_friction();
    now_.threshold = thresholds_at(site_pressure);
    for (unsigned int k = 0; k < site_pressure.size(); ++k)
      threshold_slope_[k] =
          limits_[surfaces_.pair(k)].slope(site_pressure[k], now_.friction_factor[k], friction_point(k));
    update_floor();
  }

  std::vector<double> Status::thresholds_at(const std::vector<double> &site_pressure) const
  {
    std::vector<double> thresholds;
    for (unsigned int k = 0; k < site_pressure.size(); ++k)
      thresholds.push_back(
          limits_[surfaces_.pair(k)].threshold(site_pressure[k], now_.friction_factor[k], friction_point(k)));
    return thresholds;
  }

  void Status::freeze(std::vector<double> thresholds)
  {
    note_friction();
    for (double &threshold : thresholds)
      threshold = std::min(threshold, 0.);
    surfaces_.site_exchange().update(thresholds);
    now_.threshold = std::move(thresholds);
    update_floor();
  }

  /// In a merged loop: in a status loop Newton's method has to converge before a site that should stick can do so.
  bool Status::gains_friction(const unsigned int site) const
  {
    return merged_ && surfaces_.is_owned(site) && friction(site) && !had_friction_[site] && !holds_friction(site) &&
           pairs_[surfaces_.pair(site)].contact_law != ContactPairParameters::ContactLaw::tied;
  }

  bool Status::gains_friction() const
  {
    unsigned int sites = 0;
    for (unsigned int k = 0; k < now_.contact.size(); ++k)
      sites += gains_friction(k);
    return dealii::Utilities::MPI::max(sites, surfaces_.layout().communicator) > 0;
  }

  void Status::begin_friction(const StatusInput &input, const std::vector<double> &depth)
  {
    for (unsigned int k = 0; k < now_.contact.size(); ++k)
      if (gains_friction(k) && now_.stick[k])
        now_.stick[k] = can_stick(input, k, depth[surfaces_.pair(k)]);
    surfaces_.site_exchange().update(now_.stick);
  }

  void Status::set_slips(const std::vector<std::array<double, 2>> &slip, const double duration)
  {
    std::ostringstream problem;
    for (unsigned int k = 0; k < slip.size() && problem.str().empty(); ++k)
      if (surfaces_.is_owned(k))
      {
        const Point          X     = surfaces_.site_position(k);
        const FrictionLimit &limit = limits_[surfaces_.pair(k)];
        now_.slip_rate[k]          = std::hypot(slip[k][0], slip[k][1]) / duration;
        slip_length_[k]            = std::hypot(now_.slip[k][0] + slip[k][0], now_.slip[k][1] + slip[k][1]);
        double &factor             = now_.friction_factor[k];
        factor                     = limit.factor(X, now_.slip_rate[k]);
        // any pressure does to find a law that is none
        const double radius = limit.own_law() ? -limit.threshold(-1., 1., friction_point(k)) : factor;
        if (!(radius >= 0. && std::isfinite(radius)))
          problem << (limit.own_law() ? std::string("the friction law")
                                      : "'Friction factor = " + pairs_[surfaces_.pair(k)].friction_factor + "'")
                  << " of " << pair_label(pairs_, surfaces_.pair(k)) << " is " << radius << " at (" << X
                  << ") for the slip rate " << now_.slip_rate[k] << "; it must be >= 0 everywhere";
      }
    throw_everywhere<InputError>(problem.str(), surfaces_.layout().communicator);
    surfaces_.site_exchange().update(now_.friction_factor);
    surfaces_.site_exchange().update(now_.slip_rate);
    surfaces_.site_exchange().update(slip_length_);
  }

  /// With the state that the increment begins with; the pressure is FrictionLimit's to set.
  FrictionPoint Status::friction_point(const unsigned int site) const
  {
    FrictionPoint point;
    if (limits_[surfaces_.pair(site)].own_law() == nullptr)
      return point;
    point.X     = surfaces_.site_position(site);
    point.slip  = slip_length_[site];
    point.rate  = now_.slip_rate[site];
    point.state = now_.friction_state[site];
    return point;
  }

  void Status::add_slip(const std::vector<std::array<double, 2>> &slip,
                        const double                              duration,
                        const std::vector<double>                &pressure)
  {
    for (unsigned int k = 0; k < slip.size(); ++k)
    {
      if (!now_.contact[k])
        continue;
      for (unsigned int i = 0; i < 2; ++i)
        now_.slip[k][i] += slip[k][i];
      if (const FrictionLaw *const law = limits_[surfaces_.pair(k)].own_law())
      {
        FrictionPoint point    = friction_point(k);
        point.slip             = std::hypot(now_.slip[k][0], now_.slip[k][1]);
        point.rate             = duration > 0. ? std::hypot(slip[k][0], slip[k][1]) / duration : 0.;
        point.pressure         = std::abs(pressure[k]);
        now_.friction_state[k] = law->next_state(point, duration);
      }
    }
    surfaces_.site_exchange().update(now_.friction_state);
  }

  void Status::resume()
  {
    for (unsigned int k = 0; k < slip_length_.size(); ++k)
      slip_length_[k] = std::hypot(now_.slip[k][0], now_.slip[k][1]);
    update_floor();
  }

  void Status::update_floor()
  {
    threshold_floor_.assign(pairs_.size(), 0.);
    for (unsigned int k = 0; k < now_.threshold.size(); ++k)
    {
      double &floor = threshold_floor_[surfaces_.pair(k)];
      floor         = std::max(floor, -relative_threshold_floor * now_.threshold[k]);
    }
    dealii::Utilities::MPI::max(threshold_floor_, surfaces_.layout().communicator, threshold_floor_);
    for (unsigned int p = 0; p < pairs_.size(); ++p)
    {
      const double modulus = normal_augmentation_[p] * surfaces_.face_size(p);
      const double largest = threshold_floor_[p] / relative_threshold_floor;
      // the nearest power of two of the modulus: that it follows the iterate is not in the tangent, and from one to the
      // next it changes at no round number, which round-off would push to and fro
      void_threshold_[p] =
          largest > 0. ? relative_void_threshold * std::ldexp(modulus, std::lround(std::log2(largest / modulus))) : 0.;
    }
  }
} // namespace Nodus
