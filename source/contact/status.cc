#include <nodus/contact/pairing.h>
#include <nodus/contact/status.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// A test value this close to its bound, relative, is round-off and changes nothing.
    constexpr double noise = 1e-10;
    /// Thresholds below this fraction of the largest count as frictionless: their friction rows would be singular.
    constexpr double relative_threshold_floor = 1e-6;
    /// Gap in face sizes up to which a node starts closed.
    constexpr double initial_gap = 1e-6;
  } // namespace

  Status::Status(const std::vector<ContactPairParameters> &pairs,
                 const ContactSurfaces                    &surfaces,
                 const std::vector<double>                &normal_augmentation)
      : pairs_(pairs)
      , surfaces_(surfaces)
      , normal_augmentation_(normal_augmentation)
      , has_friction_(
            std::any_of(pairs.begin(), pairs.end(), [](const auto &p) { return p.friction_coefficient > 0.; }))
      , n_changes_(surfaces.slave_nodes().size(), 0)
  {
    const unsigned int n = surfaces.slave_nodes().size();
    now_.contact.assign(n, false);
    now_.stick.assign(n, true);
    now_.threshold.assign(n, 0.);
    now_.slip.assign(n, {{0., 0.}});
    committed_ = now_;
  }

  void Status::initialize(const Pairing &pairing, const std::vector<double> &distance)
  {
    using Initial = ContactPairParameters::InitialStatus;
    for (unsigned int k = 0; k < now_.contact.size(); ++k)
    {
      const unsigned int p      = surfaces_.slave_nodes()[k].pair;
      const Initial      option = pairs_[p].initial_status;
      now_.contact[k] =
          pairing[k].found && (option == Initial::closed ||
                               (option == Initial::by_gap && -distance[k] <= initial_gap * surfaces_.face_size(p)));
    }
    committed_ = now_;
  }

  void Status::assign(const unsigned int slave, const bool contact, const bool stick, const double threshold)
  {
    now_.contact[slave]   = contact;
    now_.stick[slave]     = stick;
    now_.threshold[slave] = threshold;
    update_floor();
  }

  void Status::inherit(const Pairing &pairing)
  {
    for (unsigned int k = 0; k < now_.contact.size(); ++k)
      if (!pairing[k].found)
        now_.contact[k] = false;
  }

  Status::Change Status::threshold_change(const std::vector<double> &weighted_pressure) const
  {
    double largest = 0.;
    Change change;
    for (unsigned int k = 0; k < weighted_pressure.size(); ++k)
    {
      const double mu = pairs_[surfaces_.slave_nodes()[k].pair].friction_coefficient;
      largest         = std::max(largest, mu * std::abs(weighted_pressure[k]));
      const double d  = std::abs(mu * std::min(weighted_pressure[k], 0.) - now_.threshold[k]);
      if (d > change.value)
        change = {d, k};
    }
    if (largest > 0.)
      change.value /= largest;
    return change;
  }

  void Status::freeze_threshold(const std::vector<double> &weighted_pressure)
  {
    for (unsigned int k = 0; k < weighted_pressure.size(); ++k)
      now_.threshold[k] =
          pairs_[surfaces_.slave_nodes()[k].pair].friction_coefficient * std::min(weighted_pressure[k], 0.);
    update_floor();
  }

  void Status::update_floor()
  {
    threshold_floor_ = 0.;
    for (const double t : now_.threshold)
      threshold_floor_ = std::max(threshold_floor_, -relative_threshold_floor * t);
  }

  void Status::begin_loop()
  {
    visited_.clear();
    one_at_a_time_ = false;
  }

  Status::Update Status::update(const StatusInput &input)
  {
    const auto code = [&]()
    {
      std::vector<char> c(now_.contact.size());
      for (unsigned int k = 0; k < c.size(); ++k)
        c[k] = static_cast<char>(status(k));
      return c;
    };
    if (visited_.empty())
      visited_.push_back(code());

    std::vector<double> largest(pairs_.size(), 0.);
    for (unsigned int k = 0; k < input.pressure.size(); ++k)
    {
      double &l = largest[surfaces_.slave_nodes()[k].pair];
      l         = std::max(l, std::abs(input.pressure[k]));
    }

    Update result;
    for (unsigned int k = 0; k < input.pressure.size(); ++k)
    {
      const ContactStatus before    = status(k);
      const double        tolerance = noise * largest[surfaces_.slave_nodes()[k].pair];
      const double        value     = input.pressure[k] - normal_augmentation(k) * input.distance[k];
      if (now_.contact[k] && value > tolerance)
        now_.contact[k] = false;
      else if (!now_.contact[k] && value < -tolerance)
      {
        now_.contact[k] = true;
        now_.stick[k]   = true;
      }
      else if (friction(k))
      {
        const double rho = tangential_augmentation(k, now_.threshold[k]);
        const double norm =
            std::hypot(input.Lambda[k][0] + rho * input.slip[k][0], input.Lambda[k][1] + rho * input.slip[k][1]);
        if (now_.stick[k] && norm > 1. + noise)
          now_.stick[k] = false;
        else if (!now_.stick[k] && norm < 1. - noise)
          now_.stick[k] = true;
      }
      if (status(k) != before)
      {
        ++n_changes_[k];
        result.slaves.push_back(k);
        if (one_at_a_time_)
          break;
      }
    }
    result.changes = result.slaves.size();
    if (result.changes == 0)
      return result;

    visited_.push_back(code());
    for (unsigned int back = 1; back < visited_.size() && result.period == 0; ++back)
      if (visited_[visited_.size() - 1 - back] == visited_.back())
        result.period = back;
    if (result.period > 0)
    {
      result.cycles  = one_at_a_time_;
      one_at_a_time_ = true;
      visited_.assign(1, code());
    }
    return result;
  }

  void Status::commit(const std::vector<std::array<double, 2>> &slip)
  {
    for (unsigned int k = 0; k < slip.size(); ++k)
      if (now_.contact[k])
        for (unsigned int i = 0; i < 2; ++i)
          now_.slip[k][i] += slip[k][i];
    committed_ = now_;
  }

  void Status::roll_back()
  {
    now_ = committed_;
    update_floor();
  }
} // namespace Nodus
