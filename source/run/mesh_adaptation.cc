#include "run/mesh_adaptation.h"
#include "base/deal_ii_versions.h"
#include "bulk/history_transfer.h"
#include "bulk/stress_error.h"
#include "contact/contact_error.h"
#include "contact/pair_scales.h"
#include "mesh/hanging_nodes.h"
#include "run/own_indicator.h"
#include "run/state_vectors.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  MeshAdaptation::MeshAdaptation(
      Model &model, Journal &journal, States &states, Equilibrium &equilibrium, Results &results)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , equilibrium_(equilibrium)
      , results_(results)
  {
  }

  /// Of the solution at hand, with its fields.
  RefinementIndicator MeshAdaptation::estimate_error() const
  {
    const AdaptivityParameters &adaptivity = model_.parameters.adaptivity;
    const ContactInterface     &contact    = *model_.contact;
    RefinementIndicator         indicator(model_.bodies.triangulation());
    const Vector                u       = model_.with_ghosts(states_.now.unknowns.block(0));
    const bool                  touches = contact.surfaces().n_pairs() > 0 && contact.geometry() != nullptr;
    if (is_own())
    {
      const unsigned int  n_cells = model_.bodies.triangulation().n_active_cells();
      std::vector<double> pressure(n_cells, 0.);
      if (touches)
        pressure = largest_contact_pressure(contact.surfaces(), *contact.geometry(), contact.fields(), n_cells);
      set_own_error(adaptivity.own_indicator, model_, u, pressure, indicator);
    }
    else
    {
      const NodalStress stress(model_.dof_handler, *model_.solid, u);
      add_stress_error(
          adaptivity.bulk_weight, model_.dof_handler, *model_.solid, model_.materials, u, stress, indicator);
      if (touches)
        add_contact_error(adaptivity.contact_weight,
                          softer_sides(model_.parameters.contact_pairs, model_.stiffness()),
                          contact.surfaces(),
                          *contact.geometry(),
                          contact.fields(),
                          stress,
                          indicator);
    }
    if (touches && adaptivity.slave_at_least_as_fine)
      mark_coarse_slaves(contact.surfaces(), *contact.geometry(), indicator);
    return indicator;
  }

  bool MeshAdaptation::is_own() const
  {
    return model_.parameters.adaptivity.indicator == AdaptivityParameters::Indicator::own;
  }

  /// @returns whether a cell is to be refined or coarsened.
  bool MeshAdaptation::mark(const RefinementIndicator &indicator)
  {
    return mark_cells(model_.parameters.adaptivity,
                      model_.parameters.bodies,
                      indicator,
                      model_.dof_handler.n_dofs(),
                      *model_.bodies.refinable());
  }

  /// Executes what is marked: everything is made anew for the mesh, and the state is interpolated.
  void MeshAdaptation::take_state_along()
  {
    auto &triangulation = *model_.bodies.refinable();
    // Nodal forces belong to the mesh: they are no field.
    states_.committed.reaction = 0.; // nothing is being released, and what may be is found anew
    states_.committed.applied  = 0.;
    // hanging nodes have no state of their own, but their cells are interpolated
    std::vector<Vector> state_before   = interpolable_vectors(states_.committed, *model_.contact);
    const auto          hanging_before = hanging_constraints(model_.dof_handler);
    for (unsigned int n = n_displacement_vectors(); n < state_before.size(); ++n)
      hanging_before.distribute(state_before[n]);
    std::vector<Vector>         ghosted;
    std::vector<const Vector *> pointers;
    // The mean of what its cells find at a node: where terms cancel, they differ by more than deal.II's debug mode
    // bears.
    SolutionTransfer transfer(model_.dof_handler, /* average_values = */ true);
    ghosted.reserve(state_before.size()); // a copy would not have the ghosts
    for (const Vector &v : state_before)
      ghosted.push_back(model_.with_ghosts(v));
    for (const Vector &v : ghosted)
      pointers.push_back(&v);
    transfer.prepare_for_coarsening_and_refinement(pointers);
    HistoryTransfer histories(*model_.solid, model_.materials, model_.parameters.degree, triangulation);
    triangulation.execute_coarsening_and_refinement();

    copy_common(states_.committed, states_.now);
    model_.set_up_mesh(states_.now);
    equilibrium_.begin_on_mesh();
    results_.begin_on_mesh();

    // cells set their nodes, those of other ranks too
    const dealii::IndexSet &owned = model_.contact->surfaces().layout().owned[0];
    std::vector<Vector>     interpolated(ghosted.size(), Vector(owned, model_.relevant, model_.communicator));
    std::vector<Vector *>   targets;
    for (Vector &v : interpolated)
      targets.push_back(&v);
    transfer.interpolate(targets);
    const auto          hanging_nodes = hanging_constraints(model_.dof_handler);
    std::vector<Vector> after(interpolated.size(), Vector(owned, model_.communicator));
    for (unsigned int n = 0; n < after.size(); ++n)
    {
      after[n] = interpolated[n];
      hanging_nodes.distribute(after[n]);
    }
    histories.finish(*model_.solid);
    states_.now.history = model_.solid->start();
    take_interpolated(after, *model_.contact, states_.now);
    model_.rigid_bodies.move(states_.now.unknowns.block(0)); // also where new nodes lie on curved surfaces
    states_.committed = states_.now;
    model_.roll_back(states_);
  }

  void MeshAdaptation::refine_near_contact()
  {
    const AdaptivityParameters &adaptivity = model_.parameters.adaptivity;
    const std::vector<double>   distance(model_.contact->surfaces().n_pairs(), adaptivity.contact_distance);
    for (unsigned int cycle = 0; cycle < adaptivity.initial_cycles && !distance.empty(); ++cycle)
    {
      ContactSurfaces &surfaces = model_.contact->surfaces();
      surfaces.fetch_masters(states_.now.unknowns.block(0), model_.rigid_bodies.shortenings());
      const std::vector<Point> X = surfaces.reference_positions();
      surfaces.place_carried_masters(X);
      RefinementIndicator indicator(model_.bodies.triangulation());
      {
        const ContactGeometry at_start(model_.parameters.contact_pairs, surfaces, X);
        mark_near_contact(distance, surfaces, at_start, indicator);
      }
      if (!mark(indicator))
        return;
      model_.bodies.refinable()->execute_coarsening_and_refinement();
      model_.set_up_mesh(states_.now);
      states_.committed = states_.now;
    }
    if (adaptivity.initial_cycles > 0)
      journal_.console.line(
          "  refined near expected contact: " + std::to_string(model_.bodies.triangulation().n_global_active_cells()) +
          " cells, " + std::to_string(model_.dof_handler.n_dofs()) + " displacement degrees of freedom, " +
          std::to_string(model_.contact->surfaces().layout().n_slave_nodes) + " slave nodes");
  }

  bool MeshAdaptation::adapt()
  {
    const auto timer = journal_.profile.time(Phase::set_up);
    // also at the end of the interval, where nothing is left of them: the increment may still be cut back
    double releasing = 0.;
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      if (!model_.boundary_conditions->homogeneous_constraints().is_constrained(i))
        releasing = std::max(releasing, std::abs(states_.committed.reaction(i)));
    if (dealii::Utilities::MPI::max(releasing, model_.communicator) > 0.)
    {
      journal_.console.remark("the mesh stays as it is while reactions are released");
      return false;
    }
    const auto               &triangulation = model_.bodies.triangulation();
    const RefinementIndicator indicator     = estimate_error();
    const double              error         = indicator.relative_error(triangulation);
    const auto                cells         = triangulation.n_global_active_cells();
    const DoFIndex            unknowns      = model_.dof_handler.n_dofs();
    const bool                changes       = mark(indicator);
    if (changes)
      take_state_along();
    std::ostringstream text;
    text.precision(3);
    if (is_own())
      text << "indicator '" << model_.parameters.adaptivity.own_indicator.name << "', root of the sum of its squares "
           << error << ": ";
    else
      text << "estimated error " << 100. * error << " % of the stress: ";
    if (changes)
      text << cells << " -> " << triangulation.n_global_active_cells() << " cells, " << unknowns << " -> "
           << model_.dof_handler.n_dofs() << " unknowns, " << model_.contact->surfaces().layout().n_slave_nodes
           << " slave nodes";
    else
      text << "the mesh stays as it is";
    journal_.console.remark(text.str());
    return changes;
  }
} // namespace Nodus
