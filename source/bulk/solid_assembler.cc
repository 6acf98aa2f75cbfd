#include "base/deal_ii_versions.h"
#include "bulk/solid_assembler_scratch.h"
#include "parallel/throw_everywhere.h"
#include "parallel/wait_for_all.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <algorithm>
#include <map>

namespace Nodus
{
  using namespace dealii;
  using VolumetricTreatment = BodyParameters::VolumetricTreatment;

  SolidAssembler::Scratch::Scratch(const DoFHandler<dim>                        &dof_handler,
                                   const Mapping<dim>                           &mapping,
                                   const std::vector<std::unique_ptr<Material>> &materials,
                                   std::vector<BoundaryConditions::Load>        &body_loads,
                                   const std::vector<VolumetricTreatment>       &treatments)
      : dof_handler(dof_handler)
      , materials(materials)
      , loads(dof_handler, mapping, materials, body_loads)
      , n_nodes(dof_handler.get_fe().n_dofs_per_cell() / dim)
      , constrained(dof_handler)
      , stiffness(n_nodes)
  {
    const auto                                                   &fe = dof_handler.get_fe();
    std::map<VolumetricTreatment, std::shared_ptr<ElementKernel>> kernel_of;
    for (unsigned int body = 0; body < materials.size(); ++body)
    {
      const auto treatment = treatments.empty() ? VolumetricTreatment::standard : treatments[body];
      auto      &kernel    = kernel_of[treatment];
      if (!kernel)
        kernel = ElementKernel::make(fe, treatment);
      kernels.push_back(kernel);
    }
    n_q = QGauss<dim>(fe.degree + 1).size();
    at_cell.u.resize(fe.n_dofs_per_cell());
    for (auto *v : {&at_lanes.X, &at_lanes.u, &at_lanes.u_before, &at_lanes.force})
      v->resize(fe.n_dofs_per_cell());
    for (auto *v : {&at_cell.internal, &at_cell.external})
      v->reinit(fe.n_dofs_per_cell());
    at_cell.tangent.reinit(fe.n_dofs_per_cell(), fe.n_dofs_per_cell());

    const IndexSet       &owned = dof_handler.locally_owned_dofs();
    std::vector<DoFIndex> cell_dofs(fe.n_dofs_per_cell()), global_nodes, ghosts, free_nodes;
    const std::size_t     n_cells = dof_handler.get_triangulation().n_active_cells();
    // the largest arrays: growing them would take twice their memory
    number_of.resize(n_cells, numbers::invalid_unsigned_int);
    global_nodes.reserve(n_nodes * n_cells);
    for (const auto &cell : dof_handler.active_cell_iterators())
    {
      if (cell->is_artificial())
        continue;
      cell->get_dof_indices(cell_dofs);
      if (!cell->is_locally_owned() &&
          (constrained.contains(cell) ||
           std::none_of(cell_dofs.begin(), cell_dofs.end(), [&](const DoFIndex i) { return owned.is_element(i); })))
        continue;
      for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const DoFIndex first = cell_dofs[dim * a];
        Assert(first % dim == 0 && cell_dofs[dim * a + 1] == first + 1 && cell_dofs[dim * a + 2] == first + 2 &&
                   fe.component_to_system_index(0, a) == dim * a,
               ExcInternalError());
        global_nodes.push_back(first / dim);
        if (!owned.is_element(first))
          ghosts.push_back(first / dim);
      }
      if (constrained.contains(cell))
        constrained.add(cells.size(), {global_nodes.end() - n_nodes, global_nodes.end()}, free_nodes);
      if (batches.empty() || batches.back().size == n_lanes || cells.back().body != cell->material_id())
      {
        batches.push_back({static_cast<unsigned int>(cells.size()), 0, reached.size()});
        add_initial_states(*materials[cell->material_id()]);
      }
      ++batches.back().size;
      if (cell->is_locally_owned())
        stiffness_of_cells += materials[cell->material_id()]->youngs_modulus() * cell->measure();
      cells.push_back({cell->center(), static_cast<unsigned char>(cell->material_id()), cell->is_locally_owned()});
      number_of[cell->active_cell_index()] = cells.size() - 1;
      loads.add_cell(cell);
    }
    for (const DoFIndex node : free_nodes)
      if (!owned.is_element(dim * node))
        ghosts.push_back(node);
    const auto own_nodes = std::make_shared<NodeMap>(owned, std::move(ghosts), communicator_of(dof_handler));
    for (unsigned int i = 0; i < own_nodes->size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        dofs.push_back(dim * own_nodes->global(i) + c);
    nodes = constrained.publish(own_nodes);
    cell_nodes.reserve(global_nodes.size());
    for (const DoFIndex node : global_nodes)
      cell_nodes.push_back(nodes->local(node));
    for (auto *v :
         {&at_nodes.X, &at_nodes.u, &at_nodes.internal, &at_nodes.external, &at_nodes.rhs, &at_nodes.prescribed})
      v->resize(dofs.size());
    at_nodes.is_prescribed.resize(dofs.size());
    start = std::make_shared<PointStates>(PointStates{reached});
    find_positions(mapping);
  }

  /// Where the mapping puts the nodes: with it the element of the displacement maps the cell in the same way.
  void SolidAssembler::Scratch::find_positions(const Mapping<dim> &mapping)
  {
    const auto   &fe = dof_handler.get_fe();
    FEValues<dim> support(mapping, fe, fe.base_element(0).get_unit_support_points(), update_quadrature_points);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (const unsigned int c = number_of[cell->active_cell_index()]; c != numbers::invalid_unsigned_int)
      {
        support.reinit(cell);
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int i = 0; i < dim; ++i)
            at_nodes.X[dim * cell_nodes[c * n_nodes + a] + i] = support.quadrature_point(a)[i];
      }
  }

  void SolidAssembler::Scratch::add_initial_states(const Material &material)
  {
    std::vector<double> initial(material.n_state());
    material.set_initial(initial.data());
    for (unsigned int q = 0; q < n_q; ++q)
      for (const double value : initial)
        reached.push_back(Lanes{} + value);
  }

  void SolidAssembler::Scratch::note_prescribed(const AffineConstraints<double> *constraints)
  {
    for (unsigned int i = 0; i < dofs.size(); ++i)
    {
      at_nodes.is_prescribed[i] = constraints && constraints->is_constrained(dofs[i]);
      at_nodes.prescribed[i]    = at_nodes.is_prescribed[i] ? constraints->get_inhomogeneity(dofs[i]) : 0.;
    }
  }

  /// Contact loops come back with other statuses and the same displacement: then everything is there already. Otherwise
  /// takes note of the values for the next call.
  bool SolidAssembler::Scratch::is_last(const Vector                    &u,
                                        const double                     t,
                                        const AffineConstraints<double> *constraints,
                                        BlockCsrMatrix                  *tangent)
  {
    std::vector<double> values(dofs.size()), conditions(1, t);
    u.extract_subvector_to(dofs.begin(), dofs.end(), values.begin());
    if (constraints)
      for (const auto &line : constraints->get_lines())
        conditions.push_back(line.inhomogeneity);
    const bool same = tangent && tangent == last.tangent && values == at_nodes.u && conditions == last.conditions;
    if (Utilities::MPI::min(same ? 1 : 0, communicator_of(dof_handler)) == 1)
      return true;
    at_nodes.u.swap(values);
    last.conditions.swap(conditions);
    last.tangent = tangent;
    return false;
  }

  void SolidAssembler::Scratch::copy_sums(Vector &internal, Vector &external, Vector *const rhs) const
  {
    const auto copy = [&](const std::vector<double> &values, Vector &v)
    {
      if (v.size() != dof_handler.n_dofs() || v.locally_owned_elements() != dof_handler.locally_owned_dofs())
        v.reinit(dof_handler.locally_owned_dofs(), communicator_of(dof_handler));
      std::copy_n(values.begin(), dim * nodes->n_owned(), v.begin());
    };
    copy(at_nodes.internal, internal);
    copy(at_nodes.external, external);
    if (rhs)
      copy(at_nodes.rhs, *rhs);
  }

  void SolidAssembler::Scratch::sweep(const Vector                    &u,
                                      const double                     t,
                                      Vector                          &internal,
                                      Vector                          &external,
                                      const AffineConstraints<double> *constraints,
                                      BlockCsrMatrix                  *tangent,
                                      Vector                          *rhs,
                                      InnerEnergy                     *energy)
  {
    if (is_last(u, t, constraints, tangent))
      return copy_sums(internal, external, rhs);
    loads.evaluate(t);
    if (tangent)
      tangent->set_zero();
    for (auto *v : {&at_nodes.internal, &at_nodes.external, &at_nodes.rhs})
      std::fill(v->begin(), v->end(), 0.);
    note_prescribed(constraints);

    std::string failure;
    for (unsigned int n = 0; n < batches.size() && failure.empty(); ++n)
    {
      const Batch &batch = batches[n];
      gather(batch, at_nodes.u, at_lanes.u);
      if (tangent)
        stiffness.prefetch(batch.first, batch.size, *tangent);
      Lanes det_F;
      if (material(batch).is_rigid())
        compute_rigid(batch, det_F);
      else
        compute(batch, tangent, det_F, energy);
      failure = turned_inside_out(batch, det_F);
      if (failure.empty())
        scatter(batch, tangent);
    }
    wait_for_all(communicator_of(dof_handler)); // the ranks at the contact have fewer cells
    constrained.exchange(!failure.empty(), tangent, {at_nodes.internal, at_nodes.external, at_nodes.rhs});
    for (unsigned int i = 0; i < dofs.size(); ++i)
      at_nodes.rhs[i] = at_nodes.is_prescribed[i] ? 0. : at_nodes.rhs[i] + at_nodes.external[i] - at_nodes.internal[i];

    copy_sums(internal, external, rhs);
    if (!failure.empty())
    {
      forget_last();
      forget_iterates();
    }
    else if (tangent)
    {
      ++iterates;
      if (std::any_of(kernels.begin(), kernels.end(), [](const auto &kernel) { return kernel->has_own_unknowns(); }))
        at_nodes.u_before = at_nodes.u;
    }
    throw_everywhere<SolverFailure>(failure, communicator_of(dof_handler), SolverFailure::Kind::inverted_cell);
  }

  SolidAssembler::SolidAssembler(const DoFHandler<dim>                        &dof_handler,
                                 const Mapping<dim>                           &mapping,
                                 const std::vector<std::unique_ptr<Material>> &materials,
                                 std::vector<BoundaryConditions::Load>        &loads,
                                 const std::vector<VolumetricTreatment>       &treatments)
      : scratch_(std::make_unique<Scratch>(dof_handler, mapping, materials, loads, treatments))
  {
  }

  SolidAssembler::~SolidAssembler() = default;

  void SolidAssembler::set_time(const double t)
  {
    scratch_->loads.evaluate(t);
  }

  void SolidAssembler::forces(
      const Vector &u, const double t, Vector &internal, Vector &external, InnerEnergy *const energy) const
  {
    if (energy)
      *energy = {0., 0., scratch_->stiffness_of_cells};
    scratch_->sweep(u, t, internal, external, nullptr, nullptr, nullptr, energy);
  }

  void SolidAssembler::add_variation(const Vector                    &u,
                                     const AffineConstraints<double> &constraints,
                                     LinearSystem                    &system) const
  {
    scratch_->loads.add_variation(u, constraints, system);
  }

  void SolidAssembler::tangent(const Vector                    &u,
                               const double                     t,
                               const AffineConstraints<double> &constraints,
                               BlockCsrMatrix                  &tangent,
                               Vector                          &rhs,
                               Vector                          &internal,
                               Vector                          &external) const
  {
    scratch_->sweep(u, t, internal, external, &constraints, &tangent, &rhs, nullptr);
  }

  void SolidAssembler::forget_tangent()
  {
    scratch_->forget_last();
  }

  void SolidAssembler::make_sparsity(BlockCsrMatrix &tangent) const
  {
    Scratch &s = *scratch_;
    s.stiffness.make_pattern(s.nodes, s.cell_nodes, s.constrained, tangent);
  }
} // namespace Nodus
