#include "run/unheld_bodies.h"
#include "base/deal_ii_versions.h"
#include "contact/loci.h"
#include "mesh/sides.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Stiffness of the springs that are proposed, relative to the modulus of the body over its size.
    constexpr double soft = 1e-3;
  } // namespace

  std::vector<FreeMotions::Motion>
  free_motions(const Model &model, const State &state, const double time, const bool as_closed)
  {
    const OwnedNodes nodes(model.dof_handler, *model.mapping);
    FreeMotions      motions(
        model.bodies, model.dof_handler, *model.mapping, model.rigid_bodies, nodes, state.unknowns.block(0));
    motions.hold_prescribed(model.boundary_conditions->homogeneous_constraints());
    motions.hold_springs(model.boundary_conditions->loads(), time);
    model.contact->hold(motions, as_closed);
    return motions.free();
  }

  std::string ways_to_hold(const Model &model, const State &state, const Increment &increment, const std::string &first)
  {
    const ContactSurfaces &surfaces = model.contact->surfaces();
    const Status          &status   = model.contact->status();
    const std::size_t      now      = free_motions(model, state, increment.end).size();
    const std::size_t      left     = free_motions(model, state, increment.end, true).size();
    const bool             start    = increment.number == 1; // 'Initial status' is that of the start
    std::ostringstream     text;
    text << first;
    if (start && left == 0 && now > 0)
      text << ", close the contact first ('Initial status = closed')";
    text << ", or set 'Load stepping/Viscous stabilisation = 1e-2'";
    if (model.parameters.load_stepping.interval_ends.size() > 1)
      text << " (in this interval alone)";
    if (start && 0 < left && left < now)
      text << "; 'Initial status = closed' alone would still leave " << left << " of " << now << " motions free";

    bool rubs = false, is_closed = false;
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      if (surfaces.is_owned(s) && surfaces.has_status(s) && status.contact(s))
      {
        const auto &pair = model.parameters.contact_pairs[surfaces.pair(s)];
        is_closed        = true;
        rubs             = rubs || pair.friction_coefficient > 0. || pair.shear_limit > 0. ||
               pair.friction_law == ContactPairParameters::FrictionLaw::own;
      }
    is_closed = dealii::Utilities::MPI::logical_or(is_closed, model.communicator);
    rubs      = dealii::Utilities::MPI::logical_or(rubs, model.communicator);
    if (is_closed)
      text << "; contact is closed, but "
           << (!rubs   ? "has no friction"
               : start ? "friction holds nothing before there is pressure"
                       : "friction is at its limit, or does not act in this direction");
    return text.str();
  }

  std::string
  null_pivot_locus(const Model &model, const State &state, const Increment &increment, const DoFIndex flat_index)
  {
    const ContactSurfaces &surfaces = model.contact->surfaces();
    const BlockLayout     &layout   = surfaces.layout();
    if (flat_index >= layout.lambda(0))
    {
      const bool     pressure   = flat_index < layout.Lambda(0, 0);
      const DoFIndex multiplier = pressure ? flat_index - layout.lambda(0) : (flat_index - layout.Lambda(0, 0)) / 2;
      unsigned int   here       = dealii::numbers::invalid_unsigned_int;
      for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
        if (surfaces.multiplier(k) == multiplier)
          here = k;
      return (pressure ? "the contact multiplier of " : "the friction multiplier of ") + model.contact->locus(here) +
             ": this constraint repeats another one (over-constraint)";
    }
    const auto  points = support_points(*model.mapping, model.dof_handler);
    const auto  owner  = points.find(flat_index);
    std::string here =
        owner == points.end() || !layout.owned[0].is_element(flat_index) ? "" : coordinates(owner->second);
    for (const auto &part : all_gather(model.communicator, here))
      if (!part.empty())
        here = part;
    return "the displacement of node " + here + ": its body is free to move; " +
           ways_to_hold(model, state, increment, "hold it with a boundary condition (a soft spring will do)");
  }

  std::vector<FailureEvidence::Spring> proposed_springs(const Model &model, const State &state, const double time)
  {
    std::vector<FailureEvidence::Spring> springs;
    std::vector<std::array<bool, dim>>   moves(model.bodies.size(), {{false, false, false}});
    for (const auto &motion : free_motions(model, state, time))
      for (unsigned int b = 0; b < model.bodies.size(); ++b)
        for (unsigned int c = 0; c < dim; ++c)
          moves[b][c] = moves[b][c] || motion.moves[b][c];
    for (unsigned int b = 0; b < model.bodies.size(); ++b)
    {
      if (model.parameters.bodies[b].rigid || moves[b] == std::array<bool, dim>{{false, false, false}})
        continue;
      const auto ids     = model.bodies.boundary_ids(b);
      const auto touches = [&](const unsigned int id)
      {
        const auto &pairs = model.parameters.contact_pairs;
        return std::any_of(pairs.begin(),
                           pairs.end(),
                           [&](const ContactPairParameters &pair)
                           { return pair.slave.takes(b + 1, id) || pair.master.takes(b + 1, id); });
      };
      const auto id   = std::find_if_not(ids.begin(), ids.end(), touches);
      const auto ends = model.bodies.bounding_box(b).get_boundary_points();
      springs.push_back({b,
                         static_cast<unsigned int>(id == ids.end() ? *ids.begin() : *id),
                         moves[b],
                         soft * model.materials[b]->youngs_modulus() / ends.first.distance(ends.second)});
    }
    return springs;
  }

  void check_stabilised_motion(const Model &model, const States &states)
  {
    const ContactSurfaces &surfaces = model.contact->surfaces();
    if (!model.stabilisation->acts() || surfaces.n_pairs() == 0)
      return;
    double limit = std::numeric_limits<double>::max();
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
      limit = std::min(limit, 0.5 * surfaces.face_size(p));
    std::string  worst;
    const double moved = largest_difference(
        model.contact->surfaces(), states.now.unknowns.block(0), states.committed.unknowns.block(0), &worst);
    if (moved <= limit)
      return;
    std::ostringstream message;
    message << "the node " << worst << " moves by " << moved
            << " against viscous stabilisation, more than half of a slave face (" << limit
            << "); raise 'Load stepping/Viscous stabilisation'";
    throw SolverFailure(message.str(), SolverFailure::Kind::free_body);
  }
} // namespace Nodus
