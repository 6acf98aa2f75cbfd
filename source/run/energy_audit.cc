#include "run/energy_audit.h"
#include "contact/loci.h"
#include "contact/site_values.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// An increment that leaves more than this part of its energies unexplained is looked at, if that is more than the
    /// second number of all energies so far.
    constexpr double large_imbalance = 0.05, small_part = 0.01;
    /// Of Young's modulus times volume: stored energies are not resolved below that, since laws see I + grad u.
    constexpr double resolved = 1e-13;
    /// Friction must give so many times what the tolerances leave to be said to create energy.
    constexpr double beyond_tolerance = 10.;
  } // namespace

  double Energies::throughput() const
  {
    return std::max({std::abs(external),
                     std::abs(released),
                     std::abs(stored),
                     std::abs(friction),
                     std::abs(plastic),
                     std::abs(stabilisation)});
  }

  EnergyAudit::EnergyAudit(const Model &model, Journal &journal, States &states, const Equilibrium &equilibrium)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , equilibrium_(equilibrium)
  {
  }

  void EnergyAudit::account(const InnerEnergy &inner)
  {
    const Increment   &increment = equilibrium_.increment();
    const NodalForces &forces    = equilibrium_.forces();
    State             &now       = states_.now;
    const State       &start     = states_.committed;

    // What the bodies take in (eq. E2).
    const Vector applied     = equilibrium_.applied_forces();
    const double rest        = increment.left_to_release(increment.end),
                 rest_before = increment.left_to_release(increment.begin);
    const auto &constraints  = model_.boundary_conditions->homogeneous_constraints();
    Energies    of_increment;
    double      stored = inner.stored, plastic = inner.dissipated, resolution = resolved * inner.stiffness;
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
    {
      const double moved   = now.unknowns.block(0)(i) - start.unknowns.block(0)(i);
      const double release = constraints.is_constrained(i) ? 0. : 0.5 * (rest_before + rest) * now.reaction(i) * moved;
      of_increment.external += 0.5 * (start.applied(i) + applied(i)) * moved - release;
      of_increment.released += release;
      of_increment.stabilisation -= forces.drag(i) * moved; // constant in the increment
    }
    const ContactWork work = contact_work();
    of_increment.external += work.masters;
    of_increment.contact  = work.surfaces;
    of_increment.friction = work.friction;

    stored += model_.solid->spring_energy(model_.with_ghosts(now.unknowns.block(0)));
    if (dealii::Utilities::MPI::this_mpi_process(model_.communicator) == 0)
      of_increment.external += model_.rigid_bodies.work(start.rigid, equilibrium_.driven().applied());

    for (double *sum : {&of_increment.external,
                        &of_increment.released,
                        &of_increment.stabilisation,
                        &of_increment.contact,
                        &of_increment.friction,
                        &stored,
                        &plastic,
                        &resolution})
      *sum = dealii::Utilities::MPI::sum(*sum, model_.communicator);
    of_increment.stabilisation += equilibrium_.relaxed_work();
    of_increment.stored  = stored - now.energies.stored;
    of_increment.plastic = plastic - now.energies.plastic;

    now.energies.external += of_increment.external;
    now.energies.released += of_increment.released;
    now.energies.contact += of_increment.contact;
    now.energies.stored = stored;
    now.energies.friction += of_increment.friction;
    now.energies.plastic = plastic;
    now.energies.stabilisation += of_increment.stabilisation;
    of_increment.unresolved = unresolved(resolution);
    now.energies.unresolved += of_increment.unresolved;
    if (!std::isfinite(of_increment.imbalance() + now.energies.imbalance()))
      throw SolverFailure(
          "forces and displacements are finite, but the energies of the increment are not: are the units "
          "of lengths, stiffness and loads right?",
          SolverFailure::Kind::not_finite);
    now.applied = applied;
    if (!increment.on_new_mesh()) // which stores another energy
      warn(of_increment, work.creating);
  }

  EnergyAudit::ContactWork EnergyAudit::contact_work() const
  {
    const ContactInterface     &contact    = *model_.contact;
    const ContactSurfaces      &surfaces   = contact.surfaces();
    const std::vector<Vector3> &before     = states_.committed.contact.force;
    const double                negligible = negligible_dissipation();
    const auto                  elastic =
        elastic_slip_change(surfaces, contact.pairing(), contact.weights(), contact.status(), contact.state());
    ContactWork work;
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      if (!surfaces.is_owned(s) || !surfaces.has_status(s))
        continue;
      const Vector3               force       = -contact.residual().jump[s]; // on the slave
      const std::array<double, 2> slip        = contact.slip(s);
      const Vector3              &n           = contact.pairing()[s].normal;
      double                      dissipation = 0.;
      for (unsigned int i = 0; i < 2 && !contact.status().holds_friction(s); ++i)
      {
        const Vector3 &t = contact.pairing()[s].tangent[i];
        dissipation -= (force * t) * (slip[i] - elastic[s][i]);
        work.surfaces += 0.5 * ((before[s] + force) * t) * elastic[s][i];
      }
      work.masters += 0.5 * (before[s] + force) * contact.jump().rigid(s).moved;
      work.surfaces +=
          0.5 * ((before[s] + force) * n) * (n * contact.jump().jump_of_increment(s, contact.state().increment));
      work.friction += dissipation;
      if (dissipation < -negligible)
        work.creating.push_back(s);
    }
    return work;
  }

  /// Of a site: what the tolerances of Newton's method on slips leave at the largest force.
  double EnergyAudit::negligible_dissipation() const
  {
    const ContactInterface &contact  = *model_.contact;
    const ContactSurfaces  &surfaces = contact.surfaces();
    double                  force = 0., motion = model_.length_scale;
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      if (surfaces.is_owned(s))
        force = std::max(force, contact.residual().jump[s].norm());
    for (const Vector3 &moved : contact.state().increment)
      motion = std::max(motion, moved.norm());
    return beyond_tolerance * model_.parameters.newton.contact_tolerance *
           dealii::Utilities::MPI::max(force, model_.communicator) *
           dealii::Utilities::MPI::max(motion, model_.communicator);
  }

  /// Of the bodies and springs in the increment, along the straight path between its ends (eq. E4), each point of it
  /// reached from the states of the materials that the increment starts from. Collective. @throws SolverFailure
  /// where cells turn inside out on that path.
  double EnergyAudit::work_of_stresses() const
  {
    constexpr std::array<double, 5> boole = {{7. / 90., 32. / 90., 12. / 90., 32. / 90., 7. / 90.}};
    SolidAssembler                 &solid = *model_.solid;
    const Vector                   &start = states_.committed.unknowns.block(0);
    Vector                          moved(states_.now.unknowns.block(0)), internal(moved), external(moved);
    moved -= start;
    double work = 0.;
    for (unsigned int q = 0; q < boole.size(); ++q)
    {
      Vector u(start);
      u.add(double(q) / (boole.size() - 1), moved);
      solid.forces(model_.with_ghosts(u), equilibrium_.increment().end, internal, external);
      work += boole[q] * (internal * moved);
    }
    return work;
  }

  /// @param resolution of stored energies. Collective.
  double EnergyAudit::unresolved(const double resolution) const
  {
    const double motion =
        std::max(largest_difference(
                     model_.contact->surfaces(), states_.now.unknowns.block(0), states_.committed.unknowns.block(0)),
                 model_.length_scale);
    return std::max(resolution,
                    beyond_tolerance * model_.parameters.newton.force_tolerance * equilibrium_.forces().scale * motion);
  }

  /// @param creating sites of this rank where friction created energy. Collective.
  void EnergyAudit::warn(const Energies &increment, const std::vector<unsigned int> &creating) const
  {
    const ContactInterface &contact  = *model_.contact;
    const Energies         &energies = states_.now.energies;
    const unsigned int n_creating    = dealii::Utilities::MPI::sum<unsigned int>(creating.size(), model_.communicator);
    if (n_creating > 0)
      journal_.console.remark("warning: friction creates energy at " + std::to_string(n_creating) + " sites, first " +
                              contact.loci(creating, 1).front() +
                              ": its force does not oppose the slip there; see energy.csv, and try smaller increments");
    const double limit =
        std::max({large_imbalance * increment.throughput(), small_part * energies.throughput(), increment.unresolved});
    if (std::abs(increment.imbalance()) <= limit)
      return;

    // Where forces change within the increment that is what their mean misses. The bodies themselves have no such part.
    const double taken = increment.stored + increment.plastic;
    double       work  = taken;
    model_.solid->start_from(states_.committed.history);
    try
    {
      work = work_of_stresses();
    }
    catch (const SolverFailure &) // nothing can be said
    {
    }
    model_.solid->start_from(states_.now.history);
    if (std::abs(taken - work) <= limit)
      return;
    std::ostringstream text;
    text.precision(3);
    text << "warning: the bodies store and dissipate " << taken << " in this increment, but the work of their stresses "
         << "is " << work << ": yielding turns round within it, or the stress of a material does not follow from its "
         << "energy; try smaller increments ('Load stepping/Increments')";
    journal_.console.remark(text.str());
  }
} // namespace Nodus
