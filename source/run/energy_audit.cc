#include "run/contact_problem_implementation.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// An increment that leaves more than this part of its energies unexplained is warned of, if that is more than the
    /// second number of all energies so far.
    constexpr double large_imbalance = 0.05, small_part = 0.01;
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

  Energies &Energies::operator-=(const Energies &other)
  {
    external -= other.external;
    released -= other.released;
    stabilisation -= other.stabilisation;
    contact -= other.contact;
    stored -= other.stored;
    friction -= other.friction;
    plastic -= other.plastic;
    return *this;
  }

  /// Loads, released reactions and reactions: all forces on the bodies but those of contact.
  Vector ContactProblem::Implementation::applied_forces() const
  {
    const auto &constraints = boundary_conditions->homogeneous_constraints();
    Vector      forces(external);
    forces -= drag;
    for (const DoFIndex i : surfaces->layout().owned[0])
      if (constraints.is_constrained(i))
        forces(i) = internal(i) + contact_force(i);
    for (unsigned int b = 0; b < rigid_bodies->size(); ++b) // what drives these counts as force and moment
      for (const RigidBodies::Node &node : rigid_bodies->nodes(b))
        for (unsigned int c = 0; c < dim; ++c)
          forces(node.dof + c) = external(node.dof + c) - drag(node.dof + c);
    forces.compress(dealii::VectorOperation::insert);
    return forces;
  }

  /// Takes account of the increment that has just converged, the states of its materials included; the displacement and
  /// the forces that it started from are still the committed ones.
  void ContactProblem::Implementation::audit_energies()
  {
    const Energies before = energies;

    // What the bodies take in.
    const Vector applied = applied_forces();
    const double rest = release_fraction(time), rest_before = release_fraction(path.time());
    const auto  &constraints = boundary_conditions->homogeneous_constraints();
    double       sums[7]     = {0., 0., 0., 0., 0., 0., 0.}; // in the order of the members of Energies
    for (const DoFIndex i : surfaces->layout().owned[0])
    {
      const double moved   = solution.block(0)(i) - committed.block(0)(i);
      const double release = constraints.is_constrained(i) ? 0. : 0.5 * (rest_before + rest) * reaction(i) * moved;
      sums[0] += 0.5 * (committed_applied(i) + applied(i)) * moved - release;
      sums[1] += release;
      sums[6] -= drag(i) * moved; // constant in the increment
    }

    // What contact does. The residual is minus the force on the slave.
    std::vector<unsigned int> creating;
    const double              negligible = negligible_dissipation();
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
    {
      if (!surfaces->is_owned(s) || !surfaces->has_status(s))
        continue;
      const Vector3               force       = -residual.jump[s];
      const std::array<double, 2> slip        = contact->slip(state, s);
      const Vector3              &n           = pairing[s].normal;
      double                      dissipation = 0.;
      for (unsigned int i = 0; i < 2 && !status->holds_friction(s); ++i)
        dissipation -= force * pairing[s].tangent[i] * slip[i];
      sums[0] += 0.5 * (committed_site_force[s] + force) * jump.rigid(s).moved;
      sums[2] += 0.5 * ((committed_site_force[s] + force) * n) * (n * jump.jump_of_increment(s, state.increment));
      sums[4] += dissipation;
      if (dissipation < -negligible)
        creating.push_back(s);
      committed_site_force[s] = force;
    }

    // What is stored and dissipated.
    relevant_u = solution.block(0);
    solid->visit(relevant_u,
                 [&](const auto &, const std::vector<SolidAssembler::PointResult> &points)
                 {
                   for (const auto &point : points)
                   {
                     sums[3] += point.stored_energy * point.JxW;
                     sums[5] += point.dissipation * point.JxW;
                   }
                 });
    sums[3] += solid->spring_energy(relevant_u);

    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      sums[0] += rigid_bodies->work(rigid_applied);

    for (double &sum : sums)
      sum = dealii::Utilities::MPI::sum(sum, communicator);
    energies.external += sums[0];
    energies.released += sums[1];
    energies.contact += sums[2];
    energies.stored = sums[3];
    energies.friction += sums[4];
    energies.plastic = sums[5];
    energies.stabilisation += sums[6];
    committed_applied = applied;

    if (time == path.time()) // equilibrium on a new mesh, which stores another energy
      return;
    Energies increment = energies;
    increment -= before;
    warn_of_energies(increment, creating);
  }

  /// Of a site: what the tolerances of Newton's method on slips leave at the largest force.
  double ContactProblem::Implementation::negligible_dissipation() const
  {
    double force = 0., motion = length_scale;
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      if (surfaces->is_owned(s))
        force = std::max(force, residual.jump[s].norm());
    for (const Vector3 &moved : state.increment)
      motion = std::max(motion, moved.norm());
    return beyond_tolerance * parameters.newton.contact_tolerance * dealii::Utilities::MPI::max(force, communicator) *
           dealii::Utilities::MPI::max(motion, communicator);
  }

  /// @param creating sites of this rank where friction created energy. Collective.
  void ContactProblem::Implementation::warn_of_energies(const Energies                  &increment,
                                                        const std::vector<unsigned int> &creating)
  {
    const unsigned int n_creating = dealii::Utilities::MPI::sum<unsigned int>(creating.size(), communicator);
    if (n_creating > 0)
      console.remark("warning: friction creates energy at " + std::to_string(n_creating) + " sites, first " +
                     site_loci(creating, 1).front() +
                     ": its force does not oppose the slip there; see energy.csv, and try smaller increments");
    const double imbalance  = std::abs(increment.imbalance());
    const double motion     = std::max(largest_difference(solution.block(0), committed.block(0)), length_scale);
    const double negligible = beyond_tolerance * parameters.newton.force_tolerance * force_scale * motion;
    if (imbalance > large_imbalance * increment.throughput() && imbalance > small_part * energies.throughput() &&
        imbalance > negligible)
    {
      Energies before = energies;
      before -= increment;
      const bool         told = std::abs(before.imbalance()) > small_part * energies.throughput(); // it goes on
      std::ostringstream text;
      text.precision(3);
      text << "warning: " << std::lround(100. * imbalance / increment.throughput())
           << " % of the energy of this increment is not accounted for (" << imbalance << " of "
           << increment.throughput();
      if (increment.stabilisation > 0.)
        text << ", and viscous stabilisation took " << increment.stabilisation;
      text << ')';
      if (!told)
        text
            << ": contact, slip or yielding set in within it, where work with the mean force is not exact; the state "
               "at its end is in equilibrium all the same, and if energies matter, half the increment leaves a half to "
               "a quarter of it ('Load stepping/Increments')";
      console.remark(text.str());
    }
  }
} // namespace Nodus
