#include "run/contact_problem_implementation.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>
#include <sstream>

// Bodies that can move freely: which motions, what may hold them, and what comes of them under stabilisation.

namespace Nodus
{
  namespace
  {
    /// Stiffness of the springs that are proposed, relative to the modulus of the body over its size.
    constexpr double soft = 1e-3;
  } // namespace

  /// Rigid motions that nothing holds now, or would if all sites with a master point were closed. Collective.
  std::vector<UnconstrainedModes::Motion> ContactProblem::Implementation::free_motions(const OwnedNodes &nodes,
                                                                                       const bool as_closed) const
  {
    UnconstrainedModes motions(bodies, dof_handler, *mapping, *rigid_bodies, nodes, solution.block(0));
    motions.hold_prescribed(boundary_conditions->homogeneous_constraints());
    motions.hold_springs(parameters.boundary_conditions, time);
    motions.hold_contact(*surfaces, pairing, jump, *status, state, residual, as_closed);
    return motions.free();
  }

  /// Sites on all ranks. Collective.
  unsigned int ContactProblem::Implementation::n_closed() const
  {
    unsigned int n = 0;
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      n += surfaces->is_owned(s) && surfaces->has_status(s) && status->contact(s);
    return dealii::Utilities::MPI::sum(n, communicator);
  }

  /// No attempt at the increment came beyond its first system, which leaves bodies free, and that is the one of the
  /// last converged state: all smaller increments begin with it, too. Collective.
  bool ContactProblem::Implementation::begins_singular() const
  {
    if (!singular || counts.newton > 0)
      return false;
    unsigned int changed = 0;
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      changed += surfaces->is_owned(s) && surfaces->has_status(s) &&
                 (status->kept(s).front() != 0.) != static_cast<bool>(status->contact(s));
    return dealii::Utilities::MPI::sum(changed, communicator) == 0;
  }

  /// What the user can do about a body that is free now, @p first of all, for a message that ends in this. Collective.
  std::string ContactProblem::Implementation::ways_to_hold(const std::string &first) const
  {
    const OwnedNodes   nodes(dof_handler, *mapping);
    const std::size_t  now   = free_motions(nodes).size();
    const std::size_t  left  = free_motions(nodes, true).size();
    const bool         start = path.increment() == 1; // 'Initial status' is that of the start
    std::ostringstream text;
    text << first;
    if (start && left == 0 && now > 0)
      text << ", close the contact first ('Initial status = closed')";
    text << ", or set 'Load stepping/Viscous stabilisation = 1e-2'";
    if (start && 0 < left && left < now)
      text << "; 'Initial status = closed' alone would still leave " << left << " of " << now << " motions free";

    bool rubs = false, is_closed = false;
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      if (surfaces->is_owned(s) && surfaces->has_status(s) && status->contact(s))
      {
        const auto &pair = parameters.contact_pairs[surfaces->pair(s)];
        is_closed        = true;
        rubs             = rubs || pair.friction_coefficient > 0. || pair.shear_limit > 0.;
      }
    is_closed = dealii::Utilities::MPI::logical_or(is_closed, communicator);
    rubs      = dealii::Utilities::MPI::logical_or(rubs, communicator);
    if (is_closed)
      text << "; contact is closed, but "
           << (!rubs   ? "has no friction"
               : start ? "friction holds nothing before there is pressure"
                       : "friction is at its limit, or does not act in this direction");
    return text.str();
  }

  /// One for each body with free motions, on the first of its sides that is not in contact. Collective.
  void ContactProblem::Implementation::propose_springs(FailureEvidence &evidence) const
  {
    std::vector<std::array<bool, dim>> moves(bodies.size(), {{false, false, false}});
    for (const auto &motion : free_motions(OwnedNodes(dof_handler, *mapping)))
      for (unsigned int b = 0; b < bodies.size(); ++b)
        for (unsigned int c = 0; c < dim; ++c)
          moves[b][c] = moves[b][c] || motion.moves[b][c];
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      if (parameters.bodies[b].rigid || moves[b] == std::array<bool, dim>{{false, false, false}})
        continue;
      const auto ids     = bodies.boundary_ids(b);
      const auto touches = [&](const unsigned int id)
      {
        const auto &pairs = parameters.contact_pairs;
        return std::any_of(pairs.begin(),
                           pairs.end(),
                           [&](const ContactPairParameters &pair)
                           {
                             const auto has = [&](const RegionParameters &side)
                             {
                               return side.body == b + 1 &&
                                      std::find(side.boundary_ids.begin(), side.boundary_ids.end(), id) !=
                                          side.boundary_ids.end();
                             };
                             return has(pair.slave) || has(pair.master);
                           });
      };
      const auto id   = std::find_if_not(ids.begin(), ids.end(), touches);
      const auto ends = bodies.bounding_box(b).get_boundary_points();
      evidence.springs.push_back({b,
                                  static_cast<unsigned int>(id == ids.end() ? *ids.begin() : *id),
                                  moves[b],
                                  soft * materials[b]->youngs_modulus() / ends.first.distance(ends.second)});
    }
  }

  /// A body that nothing but stabilisation holds may cross a surface in one increment, which satisfies the equations.
  void ContactProblem::Implementation::check_stabilised_motion()
  {
    if (!stabilisation->acts() || surfaces->n_pairs() == 0)
      return;
    double limit = std::numeric_limits<double>::max();
    for (unsigned int p = 0; p < surfaces->n_pairs(); ++p)
      limit = std::min(limit, 0.5 * surfaces->face_size(p));
    std::string  worst;
    const double moved = largest_difference(solution.block(0), committed.block(0), &worst);
    if (moved <= limit)
      return;
    std::ostringstream message;
    message << "the node " << worst << " moves by " << moved
            << " against viscous stabilisation, more than half of a slave face (" << limit
            << "); raise 'Load stepping/Viscous stabilisation'";
    throw SolverFailure(message.str(), SolverFailure::Kind::free_body);
  }

  /// Names the rigid motions that nothing holds as the increment begins: contact has to, or the system is singular.
  void ContactProblem::Implementation::warn_of_free_motions()
  {
    std::string text;
    for (const auto &motion : free_motions(OwnedNodes(dof_handler, *mapping)))
      text += (text.empty() ? "" : "; ") + motion.text;
    const bool has_closed = n_closed() > 0;
    if (!text.empty())
      console.remark("nothing holds these motions as the increment begins: " + text +
                     (stabilisation->acts() ? "; viscous stabilisation does"
                      : has_closed          ? "; the closed contact does not, and no more may close in time"
                                            : "; contact has to close at once"));
  }
} // namespace Nodus
