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
    /// A merged loop may come back to a visited status vector this often while the iterate still moves.
    constexpr unsigned int tolerated_returns = 3;
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
      , ledger_(surfaces.n_sites())
  {
    const unsigned int n = surfaces.n_sites();
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
      const unsigned int p      = surfaces_.pair(k);
      const Initial      option = pairs_[p].initial_status;
      now_.contact[k]           = surfaces_.has_status(k) && pairing[k].found &&
                        (option == Initial::closed ||
                         (option == Initial::by_gap && -distance[k] <= initial_gap * surfaces_.face_size(p)));
    }
    committed_ = now_;
  }

  void Status::assign(const unsigned int site, const bool contact, const bool stick, const double threshold)
  {
    now_.contact[site]   = contact;
    now_.stick[site]     = stick;
    now_.threshold[site] = threshold;
    update_floor();
  }

  void Status::inherit(const Pairing &pairing)
  {
    for (unsigned int k = 0; k < now_.contact.size(); ++k)
      if (!pairing[k].found)
        now_.contact[k] = false;
  }

  Status::Change Status::threshold_change(const std::vector<double> &site_pressure) const
  {
    double largest = 0.;
    Change change;
    for (unsigned int k = 0; k < site_pressure.size(); ++k)
    {
      const double mu = pairs_[surfaces_.pair(k)].friction_coefficient;
      largest         = std::max(largest, mu * std::abs(site_pressure[k]));
      const double d  = std::abs(mu * std::min(site_pressure[k], 0.) - now_.threshold[k]);
      if (d > change.value)
        change = {d, k};
    }
    if (largest > 0.)
      change.value /= largest;
    return change;
  }

  void Status::freeze_threshold(const std::vector<double> &site_pressure)
  {
    note_friction();
    for (unsigned int k = 0; k < site_pressure.size(); ++k)
      now_.threshold[k] = pairs_[surfaces_.pair(k)].friction_coefficient * std::min(site_pressure[k], 0.);
    update_floor();
  }

  void Status::update_floor()
  {
    threshold_floor_ = 0.;
    for (const double t : now_.threshold)
      threshold_floor_ = std::max(threshold_floor_, -relative_threshold_floor * t);
  }

  void Status::begin_increment()
  {
    ledger_.assign(ledger_.size(), StatusLedger());
  }

  void Status::begin_loop(const bool merged)
  {
    visited_.clear();
    opened_.assign(now_.contact.size(), false);
    one_at_a_time_ = false;
    merged_        = merged;
    returns_       = 0;
    note_friction();
  }

  void Status::note_friction()
  {
    had_friction_.resize(now_.contact.size());
    for (unsigned int k = 0; k < had_friction_.size(); ++k)
      had_friction_[k] = friction(k);
  }

  Status::Update Status::update(const StatusInput &input, const bool closing_only)
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
      double &l = largest[surfaces_.pair(k)];
      l         = std::max(l, std::abs(input.pressure[k]));
    }

    Update result;
    for (unsigned int k = 0; k < input.pressure.size(); ++k)
    {
      const double  tolerance = noise * largest[surfaces_.pair(k)];
      const double  value     = input.pressure[k] - normal_augmentation(k) * input.distance[k];
      Contradiction found     = Contradiction::none;
      if (now_.contact[k] && value > tolerance)
        found = Contradiction::tension;
      else if (!now_.contact[k] && value < -tolerance)
        found = Contradiction::penetration;
      else if (friction(k) && (!merged_ || had_friction_[k]))
      {
        const double rho = tangential_augmentation(k, now_.threshold[k]);
        const double norm =
            std::hypot(input.Lambda[k][0] + rho * input.slip[k][0], input.Lambda[k][1] + rho * input.slip[k][1]);
        if (now_.stick[k] && norm > 1. + noise)
          found = Contradiction::over_cone;
        else if (!now_.stick[k] && norm < 1. - noise)
          found = Contradiction::against_slip;
      }
      if (found == Contradiction::none || (closing_only && found != Contradiction::penetration))
        continue;

      now_.contact[k] = found != Contradiction::tension;
      if (found == Contradiction::tension)
        opened_[k] = true;
      else // a site that closes sticks first; one that opened in this loop slips, stick may be what pulled it open
        now_.stick[k] = found == Contradiction::against_slip || (found == Contradiction::penetration && !opened_[k]);
      ++ledger_[k].changes;
      ledger_[k].last = found;
      result.sites.push_back(k);
      if (one_at_a_time_)
        break;
    }
    note_friction(); // of the next system
    result.changes = result.sites.size();
    if (result.changes == 0)
      return result;

    visited_.push_back(code());
    for (unsigned int back = 1; back < visited_.size() && result.period == 0; ++back)
      if (visited_[visited_.size() - 1 - back] == visited_.back())
        result.period = back;
    if (result.period > 0)
    {
      // every site that took part in the cycle
      for (unsigned int back = 0; back < result.period; ++back)
      {
        const auto &a = visited_[visited_.size() - 1 - back], &b = visited_[visited_.size() - 2 - back];
        for (unsigned int k = 0; k < a.size(); ++k)
          if (a[k] != b[k])
            ledger_[k].period = result.period;
      }
      result.cycles  = merged_ ? ++returns_ > tolerated_returns : one_at_a_time_;
      one_at_a_time_ = !merged_;
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
