#include "base/deal_ii_versions.h"
#include "bulk/solid_assembler_scratch.h"
#include "parallel/throw_everywhere.h"
#include "parallel/wait_for_all.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

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

  void SolidAssembler::Scratch::gather(const Batch               &batch,
                                       const std::vector<double> &nodal,
                                       std::vector<Lanes>        &values) const
  {
    for (unsigned int v = 0; v < n_lanes; ++v)
    {
      const unsigned int *const node = cell_nodes.data() + batch.cell(v) * n_nodes;
      for (unsigned int i = 0; i < dim * n_nodes; ++i)
        values[i][v] = nodal[dim * node[i / dim] + i % dim];
    }
  }

  void SolidAssembler::Scratch::note_prescribed(const AffineConstraints<double> *constraints)
  {
    for (unsigned int i = 0; i < dofs.size(); ++i)
    {
      at_nodes.is_prescribed[i] = constraints && constraints->is_constrained(dofs[i]);
      at_nodes.prescribed[i]    = at_nodes.is_prescribed[i] ? constraints->get_inhomogeneity(dofs[i]) : 0.;
    }
  }

  void SolidAssembler::Scratch::add_loads(const unsigned int cell, const unsigned int lane, const bool with_tangent)
  {
    const unsigned int *const node = cell_nodes.data() + cell * n_nodes;
    for (unsigned int i = 0; i < dim * n_nodes; ++i)
      at_cell.u[i] = at_lanes.u[i][lane];
    at_cell.internal = 0.;
    at_cell.external = 0.;
    at_cell.tangent  = 0.;
    loads.add(cell, {at_cell.u, at_cell.internal, at_cell.external, with_tangent ? &at_cell.tangent : nullptr});
    for (unsigned int i = 0; i < dim * n_nodes; ++i)
    {
      at_lanes.force[i][lane] += at_cell.internal(i);
      if (!is_constrained(cell))
        at_nodes.external[dim * node[i / dim] + i % dim] += at_cell.external(i);
    }
    if (with_tangent)
      stiffness.add(lane, at_cell.tangent);
  }

  void
  SolidAssembler::Scratch::add_constrained(const unsigned int cell, const unsigned int lane, BlockCsrMatrix *tangent)
  {
    for (unsigned int part = 0; part < 2; ++part)
      at_cell.forces[part].assign(dim * n_nodes, 0.);
    for (unsigned int i = 0; i < dim * n_nodes; ++i)
      at_cell.forces[0][i] = at_lanes.force[i][lane];
    if (loads.act_on(cell))
      std::copy(at_cell.external.begin(), at_cell.external.end(), at_cell.forces[1].begin());
    if (tangent)
      stiffness.copy_cell(lane, at_cell.stiffness);
    constrained.add(constrained.index(cell),
                    at_cell.forces[0],
                    at_cell.forces[1],
                    at_nodes.is_prescribed,
                    at_nodes.prescribed,
                    at_cell.stiffness,
                    tangent,
                    {at_nodes.internal, at_nodes.external, at_nodes.rhs});
  }

  /// No force; on the rows of the nodes, which are prescribed, a diagonal of the size of the others.
  void SolidAssembler::Scratch::compute_rigid(const Batch &batch, Lanes &det_F)
  {
    det_F = Lanes{} + 1.;
    std::fill(at_lanes.force.begin(), at_lanes.force.end(), Lanes{});
    stiffness.set_zero();
    const ElementKernel::QuadraturePoint *const points = this->points(batch);
    for (unsigned int v = 0; v < batch.size; ++v)
    {
      double volume = 0.;
      for (unsigned int q = 0; q < n_q; ++q)
        volume += points[q].JxW[v];
      const double diagonal = material(batch).youngs_modulus() * std::cbrt(volume) / n_nodes;
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          stiffness.entry(a, i, a, i, v) = diagonal;
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

  void SolidAssembler::Scratch::compute(const Batch &batch, const bool with_stiffness, Lanes &det_F)
  {
    const bool goes_on = with_stiffness && iterates > 0 && kernel(batch).has_own_unknowns();
    if (goes_on)
      gather(batch, at_nodes.u_before, at_lanes.u_before);
    kernel(batch).integrate(points(batch),
                            material(batch),
                            at_lanes.u.data(),
                            goes_on ? at_lanes.u_before.data() : nullptr,
                            {start->values.data() + batch.state, reached.data() + batch.state},
                            at_lanes.force.data(),
                            with_stiffness ? stiffness.data() : nullptr,
                            det_F);
  }

  std::string SolidAssembler::Scratch::turned_inside_out(const Batch &batch, const Lanes &det_F) const
  {
    for (unsigned int v = 0; v < batch.size; ++v)
      if (!(det_F[v] > 0.))
      {
        const Cell        &cell = cells[batch.first + v];
        std::ostringstream message;
        message << "Body " << int(cell.body) + 1 << ": the element centred at (" << cell.centre
                << ") in the reference configuration is turned inside out, det F = " << det_F[v];
        return message.str();
      }
    return "";
  }

  void SolidAssembler::Scratch::scatter(const Batch &batch, BlockCsrMatrix *const tangent)
  {
    for (unsigned int v = 0; v < batch.size; ++v)
    {
      const unsigned int        c    = batch.first + v;
      const unsigned int *const node = cell_nodes.data() + c * n_nodes;
      if (loads.act_on(c))
        add_loads(c, v, tangent);
      if (is_constrained(c))
      {
        add_constrained(c, v, tangent);
        continue;
      }
      for (unsigned int i = 0; i < dim * n_nodes; ++i)
        at_nodes.internal[dim * node[i / dim] + i % dim] += at_lanes.force[i][v];
      if (!tangent)
        continue;
      stiffness.eliminate_prescribed(v, node, at_nodes.is_prescribed, at_nodes.prescribed, at_nodes.rhs);
      stiffness.add_to(*tangent, c, v);
    }
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
                                      Vector                          *rhs)
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
        compute(batch, tangent, det_F);
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

  void SolidAssembler::forces(const Vector &u, const double t, Vector &internal, Vector &external) const
  {
    scratch_->sweep(u, t, internal, external, nullptr, nullptr, nullptr);
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
    scratch_->sweep(u, t, internal, external, &constraints, &tangent, &rhs);
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
