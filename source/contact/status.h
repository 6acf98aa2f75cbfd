#ifndef nodus_contact_status_h
#define nodus_contact_status_h

#include "contact/friction_limit.h"
#include "contact/pressure_gap.h"
#include "contact/surface.h"
#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace Nodus
{
  class Pairing;

  /// Quantities at the contact sites that the status tests look at.
  struct StatusInput
  {
    std::vector<double>                pressure; ///< lambda_bar (weighted) or lambda (raw) [pressure]
    std::vector<double>                distance; ///< d_n > 0 penetration, beyond what the pressure gives [length]
    std::vector<std::array<double, 2>> Lambda;   ///< friction semi-multiplier in the tangent frame
    std::vector<std::array<double, 2>> slip;     ///< tangential jump of the increment, scaled as
                                                 ///< SitePairing::friction_scale says, beyond elastic slip [length]
  };

  /// Why a status changed: what contradicted it.
  enum class Contradiction : char
  {
    none,
    tension,     ///< while closed
    penetration, ///< while open
    over_cone,   ///< friction traction beyond the threshold while stick
    against_slip ///< slip against the friction traction
  };

  /// What happened to a site's status in the increment.
  struct StatusLedger
  {
    unsigned int  changes = 0;
    unsigned int  period  = 0; ///< passes after which a cycle that moved this site came back; 0: no cycle
    Contradiction last    = Contradiction::none;
  };

  /// Contact status S, friction status S_f and frozen threshold mu lambda_s of the local contact sites: slave nodes, or
  /// the integration points of pairs with that scheme (their slave nodes stay open). Owners decide, ghosts follow.
  class Status
  {
  public:
    using FrictionState = std::array<double, FrictionPoint::max_state>;
    /// What the statuses hand on from one increment to the next, for all local sites.
    struct State
    {
      std::vector<char>                  contact, stick;  ///< S, S_f
      std::vector<double>                threshold;       ///< mu lambda_s <= 0 [pressure]
      std::vector<std::array<double, 2>> slip;            ///< accumulated, in the tangent frame [length]
      std::vector<double>                adjustment;      ///< of d_n at the first pairing [length]
      std::vector<double>                friction_factor; ///< of the last slip rate
      std::vector<double>                slip_rate;       ///< of the last iterate [length/time]
      std::vector<FrictionState>         friction_state;  ///< of the user's friction law, as the increment begins
    };

    /// @p stiffness of each pair [pressure]; @p strategy: what is tried where statuses cycle. @p now outlives it, and
    /// is what it reads and moves; it is set to that of open sites.
    Status(const std::vector<ContactPairParameters> &pairs,
           const ContactSurfaces                    &surfaces,
           const std::vector<double>                &stiffness,
           const StrategyParameters                 &strategy,
           State                                    &now);

    /// Number of local contact sites.
    unsigned int size() const
    {
      return now_.contact.size();
    }
    bool contact(const unsigned int site) const
    {
      return now_.contact[site];
    }
    /// S_f: meaningful where friction() holds.
    bool stick(const unsigned int site) const
    {
      return now_.stick[site];
    }
    /// mu lambda_s <= 0, frozen by the threshold loop.
    double threshold(const unsigned int site) const
    {
      return now_.threshold[site];
    }
    /// In contact with a threshold above the relative floor; otherwise the site is frictionless.
    bool friction(const unsigned int site) const
    {
      return now_.contact[site] && -now_.threshold[site] > threshold_floor_[surfaces_.pair(site)];
    }
    /// An integration point whose laws are regularised.
    bool projected(const unsigned int site) const
    {
      return regularised_ && can_project(surfaces_.pair(site));
    }
    /// While equilibrium is found on a new mesh: motion that is due to the mesh alone has no friction of its own. Sites
    /// that slip keep the friction direction that they were taken over with, and are not tested for friction.
    void hold_friction(const bool hold)
    {
      hold_ = hold;
    }
    bool holds_friction(const unsigned int site) const
    {
      return hold_ && pairs_[surfaces_.pair(site)].contact_law != ContactPairParameters::ContactLaw::tied;
    }
    /// Pairs whose consistent weights are lumped for now, because their laws are regularised.
    std::vector<bool> lumped() const;
    ContactStatus     status(const unsigned int site) const
    {
      return !contact(site)                  ? ContactStatus::open
             : friction(site) && stick(site) ? ContactStatus::stick
                                             : ContactStatus::slip;
    }
    /// Derivative of the threshold with respect to the pressure that froze it.
    double threshold_slope(const unsigned int site) const
    {
      return threshold_slope_[site];
    }
    /// What of d_n at the first pairing counts as no overclosure (d_n > 0) or gap (d_n < 0) now [length].
    double adjustment(const unsigned int site) const
    {
      return now_.adjustment[site] * (interferes(surfaces_.pair(site)) ? 1. - resolved_[surfaces_.pair(site)] : 1.);
    }
    /// rho_n = h_n of the site's pair (eq. Q1) [pressure/length].
    double normal_augmentation(const unsigned int site) const
    {
      return normal_augmentation_[surfaces_.pair(site)];
    }
    /// rho_tau = h_tau for a friction threshold (eq. Q2): friction is augmented as pressure is [1/length].
    double tangential_augmentation(const unsigned int site, const double threshold) const
    {
      const unsigned int pair = surfaces_.pair(site);
      return pairs_[pair].tangential_augmentation_factor * normal_augmentation_[pair] /
             std::max(-threshold, threshold_floor_[pair]);
    }

    /// s_v, as which integration points without friction weigh in the rows of their multipliers (eq. Q4); 0 where no
    /// site of the pair has friction [pressure].
    double void_threshold(const unsigned int site) const
    {
      return void_threshold_[surfaces_.pair(site)];
    }

    /// Of the site's pair: null where contact is hard.
    const PressureGapLaw *pressure_gap_law(const unsigned int site) const
    {
      return gap_laws_[surfaces_.pair(site)].get();
    }
    bool has_elastic_slip() const
    {
      return surfaces_.n_layers() > 1 ||
             std::any_of(pairs_.begin(), pairs_.end(), [](const auto &pair) { return pair.elastic_slip > 0.; });
    }
    /// Slip over which friction reaches its limit [length]: that of the pair. Where a node sticks to several masters,
    /// which hold its three displacements by more constraints than that, next to nothing instead of nothing.
    double elastic_slip(const unsigned int site) const
    {
      return site < elastic_slip_.size() ? elastic_slip_[site] : pairs_[surfaces_.pair(site)].elastic_slip;
    }

    /// Gap up to which sites of a pair start closed [length].
    double closing_distance(unsigned int pair) const;
    /// First pairing of the pairs that begin to act at time @p t: by gap, closed or open, and what is adjusted.
    /// Collective.
    void initialize(const Pairing &pairing, const std::vector<double> &distance, double t);
    /// Imposes the state of one site: S, S_f and mu lambda_s; call it on every rank that has the site. Collective.
    void assign(unsigned int site, bool contact, bool stick, double threshold);
    /// The open @p site closes as @p giver is. Of its owner; inherit() tells the others.
    void take_over(unsigned int site, unsigned int giver);
    /// Sites that lost their partner open. Collective.
    void inherit(const Pairing &pairing);

    struct Change
    {
      double       value = 0.;
      unsigned int site  = dealii::numbers::invalid_unsigned_int; ///< on the rank that owns it, invalid on others
    };
    /// The largest change of a threshold mu lambda_s that @p site_pressure would bring, relative to the largest
    /// threshold of its pair (eq. L2), and its site. Collective.
    Change threshold_change(const std::vector<double> &site_pressure) const;
    /// Freezes the thresholds that @p site_pressure leads to. Collective.
    void freeze_threshold(const std::vector<double> &site_pressure);
    /// Whether the last thresholds have brought friction to closed sites that had none. Collective.
    bool gains_friction() const;
    /// Of these, those slip that have come farther without it than friction could hold over @p depth [length] of each
    /// pair (eq. S3). Collective.
    void begin_friction(const StatusInput &input, const std::vector<double> &depth);
    /// mu lambda_s of every local site: as it is frozen, and as it would be with @p site_pressure.
    const std::vector<double> &thresholds() const
    {
      return now_.threshold;
    }
    std::vector<double> thresholds_at(const std::vector<double> &site_pressure) const;
    /// Freezes these instead, which need not belong to a pressure; right at owned sites. Collective.
    void freeze(std::vector<double> thresholds);
    bool has_friction(const unsigned int pair) const
    {
      return limits_[pair].exists();
    }
    /// Whether some pair has friction at all; friction that depends on the pressure; friction that depends on position,
    /// slip rate or time.
    bool has_friction() const
    {
      return has(&FrictionLimit::exists);
    }
    bool threshold_follows_pressure() const
    {
      return has(&FrictionLimit::follows_pressure);
    }
    bool friction_varies() const
    {
      return has(&FrictionLimit::varies);
    }
    /// The @p slip of the owned sites in an increment of this @p duration, whose rates friction factors and the laws of
    /// users depend on. @throws InputError on every rank where a factor or a limit is not >= 0. Collective.
    void set_slips(const std::vector<std::array<double, 2>> &slip, double duration);
    /// The time that friction depends on, and the part of the interference of each pair that is pressed out by then, 0
    /// to 1.
    void set_time(const double t, std::vector<double> resolved_interference)
    {
      for (FrictionLimit &limit : limits_)
        limit.set_time(t);
      resolved_ = std::move(resolved_interference);
    }

    /// Statuses forget which vectors this loop has visited. @p merged: updates follow single Newton iterations.
    void begin_loop(bool merged = false);
    struct Update
    {
      unsigned int              changes        = 0;     ///< on all ranks
      unsigned int              period         = 0;     ///< > 0: this status vector was visited that many passes ago
      bool                      cycles         = false; ///< merged loop: visited again too often
      unsigned int              frozen         = 0;     ///< sites that keep their status from here on, on all ranks
      bool                      to_regularised = false; ///< from here on laws are regularised where that is possible
      std::vector<unsigned int> sites;                  ///< of this rank that changed
    };
    /// Tests every site and changes those that contradict their status (eq. 2, 7, S2); begin_loop() comes first. Where
    /// a status vector comes back, changes would cycle, and no vector may satisfy all sites: those that take part in
    /// the cycle, and in later ones, keep the status that they have; frozen_violation() tells by how much they
    /// contradict it. A merged loop has no such rule and cycles when vectors come back time and again. Before that, and
    /// where a loop of its own goes on without fewer changes, sites that share multipliers, whose conditions need not
    /// have a common solution, get regularised laws for the rest of the attempt: see regularise(). Collective.
    /// @p closing_only: sites that penetrate close, nothing else changes (an iterate whose pressures mean nothing yet).
    Update update(const StatusInput &input, bool closing_only = false);

    /// Until begin_increment():
    /// - Integration points have the pressure lambda - rho_n d_n where that is negative, and the friction direction
    ///   Lambda + rho_tau slip projected on the unit ball (eq. F3). Frictionless, this is the saddle point of an
    ///   augmented Lagrangian: it exists, and statuses that belong to it.
    /// - Consistent weights with friction are lumped: a node rubs with the threshold of its own mean pressure, not with
    ///   those of its neighbours, which would go on where it opens. Its mean pressure has the same equations as before.
    void regularise()
    {
      regularised_ = true;
    }
    /// The laws that @p other solves now: regularised or not, with friction held or not.
    void take_laws(const Status &other)
    {
      regularised_ = other.regularised_;
      hold_        = other.hold_;
    }
    /// Largest violation of all sites, or of those that were frozen in this loop, relative to the pressure of the pair
    /// or to the cone, where it is, and how many have one. Collective.
    struct Violation
    {
      double       value = 0.;
      unsigned int site  = dealii::numbers::invalid_unsigned_int; ///< on the rank that owns it, invalid on others
      unsigned int sites = 0;                                     ///< on all ranks
    };
    Violation violation(const StatusInput &input) const
    {
      return violation(input, std::vector<char>(now_.contact.size(), true));
    }
    Violation frozen_violation(const StatusInput &input) const
    {
      return violation(input, frozen_);
    }

    /// Statuses of the local sites as one vector, to be compared with that of another time.
    std::vector<char> code() const;

    /// The state that it refers to has been set to another one: what follows from it is found anew. Collective.
    void resume();

    /// Empties the ledger, at the start of an increment.
    void                begin_increment();
    const StatusLedger &ledger(const unsigned int site) const
    {
      return ledger_[site];
    }
    const std::array<double, 2> &accumulated_slip(const unsigned int site) const
    {
      return now_.slip[site];
    }

    /// Adds the slip of the increment at closed sites, right at owned ones, and what it does to the state of friction.
    /// Collective.
    void add_slip(const std::vector<std::array<double, 2>> &slip, double duration, const std::vector<double> &pressure);

  private:
    bool has(bool (FrictionLimit::*property)() const) const
    {
      return std::any_of(
          limits_.begin(), limits_.end(), [&](const FrictionLimit &limit) { return (limit.*property)(); });
    }
    FrictionPoint friction_point(unsigned int site) const;
    bool          interferes(const unsigned int pair) const
    {
      return pairs_[pair].start.overclosure == ContactPairParameters::InitialOverclosure::interference;
    }
    bool can_project(unsigned int pair) const;
    bool can_lump(unsigned int pair) const;
    /// Its closed nodes have no gap once the system is solved: they share their multipliers with no other site.
    bool has_own_gap(unsigned int pair) const;
    bool can_regularise() const;
    void update_floor();
    void note_friction();
    /// How a site contradicts its status, and by how much: relative to @p pressure of the pair, or to the cone.
    Contradiction       contradiction(const StatusInput &input, unsigned int site, double pressure, double &size) const;
    std::vector<double> largest_pressures(const StatusInput &input) const;
    Violation           violation(const StatusInput &input, const std::vector<char> &sites) const;
    void                find_period(Update &update);
    /// Whether friction could hold the slip of a site if it sheared the softer body over this @p depth [length].
    bool can_stick(const StatusInput &input, unsigned int site, double depth) const;
    bool gains_friction(unsigned int site) const;

    const std::vector<ContactPairParameters>          &pairs_;
    const ContactSurfaces                             &surfaces_;
    const StrategyParameters                          &strategy_;
    std::vector<double>                                normal_augmentation_;
    std::vector<FrictionLimit>                         limits_; ///< of the pairs
    std::vector<std::shared_ptr<const PressureGapLaw>> gap_laws_;
    State                                             &now_;
    std::vector<double>                                threshold_slope_; ///< of the sites
    std::vector<double>                                slip_length_;  ///< of the sites, accumulated up to the iterate
    std::vector<double>                                elastic_slip_; ///< of the slave nodes
    std::vector<double>                                threshold_floor_; ///< of the pairs
    std::vector<double>                                void_threshold_;  ///< of the pairs
    std::vector<double>                                resolved_;        ///< interference, of the pairs
    std::vector<StatusLedger>                          ledger_;
    std::vector<std::vector<char>>                     visited_;
    std::vector<char>                                  opened_; ///< in this status loop
    std::vector<char>                                  frozen_; ///< in this status loop
    std::vector<char> had_friction_; ///< at the last test: the iterate knows of friction there
    bool              merged_      = false;
    bool              regularised_ = false; ///< in this attempt at the increment
    bool              hold_        = false;
    unsigned int      returns_     = 0; ///< to a visited vector, in this loop
    unsigned int      fewest_      = 0; ///< changes in a pass of this loop
    unsigned int      idle_        = 0; ///< passes since then
  };
} // namespace Nodus

#endif
