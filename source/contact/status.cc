#include "contact/status.h"
#include "contact/pairing.h"
#include "parallel/largest.h"
#include <nodus/base/remedy.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    /// A test value this close to its bound, relative, is round-off and changes nothing.
    constexpr double noise = 1e-10;
    /// The gap of a closed node that is larger is what pairing anew has left in a merged loop, and the next correction
    /// closes it [face].
    constexpr double settled_gap = 1e-6;
    /// A merged loop may come back to a visited status vector this often while the iterate still moves.
    constexpr unsigned int tolerated_returns = 3;
    /// Passes of a status loop that may go by without fewer changes than before.
    constexpr unsigned int tolerated_passes = 8;
    /// Gap in face sizes up to which a node starts closed.
    constexpr double initial_gap = 1e-6;
    /// Distance in face sizes up to which tied and bilateral pairs start closed.
    constexpr double tying_distance = 0.1;
    /// Elastic slip in face sizes of nodes that are slaves of several pairs.
    constexpr double shared_elastic_slip = 1e-6;

    using ContactLaw  = ContactPairParameters::ContactLaw;
    using Overclosure = ContactPairParameters::InitialOverclosure;
  } // namespace

  Status::Status(const std::vector<ContactPairParameters> &pairs,
                 const ContactSurfaces                    &surfaces,
                 const std::vector<double>                &stiffness,
                 const StrategyParameters                 &strategy,
                 State                                    &now)
      : pairs_(pairs)
      , surfaces_(surfaces)
      , strategy_(strategy)
      , now_(now)
      , threshold_slope_(surfaces.n_sites(), 0.)
      , threshold_floor_(pairs.size(), 0.)
      , void_threshold_(pairs.size(), 0.)
      , resolved_(pairs.size(), 0.)
      , ledger_(surfaces.n_sites())
  {
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      limits_.emplace_back(pairs[p], stiffness[p]);
      gap_laws_.push_back(make_pressure_gap_law(pairs[p]));
      // rho_n = factor E/h: the stiffness of a layer one slave face deep, of the softer material
      normal_augmentation_.push_back(pairs[p].normal_augmentation_factor * stiffness[p] / surfaces.face_size(p));
    }
    const unsigned int n = surfaces.n_sites();
    now_.contact.assign(n, false);
    now_.stick.assign(n, true);
    now_.threshold.assign(n, 0.);
    now_.slip.assign(n, {{0., 0.}});
    now_.adjustment.assign(n, 0.);
    now_.friction_factor.assign(n, 1.);
    now_.slip_rate.assign(n, 0.);
    now_.friction_state.assign(n, {});
    for (unsigned int k = 0; k < n; ++k)
      if (const auto &second = pairs[surfaces.pair(k)].second_pass)
        now_.adjustment[k] = second->clearance;
    for (unsigned int k = 0; k < n; ++k)
      if (const FrictionLaw *const law = limits_[surfaces.pair(k)].own_law())
        now_.friction_state[k] = law->initial_state();
    slip_length_.assign(n, 0.);
    for (unsigned int k = 0; k < surfaces.slave_nodes().size(); ++k)
    {
      const double own = pairs[surfaces.pair(k)].elastic_slip;
      elastic_slip_.push_back(own == 0. && surfaces.is_owned(k) && surfaces.shares_node(k)
                                  ? shared_elastic_slip * surfaces.face_size(surfaces.pair(k))
                                  : own);
    }
    surfaces.slave_exchange().update(elastic_slip_);
  }

  double Status::closing_distance(const unsigned int pair) const
  {
    const auto  &p     = pairs_[pair];
    const double size  = surfaces_.face_size(pair);
    const bool   lasts = p.contact_law != ContactLaw::unilateral;
    if (!lasts && p.start.overclosure != Overclosure::adjust)
      return initial_gap * size;
    return std::max(initial_gap * size,
                    lasts && p.start.adjustment_distance == 0. ? tying_distance * size : p.start.adjustment_distance);
  }

  void Status::initialize(const Pairing &pairing, const std::vector<double> &distance, const double t)
  {
    using Initial = ContactPairParameters::InitialStatus;
    for (unsigned int k = 0; k < now_.contact.size(); ++k)
    {
      const unsigned int p = surfaces_.pair(k);
      if (!surfaces_.has_status(k) || !pairing[k].found || pairs_[p].active_from != t)
        continue;
      const auto  &pair     = pairs_[p];
      const bool   lasts    = pair.contact_law != ContactLaw::unilateral; // closed for good
      const double reach    = closing_distance(p);
      const double touching = closure_at(gap_laws_[p].get(), 0.).overclosure;
      const bool   near =
          touching - distance[k] <= reach && (pair.contact_law != ContactLaw::tied || distance[k] <= reach);
      now_.contact[k] = pair.start.status == Initial::closed || (pair.start.status == Initial::by_gap && near);
      if ((lasts && now_.contact[k]) || (pair.start.overclosure == Overclosure::adjust && near) ||
          (pair.start.overclosure == Overclosure::interference && distance[k] > 0.))
        now_.adjustment[k] = distance[k];
    }
    surfaces_.site_exchange().update(now_.contact);
    surfaces_.site_exchange().update(now_.adjustment);
  }

  void Status::assign(const unsigned int site, const bool contact, const bool stick, const double threshold)
  {
    now_.contact[site]   = contact;
    now_.stick[site]     = stick;
    now_.threshold[site] = threshold;
    update_floor();
  }

  void Status::take_over(const unsigned int site, const unsigned int giver)
  {
    now_.contact[site]   = true;
    now_.stick[site]     = now_.stick[giver];
    now_.threshold[site] = now_.threshold[giver];
  }

  void Status::inherit(const Pairing &pairing)
  {
    surfaces_.site_exchange().update(now_.contact);
    surfaces_.site_exchange().update(now_.stick);
    surfaces_.site_exchange().update(now_.threshold);
    for (unsigned int k = 0; k < now_.contact.size(); ++k)
      if (!pairing[k].found)
        now_.contact[k] = false;
  }

  bool Status::can_project(const unsigned int pair) const
  {
    return pairs_[pair].scheme == ContactPairParameters::Scheme::integration_point &&
           pairs_[pair].contact_law == ContactLaw::unilateral && !gap_laws_[pair] && pairs_[pair].elastic_slip == 0.;
  }

  bool Status::can_lump(const unsigned int pair) const
  {
    // without friction the nodal means obey the same equations for all weights
    return pairs_[pair].scheme != ContactPairParameters::Scheme::integration_point &&
           pairs_[pair].weights == ContactPairParameters::Weights::consistent && limits_[pair].exists();
  }

  bool Status::has_own_gap(const unsigned int pair) const
  {
    return pairs_[pair].scheme != ContactPairParameters::Scheme::integration_point &&
           pairs_[pair].weights != ContactPairParameters::Weights::consistent;
  }

  bool Status::can_regularise() const
  {
    for (unsigned int p = 0; p < pairs_.size(); ++p)
      if (can_project(p) || can_lump(p))
        return strategy_.uses(Remedy::regularised_law);
    return false;
  }

  std::vector<bool> Status::lumped() const
  {
    std::vector<bool> result;
    for (unsigned int p = 0; p < pairs_.size(); ++p)
      result.push_back(regularised_ && can_lump(p));
    return result;
  }

  void Status::begin_increment()
  {
    regularised_ = false;
    ledger_.assign(ledger_.size(), StatusLedger());
  }

  void Status::begin_loop(const bool merged)
  {
    visited_.clear();
    opened_.assign(now_.contact.size(), false);
    frozen_.assign(now_.contact.size(), false);
    merged_  = merged;
    returns_ = 0;
    fewest_  = dealii::numbers::invalid_unsigned_int;
    idle_    = 0;
    note_friction();
  }

  void Status::note_friction()
  {
    had_friction_.resize(now_.contact.size());
    for (unsigned int k = 0; k < had_friction_.size(); ++k)
      had_friction_[k] = friction(k);
  }

  std::vector<char> Status::code() const
  {
    std::vector<char> c(now_.contact.size());
    for (unsigned int k = 0; k < c.size(); ++k)
      c[k] = static_cast<char>(projected(k) && contact(k) ? ContactStatus::slip : status(k));
    return c;
  }

  /// Eq. S2.
  Contradiction
  Status::contradiction(const StatusInput &input, const unsigned int site, const double pressure, double &size) const
  {
    const ContactLaw law = pairs_[surfaces_.pair(site)].contact_law;
    size                 = 0.;
    if (law == ContactLaw::tied)
      return Contradiction::none;
    const unsigned int pair = surfaces_.pair(site);
    const bool         left = merged_ && now_.contact[site] && has_own_gap(pair) &&
                      input.distance[site] < -settled_gap * surfaces_.face_size(pair);
    const double distance = left ? 0. : input.distance[site];
    const double value    = input.pressure[site] - normal_augmentation(site) * distance;
    const bool   pulls    = now_.contact[site] && value > noise * pressure && law != ContactLaw::bilateral;
    if (pulls || (!now_.contact[site] && value < -noise * pressure))
    {
      size = pressure > 0. ? std::abs(value) / pressure : 1.;
      return pulls ? Contradiction::tension : Contradiction::penetration;
    }
    if (!friction(site) || (holds_friction(site) && !stick(site)) || (merged_ && !had_friction_[site]))
      return Contradiction::none;
    const double rho  = tangential_augmentation(site, now_.threshold[site]);
    const double norm = std::hypot(input.Lambda[site][0] + rho * input.slip[site][0],
                                   input.Lambda[site][1] + rho * input.slip[site][1]);
    size              = std::abs(norm - 1.);
    if (now_.stick[site] && norm > 1. + noise)
      return Contradiction::over_cone;
    if (!now_.stick[site] && norm < 1. - noise)
      return Contradiction::against_slip;
    size = 0.;
    return Contradiction::none;
  }

  std::vector<double> Status::largest_pressures(const StatusInput &input) const
  {
    std::vector<double> largest(pairs_.size(), 0.);
    for (unsigned int k = 0; k < input.pressure.size(); ++k)
      if (surfaces_.is_owned(k))
      {
        double &l = largest[surfaces_.pair(k)];
        l         = std::max(l, std::abs(input.pressure[k]));
      }
    dealii::Utilities::MPI::max(largest, surfaces_.layout().communicator, largest);
    return largest;
  }

  /// Eq. S3: eq. 7 with the threshold of the pressure that eq. 2 closes the site with.
  bool Status::can_stick(const StatusInput &input, const unsigned int site, const double depth) const
  {
    const unsigned int p         = surfaces_.pair(site);
    const double       slip      = std::hypot(input.slip[site][0], input.slip[site][1]);
    const double       value     = input.pressure[site] - normal_augmentation(site) * input.distance[site];
    const double       threshold = limits_[p].threshold(value, now_.friction_factor[site], friction_point(site));
    return pairs_[p].tangential_augmentation_factor * normal_augmentation(site) * surfaces_.face_size(p) / depth *
               slip <=
           -threshold;
  }

  Status::Update Status::update(const StatusInput &input, const bool closing_only)
  {
    const MPI_Comm communicator = surfaces_.layout().communicator;
    if (visited_.empty())
      visited_.push_back(code());

    const std::vector<double>  largest = largest_pressures(input);
    Update                     result;
    std::vector<Contradiction> found;
    for (unsigned int k = 0; k < input.pressure.size(); ++k)
      if (surfaces_.is_owned(k))
      {
        double              size;
        const Contradiction c = contradiction(input, k, largest[surfaces_.pair(k)], size);
        if (projected(k) && (c == Contradiction::over_cone || c == Contradiction::against_slip))
        {
          now_.stick[k] = c == Contradiction::against_slip; // for the reports: the law itself needs no status
          continue;
        }
        if (c == Contradiction::none || frozen_[k] || (closing_only && c != Contradiction::penetration))
          continue;
        result.sites.push_back(k);
        found.push_back(c);
      }

    // Stick would take a site that closes back to where the increment began: one that has come farther than friction
    // can hold slips. So does one that has opened in this loop: stick may be what pulled it open.
    const auto held = [&](const unsigned int k)
    {
      if (opened_[k])
        return false;
      return elastic_slip(k) > 0. ? std::hypot(input.slip[k][0], input.slip[k][1]) <= elastic_slip(k)
                                  : can_stick(input, k, surfaces_.face_size(surfaces_.pair(k)));
    };
    for (unsigned int i = 0; i < result.sites.size(); ++i)
    {
      const unsigned int k = result.sites[i];
      now_.contact[k]      = found[i] != Contradiction::tension;
      if (found[i] == Contradiction::tension)
        opened_[k] = true;
      else
        now_.stick[k] = found[i] == Contradiction::against_slip || (found[i] == Contradiction::penetration && held(k));
      ++ledger_[k].changes;
      ledger_[k].last = found[i];
    }
    result.changes = dealii::Utilities::MPI::sum<unsigned int>(result.sites.size(), communicator);
    if (result.changes > 0 || regularised_)
    {
      surfaces_.site_exchange().update(now_.contact);
      surfaces_.site_exchange().update(now_.stick);
    }
    note_friction(); // of the next system
    if (result.changes > 0)
      find_period(result);
    idle_   = result.changes < fewest_ ? 0 : idle_ + 1;
    fewest_ = std::min(fewest_, result.changes);
    if (!merged_ && idle_ >= tolerated_passes && !regularised_ && can_regularise())
      result.to_regularised = true;
    if (result.to_regularised)
    {
      regularise();
      result.cycles = false;
      returns_      = 0;
      visited_.assign(1, code()); // statuses of other laws say nothing of these
    }
    return result;
  }

  /// Whether and when the present statuses were met before in this loop.
  void Status::find_period(Update &update)
  {
    visited_.push_back(code());
    std::vector<unsigned int> differs;
    for (unsigned int back = 1; back < visited_.size(); ++back)
      differs.push_back(visited_[visited_.size() - 1 - back] != visited_.back());
    dealii::Utilities::MPI::max(differs, surfaces_.layout().communicator, differs);
    const auto met = std::find(differs.begin(), differs.end(), 0u);
    if (met == differs.end())
      return;
    update.period         = met - differs.begin() + 1;
    update.cycles         = merged_ && ++returns_ > tolerated_returns;
    update.to_regularised = !regularised_ && (update.cycles || !merged_) && can_regularise();
    const bool freezes    = !merged_ && !update.to_regularised && strategy_.uses(Remedy::frozen_statuses);
    for (unsigned int k = 0; k < ledger_.size(); ++k)
      for (unsigned int back = visited_.size() - update.period; back < visited_.size(); ++back)
        if (visited_[back][k] != visited_[back - 1][k])
        {
          ledger_[k].period = update.period;
          if (freezes && surfaces_.is_owned(k) && !frozen_[k])
          {
            frozen_[k] = true;
            ++update.frozen;
          }
        }
    if (freezes)
      update.frozen = dealii::Utilities::MPI::sum(update.frozen, surfaces_.layout().communicator);
    visited_.assign(1, code());
  }

  Status::Violation Status::violation(const StatusInput &input, const std::vector<char> &sites) const
  {
    const std::vector<double> largest = largest_pressures(input);
    Violation                 result;
    for (unsigned int k = 0; k < input.pressure.size(); ++k)
      if (surfaces_.is_owned(k) && sites[k])
      {
        double              size;
        const Contradiction c           = contradiction(input, k, largest[surfaces_.pair(k)], size);
        const bool          of_friction = c == Contradiction::over_cone || c == Contradiction::against_slip;
        if (c == Contradiction::none || (of_friction && projected(k)))
          continue;
        ++result.sites;
        if (size > result.value)
        {
          result.value = size;
          result.site  = k;
        }
      }
    const MPI_Comm communicator = surfaces_.layout().communicator;
    keep_largest(result.value, result.site, communicator);
    result.sites = dealii::Utilities::MPI::sum(result.sites, communicator);
    return result;
  }
} // namespace Nodus
