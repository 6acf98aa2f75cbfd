#include "run/arc_length.h"
#include "base/text.h"
#include "parallel/largest.h"
#include "parallel/owned_values.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Part of the interval that rates are differences over: what moves is prescribed or a load, and smooth in time.
    constexpr double time_difference = 1e-6;
  } // namespace

  ArcLength::ArcLength(Model &model, const States &states)
      : model_(model)
      , states_(states)
  {
  }

  /// A displacement where nodes are free: what is prescribed goes with time, and hanging nodes with others.
  Vector ArcLength::free_part(const Vector &motion) const
  {
    const auto       &constraints = model_.boundary_conditions->homogeneous_constraints();
    Vector            part(motion);
    const OwnedValues value(part);
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      if (constraints.is_constrained(i))
        value(i) = 0.;
    return part;
  }

  void ArcLength::begin(const Increment &increment)
  {
    increment_ = increment;
    if (increment.arc == 0.)
      return;
    direction_ = free_part(states_.committed.motion);
    direction_ *= direction_.linfty_norm() / direction_.norm_sqr();
  }

  double ArcLength::motion() const
  {
    return increment_.arc > 0.
               ? direction_ * states_.now.unknowns.block(0) - direction_ * states_.committed.unknowns.block(0)
               : 0.;
  }

  double ArcLength::missing() const
  {
    return acts() ? increment_.arc - motion() : 0.;
  }

  double ArcLength::last_motion() const
  {
    return free_part(states_.committed.motion).linfty_norm();
  }

  /// What the conditions prescribe beyond @p u, with ghosts.
  Vector ArcLength::prescribed(const Vector &u) const
  {
    const auto       &constraints = model_.boundary_conditions->increment_constraints(u);
    Vector            values(states_.now.reaction); // its map: a new one would be collective
    const OwnedValues value(values);
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      value(i) = constraints.is_constrained(i) ? constraints.get_inhomogeneity(i) : 0.;
    return values;
  }

  /// Of internal minus external forces, per time: between time @p t + @p step, what is prescribed moved, and @p t.
  Vector ArcLength::force_change(const double t, const double step, const Vector &prescribed) const
  {
    const Vector &u = states_.now.unknowns.block(0);
    Vector        ahead(u), change, internal, external;
    ahead.add(step, prescribed);
    model_.solid->forces(model_.with_ghosts(ahead), t + step, change, external);
    change -= external;
    model_.solid->forces(model_.with_ghosts(u), t, internal, external);
    change -= internal;
    change += external;
    change /= step;
    return change;
  }

  TimeRates ArcLength::rates(const double             t,
                             const Vector            &u,
                             const DrivenRigidBodies &driven,
                             const bool               linearise_threshold,
                             const bool               with_geometry) const
  {
    const RigidBodies &rigid_bodies = model_.rigid_bodies;
    const double       size         = time_difference * (increment_.interval_end - increment_.interval_begin);
    const double       step         = t + size > increment_.interval_end ? -size : size;
    TimeRates          rates;
    model_.contact->surfaces().layout().reinit(rates.rhs);

    // the conditions at both times, those at hand last
    for (const auto &[time, sign] : {std::make_pair(t + step, 1.), {t, -1.}})
    {
      model_.set_conditions(time);
      Vector values = prescribed(u);
      values *= sign / step;
      if (sign > 0.)
        rates.prescribed = values;
      else
        rates.prescribed += values;
      rates.rigid_force.resize(6 * rigid_bodies.size(), 0.);
      rates.rigid_missing.resize(6 * rigid_bodies.size(), 0.);
      for (unsigned int b = 0; b < rigid_bodies.size(); ++b)
        for (unsigned int c = 0; c < RigidBodies::n_components; ++c)
        {
          const unsigned int i = RigidBodies::n_components * b + c;
          rates.rigid_force[i] += sign / step * rigid_bodies.load(b)[c];
          rates.rigid_missing[i] += sign / step * rigid_bodies.missing(b)[c];
        }
    }

    const Vector        force       = force_change(t, step, rates.prescribed);
    std::vector<double> of_bodies   = driven.resultants(force);
    const auto         &constraints = model_.boundary_conditions->homogeneous_constraints();
    const double        released    = 1. / (increment_.interval_end - increment_.interval_begin); // eq. B4
    const OwnedValues   rhs(rates.rhs.block(0));
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      rhs(i) = constraints.is_constrained(i) ? 0. : -force(i) - released * states_.now.reaction(i);
    dealii::Utilities::MPI::sum(of_bodies, model_.communicator, of_bodies);
    for (unsigned int i = 0; i < of_bodies.size(); ++i)
      rates.rigid_force[i] -= of_bodies[i];
    if (model_.contact->surfaces().n_pairs() > 0 && largest_entry(rates.prescribed) > 0.)
      add_contact(linearise_threshold, with_geometry, rates);
    return rates;
  }

  /// What motions that are prescribed change in the contact: it is linear in them.
  void ArcLength::add_contact(const bool linearise_threshold, const bool with_geometry, TimeRates &rates) const
  {
    ContactInterface   &contact = *model_.contact;
    const BlockLayout  &layout  = contact.surfaces().layout();
    std::vector<double> of_bodies(rates.rigid_force.size(), 0.);
    Vector              moved(rates.prescribed);
    for (const double sign : {1., -1.})
    {
      LinearSystem system; // but for its bulk
      system.layout = &layout;
      layout.reinit(system.rhs);
      contact.set_prescribed(moved);
      contact.assemble(system, linearise_threshold);
      if (with_geometry)
        contact.add_geometry_tangent(system);
      rates.rhs.add(sign, system.rhs);
      for (unsigned int i = 0; i < of_bodies.size(); ++i)
        of_bodies[i] += sign * system.border_rhs[i];
      moved = 0.;
    }
    dealii::Utilities::MPI::sum(of_bodies, model_.communicator, of_bodies);
    for (unsigned int i = 0; i < of_bodies.size(); ++i)
      rates.rigid_force[i] += of_bodies[i];
  }

  void ArcLength::find_step(const double t, const BlockVector &fixed, const BlockVector &rate)
  {
    const double moves = direction_ * rate.block(0);
    if (moves == 0.)
      throw SolverFailure("neither loads nor prescribed motions change with time: arc length finds none; give this "
                          "interval 'Control = time'");
    time_ = t;
    step_ = (missing() - direction_ * fixed.block(0)) / moves;
    if (time(1.) > increment_.interval_end)
      throw SolverFailure(text("the increment goes beyond the end of the interval, to t = ", time(1.)),
                          SolverFailure::Kind::beyond_interval);
    if (time(1.) < increment_.interval_begin)
      throw SolverFailure(text("the increment goes back beyond the begin of the interval, to t = ", time(1.)),
                          SolverFailure::Kind::before_interval);
  }
} // namespace Nodus
