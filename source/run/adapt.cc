#include "bulk/history_transfer.h"
#include "bulk/stress_error.h"
#include "contact/contact_error.h"
#include "contact/tractions.h"
#include "mesh/hanging_nodes.h"
#include "run/contact_problem_implementation.h"
#include "run/nodal_state.h"

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/solution_transfer.h>

#include <algorithm>
#include <cmath>
#include <sstream>

// The mesh changes, and the state is taken along.

namespace Nodus
{
  namespace
  {
    /// Of the contact force: the log says nothing of smaller friction.
    constexpr double negligible_friction = 1e-3;
  } // namespace

  /// Of the solution at hand, with its fields.
  RefinementIndicator ContactProblem::Implementation::estimate_error()
  {
    RefinementIndicator indicator(bodies.triangulation());
    relevant_u = solution.block(0);
    const NodalStress stress(dof_handler, *mapping, *solid, relevant_u);
    add_stress_error(parameters.adaptivity.bulk_weight, dof_handler, *solid, materials, relevant_u, stress, indicator);
    if (surfaces->n_pairs() > 0 && geometry)
    {
      const auto present = Nodus::contact_fields(
          parameters.contact_pairs, *surfaces, pairing, weights, *status, *contact, state, residual);
      add_contact_error(
          parameters.adaptivity.contact_weight, pair_stiffness(), *surfaces, *geometry, present, stress, indicator);
      if (parameters.adaptivity.slave_at_least_as_fine)
        mark_coarse_slaves(*surfaces, *geometry, indicator);
    }
    return indicator;
  }

  /// @returns whether the mesh has changed; then everything is made anew for it, and the committed state is taken along
  /// if asked for.
  bool ContactProblem::Implementation::refine(const RefinementIndicator &indicator, const bool keep_state)
  {
    auto &triangulation = *bodies.refinable();
    if (!mark_cells(parameters.adaptivity, parameters.bodies, indicator, dof_handler.n_dofs(), triangulation))
      return false;
    if (!keep_state)
    {
      triangulation.execute_coarsening_and_refinement();
      set_up_mesh();
      return true;
    }

    // hanging nodes have no state of their own, but their cells are interpolated
    std::vector<Vector> state_before   = nodal_state(true);
    const auto          hanging_before = hanging_constraints(dof_handler);
    for (unsigned int n = n_displacement_vectors; n < state_before.size(); ++n)
      hanging_before.distribute(state_before[n]);
    std::vector<Vector>                                          ghosted(state_before.size());
    std::vector<const Vector *>                                  pointers;
    dealii::parallel::distributed::SolutionTransfer<dim, Vector> transfer(dof_handler);
    for (unsigned int n = 0; n < ghosted.size(); ++n)
    {
      ghosted[n].reinit(surfaces->layout().owned[0], relevant, communicator);
      ghosted[n] = state_before[n];
      pointers.push_back(&ghosted[n]);
    }
    transfer.prepare_for_coarsening_and_refinement(pointers);
    HistoryTransfer histories(*solid, materials, parameters.degree, triangulation);
    const double    scale = committed_stiffness_scale;
    triangulation.execute_coarsening_and_refinement();
    set_up_mesh();
    begin_on_mesh();

    std::vector<Vector>   after(ghosted.size(), Vector(surfaces->layout().owned[0], communicator));
    std::vector<Vector *> after_pointers;
    for (Vector &v : after)
      after_pointers.push_back(&v);
    transfer.interpolate(after_pointers);
    const auto hanging_nodes = hanging_constraints(dof_handler);
    for (Vector &v : after)
      hanging_nodes.distribute(v);
    histories.finish(*solid);
    set_nodal_state(after, true, interpolated_sites(after));
    rigid_bodies->roll_back();
    rigid_bodies->move(committed.block(0)); // also where new nodes lie on curved surfaces
    committed_area.clear();                 // the pressures are taken over, not the forces
    reaction                  = 0.;         // nor these: nothing is being released, and what may be is found anew
    committed_stiffness_scale = scale;
    roll_back();
    return true;
  }

  /// Before the first increment.
  void ContactProblem::Implementation::refine_near_contact()
  {
    const std::vector<double> distance(surfaces->n_pairs(), parameters.adaptivity.contact_distance);
    for (unsigned int cycle = 0; cycle < parameters.adaptivity.initial_cycles && surfaces->n_pairs() > 0; ++cycle)
    {
      surfaces->fetch_masters(solution.block(0));
      const std::vector<Point> X = surfaces->positions(std::vector<Vector3>(surfaces->nodes().size()));
      surfaces->place_carried_masters(X);
      const ContactGeometry at_start(parameters.contact_pairs, *surfaces, X);
      RefinementIndicator   indicator(bodies.triangulation());
      mark_near_contact(distance, *surfaces, at_start, indicator);
      if (!refine(indicator, false))
        return;
    }
    if (parameters.adaptivity.initial_cycles > 0)
      console.line(
          "  refined near expected contact: " + std::to_string(bodies.triangulation().n_global_active_cells()) +
          " cells, " + std::to_string(dof_handler.n_dofs()) + " displacement degrees of freedom, " +
          std::to_string(surfaces->layout().n_slave_nodes) + " slave nodes");
  }

  /// Refines and coarsens for the solution at hand. @returns whether the mesh has changed; the state is the committed
  /// one then.
  bool ContactProblem::Implementation::adapt_mesh()
  {
    const auto timer = profile.time(Phase::set_up);
    // also at the end of the interval, where nothing is left of them: the increment may still be cut back
    double releasing = 0.;
    for (const DoFIndex i : surfaces->layout().owned[0])
      if (!boundary_conditions->homogeneous_constraints().is_constrained(i))
        releasing = std::max(releasing, std::abs(reaction(i)));
    if (dealii::Utilities::MPI::max(releasing, communicator) > 0.)
    {
      console.remark("the mesh stays as it is while reactions are released");
      return false;
    }
    const RefinementIndicator indicator = estimate_error();
    const double              error     = indicator.relative_error(bodies.triangulation());
    const auto                cells     = bodies.triangulation().n_global_active_cells();
    const DoFIndex            unknowns  = dof_handler.n_dofs();
    const bool                changed   = refine(indicator, true);
    std::ostringstream        text;
    text.precision(3);
    text << "estimated error " << 100. * error << " % of the stress: ";
    if (changed)
      text << cells << " -> " << bodies.triangulation().n_global_active_cells() << " cells, " << unknowns << " -> "
           << dof_handler.n_dofs() << " unknowns, " << surfaces->layout().n_slave_nodes << " slave nodes";
    else
      text << "the mesh stays as it is";
    console.remark(text.str());
    return changed;
  }

  /// The state on a new mesh goes on from equilibrium at the time that has been reached.
  void ContactProblem::Implementation::restore_equilibrium()
  {
    const auto before = resultants;
    impose(path.time());
    for (const bool hold : {true, false})
      try
      {
        motions_unknown = false;
        status->hold_friction(hold);
        solve_increment();
        break;
      }
      catch (const SolverFailure &failure)
      {
        diagnosis.end_attempt(failure.what());
        roll_back();
        console.remark(std::string("no equilibrium on the new mesh: ") + failure.what() +
                       (!hold ? "; the next increment goes on from the state as it was taken over"
                              : "; again with slip that may turn"));
        if (!hold)
          return;
      }
    committed_applied = applied_forces();
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      committed_site_force[s] = -residual.jump[s];
    commit();
    status->hold_friction(false);
    update_results();
    const auto change = [](const Vector3 &force, const Vector3 &force_before)
    { return force_before.norm() > 0. ? 100. * (force - force_before).norm() / force_before.norm() : 0.; };
    for (unsigned int p = 0; p < resultants.size(); ++p)
    {
      std::ostringstream text;
      text.precision(3);
      text << "new mesh: the contact force of " << resultants[p].name << " changes by "
           << change(resultants[p].slave_force, before[p].slave_force) << " %";
      if (before[p].friction.norm() > negligible_friction * before[p].slave_force.norm())
        text << ", friction by " << change(resultants[p].friction, before[p].friction) << " %";
      console.remark(text.str());
    }
  }
} // namespace Nodus
