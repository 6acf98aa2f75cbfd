#include "contact/contact_interface.h"
#include "contact/carried_multipliers.h"
#include "contact/geometry_tangent.h"
#include "contact/intrusion.h"
#include "contact/loci.h"
#include "contact/pair_scales.h"
#include "contact/site_values.h"
#include "contact/tractions.h"
#include "mesh/sides.h"
#include "parallel/wait_for_all.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  ContactInterface::ContactInterface(const std::vector<ContactPairParameters> &pairs,
                                     const std::vector<double>                &stiffness,
                                     const StrategyParameters                 &strategy,
                                     const Bodies                             &bodies,
                                     const dealii::DoFHandler<dim>            &dof_handler,
                                     const dealii::Mapping<dim>               &mapping,
                                     const RigidBodies                        &rigid_bodies,
                                     InterfaceState                           &now)
      : pairs_(pairs)
      , rigid_bodies_(rigid_bodies)
      , now_(now)
      , surfaces_(pairs, bodies, dof_handler, mapping, stiffness)
      , status_(pairs, surfaces_, softer_sides(pairs, stiffness), strategy, now.statuses)
      , assembler_(surfaces_, pairing_, jump_, weights_, status_)
      , depths_(softer_diagonals(pairs, stiffness, bodies))
  {
    std::vector<unsigned int> rigid_numbers(bodies.size(), dealii::numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < rigid_bodies.size(); ++i)
      if (rigid_bodies.is_body(i))
        rigid_numbers[rigid_bodies.body(i)] = i;
    surfaces_.set_rigid_bodies(rigid_numbers, rigid_bodies.size());
    std::vector<Vector3> axes;
    for (unsigned int i = 0; i < rigid_bodies.size(); ++i)
      axes.push_back(rigid_bodies.axis(i));
    surfaces_.set_sections(rigid_bodies.sections(), axes);
    now_.tangents.assign(surfaces_.slave_nodes().size(), {});
    now_.elastic_slip.assign(surfaces_.slave_nodes().size(), Vector3());
    now_.area.assign(surfaces_.slave_nodes().size(), 0.);
    now_.force.assign(surfaces_.n_sites(), Vector3());
    now_.jump.assign(surfaces_.n_sites(), Vector3());
    now_.on_new_mesh = false;
    now_.stuck.assign(surfaces_.n_sites(), 0);
  }

  void ContactInterface::begin_attempt()
  {
    status_.begin_increment();
    pairing_.set_partnered(now_.statuses.contact);
    averaged_.set_constrained(now_.constrained());
  }

  // ---------------------------------------------------------------------------------------------------- geometry pass

  void ContactInterface::gather(const BlockVector &unknowns, const Vector &start)
  {
    std::vector<Vector3> u, u_start;
    state_.shortening = rigid_bodies_.shortenings();
    surfaces_.gather(unknowns.block(0), state_.shortening, u);
    surfaces_.gather(start, rigid_bodies_.shortenings(true), u_start);
    state_.x = surfaces_.positions(u);
    state_.centre.resize(rigid_bodies_.size());
    for (unsigned int b = 0; b < rigid_bodies_.size(); ++b)
      state_.centre[b] = rigid_bodies_.centre(b);
    state_.increment.resize(u.size());
    state_.prescribed.resize(u.size());
    for (unsigned int i = 0; i < u.size(); ++i)
      state_.increment[i] = u[i] - u_start[i];

    const unsigned int  n = surfaces_.slave_nodes().size();
    std::vector<double> all(3 * n, 0.);
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
    {
      const DoFIndex multiplier = surfaces_.multiplier(k);
      all[3 * k]                = unknowns.block(1)(multiplier);
      all[3 * k + 1]            = unknowns.block(2)(2 * multiplier);
      all[3 * k + 2]            = unknowns.block(2)(2 * multiplier + 1);
    }
    surfaces_.slave_exchange().update(all, 3);
    state_.lambda.resize(n);
    state_.Lambda.resize(n);
    for (unsigned int k = 0; k < n; ++k)
    {
      state_.lambda[k] = all[3 * k];
      state_.Lambda[k] = {{all[3 * k + 1], all[3 * k + 2]}};
    }
    state_.elastic_slip = now_.elastic_slip;
  }

  void ContactInterface::pair(BlockVector &unknowns, const Vector &start)
  {
    geometry_.reset(); // it refers to the faces
    surfaces_.fetch_masters(unknowns.block(0), rigid_bodies_.shortenings());
    gather(unknowns, start);
    freeze_geometry();
    hand_on(surfaces_, pairing_, status_, now_, state_);
    status_.inherit(pairing_);
    carry_over(surfaces_, pairing_, weights_, now_, state_, unknowns);
    keep_frames();
    unknowns.block(1).compress(dealii::VectorOperation::insert);
    unknowns.block(2).compress(dealii::VectorOperation::insert);
    gather(unknowns, start);
  }

  double ContactInterface::visible_part(const Vector &from, const Vector &to) const
  {
    std::vector<Vector3> before, now;
    surfaces_.gather(from, rigid_bodies_.shortenings(), before); // tied, a section ends together
    surfaces_.gather(to, rigid_bodies_.shortenings(), now);
    return Nodus::visible_part(pairs_, surfaces_, surfaces_.positions(before), surfaces_.positions(now));
  }

  void ContactInterface::resume(const BlockVector &unknowns, const Vector &start)
  {
    status_.resume();
    pairing_.set_partnered(now_.statuses.contact);
    averaged_.set_constrained(now_.constrained());
    gather(unknowns, start);
  }

  void ContactInterface::take_laws(const ContactInterface &other)
  {
    status_.take_laws(other.status_);
    pairing_.set_partnered(other.pairing_.partnered());
    averaged_.set_constrained(other.averaged_.constrained());
  }

  /// Projections, frames, jump operator and surface weights at the current positions.
  void ContactInterface::freeze_geometry()
  {
    paired_at_ = state_.x;
    surfaces_.place_carried_masters(paired_at_);
    geometry_ = std::make_unique<ContactGeometry>(pairs_, surfaces_, paired_at_);
    averaged_.compute(pairs_, surfaces_, *geometry_, paired_at_, surfaces_.reference_positions());
    pairing_.project(pairs_, surfaces_, *geometry_, averaged_);
    jump_.build(pairs_, surfaces_, *geometry_, pairing_, averaged_, status_);
    weigh();
    if (now_.on_new_mesh)
      carry_over_sticking();
    wait_for_all(surfaces_.layout().communicator);
  }

  /// The multipliers refer to the frames and areas of the last pairing from here on.
  void ContactInterface::keep_frames()
  {
    for (unsigned int k = 0; k < now_.tangents.size(); ++k)
    {
      now_.tangents[k] = pairing_[k].tangent;
      now_.area[k]     = pairing_[k].found ? weights_.area()[k] : 0.;
    }
  }

  void ContactInterface::weigh()
  {
    weights_.compute(pairs_, surfaces_, averaged_, paired_at_, surfaces_.reference_positions(), status_.lumped());
  }

  /// On a new mesh: sites that stick do so where the surfaces stuck, not where interpolated displacements that are not
  /// in equilibrium have put them: the jump of the displacement is taken over besides these. Where the difference would
  /// change friction by more than its limit it is one of geometry (slip on curved surfaces), and left out (eq. X2).
  void ContactInterface::carry_over_sticking()
  {
    std::vector<Vector3> u = displacement();
    for (unsigned int n = 0; n < u.size(); ++n)
      u[n] -= state_.increment[n];
    std::vector<Vector3> stuck(surfaces_.n_sites());
    for (unsigned int s = 0; s < stuck.size(); ++s)
    {
      if (!surfaces_.is_owned(s) || !now_.stuck[s] || !pairing_[s].found || !status_.friction(s) || !status_.stick(s))
        continue;
      Vector3 moved = jump_.jump(s, u) - now_.jump[s];
      moved -= (moved * pairing_[s].normal) * pairing_[s].normal;
      if (status_.tangential_augmentation(s, status_.threshold(s)) * moved.norm() <= 1.)
        stuck[s] = moved;
    }
    surfaces_.site_exchange().update(stuck);
    jump_.set_stuck(std::move(stuck));
  }

  /// Displacements of the surface nodes.
  std::vector<Vector3> ContactInterface::displacement() const
  {
    const std::vector<Point> X = surfaces_.reference_positions();
    std::vector<Vector3>     u(X.size());
    for (unsigned int n = 0; n < u.size(); ++n)
      u[n] = state_.x[n] - X[n];
    return u;
  }

  // ------------------------------------------------------------------------------------------ thresholds and statuses

  void ContactInterface::freeze_threshold(const double duration)
  {
    update_slip_rates(duration);
    status_.freeze_threshold(pressure());
    begin_friction();
  }

  void ContactInterface::freeze_thresholds(std::vector<double> thresholds)
  {
    status_.freeze(std::move(thresholds));
    begin_friction();
  }

  void ContactInterface::begin_friction()
  {
    if (has_friction() && status_.gains_friction())
      status_.begin_friction(status_input(), depths_);
  }

  void ContactInterface::follow_pressure(const double duration, BlockVector &unknowns, const Vector &start)
  {
    std::vector<double> before(status_.size());
    for (unsigned int k = 0; k < before.size(); ++k)
      before[k] = status_.friction(k) ? status_.threshold(k) : 0.;
    freeze_threshold(duration);
    for (const ContactPoint &point : weights_.points())
      if (const unsigned int k = point.slaves[0]; point.slaves.size() == 1 && surfaces_.is_owned(k) &&
                                                  before[k] != 0. && status_.friction(k) && status_.stick(k) &&
                                                  status_.elastic_slip(k) == 0.)
        for (unsigned int i = 0; i < 2; ++i)
          unknowns.block(2)(2 * surfaces_.multiplier(k) + i) = state_.Lambda[k][i] * before[k] / status_.threshold(k);
    unknowns.block(2).compress(dealii::VectorOperation::insert);
    gather(unknowns, start);
  }

  void ContactInterface::update_slip_rates(const double duration)
  {
    if (!status_.friction_varies() || duration == 0.)
      return;
    std::vector<std::array<double, 2>> slips;
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      slips.push_back(surfaces_.is_owned(s) ? slip(s) : std::array<double, 2>());
    status_.set_slips(slips, duration);
  }

  std::vector<double> ContactInterface::pressure() const
  {
    return friction_pressure(surfaces_, pairing_, weights_, status_, assembler_, state_);
  }

  StatusInput ContactInterface::status_input() const
  {
    return Nodus::status_input(pairs_, surfaces_, pairing_, weights_, status_, assembler_, state_);
  }

  void ContactInterface::pass_to_regularised_law(BlockVector &unknowns, const Vector &start)
  {
    const std::vector<double> mean   = pressure();
    const std::vector<bool>   lumped = status_.lumped();
    weigh();
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
      if (lumped[surfaces_.pair(k)])
        unknowns.block(1)(surfaces_.multiplier(k)) = mean[k];
    unknowns.block(1).compress(dealii::VectorOperation::insert);
    gather(unknowns, start);
  }

  Status::Violation ContactInterface::violation() const
  {
    return status_.violation(status_input());
  }

  Status::Change ContactInterface::threshold_change(const double duration)
  {
    update_slip_rates(duration);
    return status_.threshold_change(pressure());
  }

  Status::Violation ContactInterface::frozen_violation() const
  {
    return status_.frozen_violation(status_input());
  }

  // ------------------------------------------------------------------------------------------------ residual, tangent

  void ContactInterface::set_prescribed(const Vector &prescribed)
  {
    surfaces_.gather(prescribed, state_.prescribed);
  }

  void ContactInterface::assemble(LinearSystem &system, const bool linearise_threshold)
  {
    residual_ = assembler_.assemble(state_, system, linearise_threshold);
  }

  void ContactInterface::add_geometry_tangent(LinearSystem &system) const
  {
    GeometryTangent(pairs_, surfaces_, *geometry_, averaged_, pairing_, jump_, weights_, status_)
        .add(state_, residual_, system);
  }

  void ContactInterface::add_forces(Vector &force) const
  {
    assembler_.add_forces(residual_, force);
  }

  // -------------------------------------------------------------------------------------------------------- state kept

  void ContactInterface::end_increment(const double duration)
  {
    std::vector<std::array<double, 2>> slips;
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      slips.push_back(status_.holds_friction(s) ? std::array<double, 2>{{0., 0.}} : slip(s));
    status_.add_slip(slips, duration, pressure());
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      if (surfaces_.is_owned(s) && surfaces_.has_status(s))
        now_.force[s] = -residual_.jump[s];
    for (unsigned int k = 0; k < now_.elastic_slip.size(); ++k)
      now_.elastic_slip[k] = status_.elastic_slip(k) * (state_.Lambda[k][0] * pairing_[k].tangent[0] +
                                                        state_.Lambda[k][1] * pairing_[k].tangent[1]);
    now_.jump = displacement_jumps();
    keep_frames();
    now_.stuck.assign(now_.stuck.size(), 0);
    now_.on_new_mesh = false;
    jump_.set_stuck({});
  }

  std::vector<ContactFields> ContactInterface::fields() const
  {
    return contact_fields(pairs_, surfaces_, pairing_, weights_, status_, assembler_, state_, residual_);
  }

  std::vector<ContactResultants> ContactInterface::resultants() const
  {
    return contact_resultants(pairs_, surfaces_, pairing_, jump_, weights_, status_, state_, residual_);
  }

  void ContactInterface::hold(FreeMotions &motions, const bool as_closed) const
  {
    motions.hold_contact(surfaces_, pairing_, jump_, status_, state_, residual_, as_closed);
  }

  // ------------------------------------------------------------------------------------------------- values and places

  std::vector<Vector3> ContactInterface::displacement_jumps() const
  {
    const std::vector<Vector3> u = displacement();
    std::vector<Vector3>       jumps;
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      jumps.push_back(jump_.jump(s, u));
    return jumps;
  }

  unsigned int ContactInterface::n_closed() const
  {
    unsigned int n = 0;
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      n += surfaces_.is_owned(s) && surfaces_.has_status(s) && status_.contact(s);
    return dealii::Utilities::MPI::sum(n, surfaces_.layout().communicator);
  }

  std::string ContactInterface::locus(const unsigned int site) const
  {
    const auto found =
        loci(site < surfaces_.n_sites() ? std::vector<unsigned int>{site} : std::vector<unsigned int>(), 1);
    return found.empty() ? "" : found.front();
  }

  std::vector<std::string> ContactInterface::loci(const std::vector<unsigned int> &sites, const unsigned int n) const
  {
    return Nodus::loci(pairs_, surfaces_, sites, n);
  }
} // namespace Nodus
