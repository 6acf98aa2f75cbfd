#include <nodus/bulk/element_kernel.h>
#include <nodus/bulk/loads.h>
#include <nodus/bulk/solid_assembler.h>
#include <nodus/bulk/throw_everywhere.h>

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/trilinos_vector.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace Nodus
{
  using namespace dealii;

  /// Every rank integrates all cells around its nodes, those of its neighbours too: nothing has to be sent.
  struct SolidAssembler::Scratch
  {
    Scratch(const DoFHandler<dim>                        &dof_handler,
            const Mapping<dim>                           &mapping,
            const std::vector<std::unique_ptr<Material>> &materials,
            std::vector<BoundaryConditions::Load>        &loads);

    void make_positions(NodeMatrix &tangent);
    void sweep(const Vector                    &u,
               double                           t,
               Vector                          &internal,
               Vector                          &external,
               const AffineConstraints<double> *constraints,
               NodeMatrix                      *tangent,
               Vector                          *rhs);

    const DoFHandler<dim>                        &dof_handler;
    const std::vector<std::unique_ptr<Material>> &materials;
    std::unique_ptr<ElementKernel>                kernel;
    Loads                                         loads;
    unsigned int                                  n_nodes, n_q; ///< per cell

    struct Cell
    {
      Point         centre;
      unsigned char body;
    };
    std::vector<Cell>                           cells;
    std::vector<ElementKernel::QuadraturePoint> geometry; ///< [cell][point]
    std::shared_ptr<const NodeMap>              nodes;
    std::vector<unsigned int>                   cell_nodes; ///< [cell][node], local numbers
    std::vector<DoFIndex>                       dofs;       ///< of the local nodes
    std::vector<NodeMatrix::Position>           positions;  ///< [cell][node a][node b >= a]

  private:
    bool is_last(const Vector &u, double t, const AffineConstraints<double> *constraints, NodeMatrix *tangent);
    void eliminate_prescribed(unsigned int cell, const AffineConstraints<double> &constraints);
    void scatter(unsigned int cell, NodeMatrix &tangent) const;

    std::vector<double> last_values; ///< displacement, time and prescribed displacements of the last sweep
    NodeMatrix         *last_tangent = nullptr;
    // at the local nodes, and of the cell at hand
    std::vector<double>    nodal_u, nodal_internal, nodal_external, nodal_rhs;
    std::vector<double>    cell_u;
    dealii::Vector<double> cell_internal, cell_external, cell_rhs;
    FullMatrix<double>     cell_tangent;
  };

  SolidAssembler::Scratch::Scratch(const DoFHandler<dim>                        &dof_handler,
                                   const Mapping<dim>                           &mapping,
                                   const std::vector<std::unique_ptr<Material>> &materials,
                                   std::vector<BoundaryConditions::Load>        &body_loads)
      : dof_handler(dof_handler)
      , materials(materials)
      , kernel(ElementKernel::make(dof_handler.get_fe()))
      , loads(dof_handler, mapping, materials, body_loads)
      , n_nodes(dof_handler.get_fe().n_dofs_per_cell() / dim)
  {
    const auto   &fe = dof_handler.get_fe();
    FEValues<dim> volume(mapping, fe, QGauss<dim>(fe.degree + 1), update_inverse_jacobians | update_JxW_values);
    n_q = volume.n_quadrature_points;
    cell_u.resize(fe.n_dofs_per_cell());
    for (auto *v : {&cell_internal, &cell_external, &cell_rhs})
      v->reinit(fe.n_dofs_per_cell());
    cell_tangent.reinit(fe.n_dofs_per_cell(), fe.n_dofs_per_cell());

    const IndexSet       &owned = dof_handler.locally_owned_dofs();
    std::vector<DoFIndex> cell_dofs(fe.n_dofs_per_cell()), global_nodes, ghosts;
    for (const auto &cell : dof_handler.active_cell_iterators())
    {
      if (cell->is_artificial())
        continue;
      cell->get_dof_indices(cell_dofs);
      if (std::none_of(cell_dofs.begin(), cell_dofs.end(), [&](const DoFIndex i) { return owned.is_element(i); }))
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
      for (const auto face : cell->face_indices())
        AssertThrow(cell->at_boundary(face) || !cell->neighbor_is_coarser(face), ExcNotImplemented());
      volume.reinit(cell);
      for (const auto q : volume.quadrature_point_indices())
      {
        ElementKernel::QuadraturePoint point;
        for (unsigned int e = 0; e < dim; ++e)
          for (unsigned int J = 0; J < dim; ++J)
            point.inverse_jacobian[e][J] = volume.inverse_jacobian(q)[e][J];
        point.JxW = volume.JxW(q);
        geometry.push_back(point);
      }
      cells.push_back({cell->center(), static_cast<unsigned char>(cell->material_id())});
      loads.add_cell(cell);
    }
    nodes = std::make_shared<NodeMap>(owned, std::move(ghosts), dof_handler.get_communicator());
    for (const DoFIndex node : global_nodes)
      cell_nodes.push_back(nodes->local(node));
    for (unsigned int i = 0; i < nodes->size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        dofs.push_back(dim * nodes->global(i) + c);
    for (auto *v : {&nodal_u, &nodal_internal, &nodal_external, &nodal_rhs})
      v->resize(dofs.size());
  }

  void SolidAssembler::Scratch::make_positions(NodeMatrix &tangent)
  {
    tangent.reinit(nodes, cell_nodes, n_nodes);
    positions.clear();
    positions.reserve(cells.size() * n_nodes * (n_nodes + 1) / 2);
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int b = a; b < n_nodes; ++b)
          positions.push_back(tangent.position(cell_nodes[c * n_nodes + a], cell_nodes[c * n_nodes + b]));
  }

  void SolidAssembler::Scratch::eliminate_prescribed(const unsigned int               cell,
                                                     const AffineConstraints<double> &constraints)
  {
    for (unsigned int i = 0; i < cell_rhs.size(); ++i)
    {
      const DoFIndex dof = dofs[dim * cell_nodes[cell * n_nodes + i / dim] + i % dim];
      if (!constraints.is_constrained(dof))
        continue;
      const double value = constraints.get_inhomogeneity(dof), diagonal = std::abs(cell_tangent(i, i));
      for (unsigned int j = 0; j < cell_rhs.size(); ++j)
      {
        cell_rhs(j) -= cell_tangent(j, i) * value;
        cell_tangent(i, j) = cell_tangent(j, i) = 0.;
      }
      cell_tangent(i, i) = diagonal;
      cell_rhs(i)        = 0.;
    }
  }

  void SolidAssembler::Scratch::scatter(const unsigned int cell, NodeMatrix &tangent) const
  {
    const NodeMatrix::Position *position = positions.data() + cell * (n_nodes * (n_nodes + 1) / 2);
    for (unsigned int a = 0; a < n_nodes; ++a)
      for (unsigned int b = a; b < n_nodes; ++b, ++position)
      {
        if (!position->stored())
          continue;
        double *const block = tangent.block(position->block());
        const bool    swap  = position->transposed();
        for (unsigned int i = 0; i < dim; ++i)
        {
          const double *const row = &cell_tangent(dim * (swap ? b : a) + i, dim * (swap ? a : b));
          for (unsigned int k = 0; k < dim; ++k)
            block[dim * i + k] += row[k];
        }
      }
  }

  /// Contact loops come back with other statuses and the same displacement: then everything is there already. Otherwise
  /// takes note of the values for the next call.
  bool SolidAssembler::Scratch::is_last(const Vector                    &u,
                                        const double                     t,
                                        const AffineConstraints<double> *constraints,
                                        NodeMatrix                      *tangent)
  {
    std::vector<double> values(dofs.size());
    u.extract_subvector_to(dofs.begin(), dofs.end(), values.begin());
    values.push_back(t);
    if (constraints)
      for (const auto &line : constraints->get_lines())
        values.push_back(line.inhomogeneity);
    const bool same = tangent && tangent == last_tangent && values == last_values;
    if (Utilities::MPI::min(same ? 1 : 0, dof_handler.get_communicator()) == 1)
      return true;
    std::copy_n(values.begin(), nodal_u.size(), nodal_u.begin());
    last_values.swap(values);
    last_tangent = tangent;
    return false;
  }

  void SolidAssembler::Scratch::sweep(const Vector                    &u,
                                      const double                     t,
                                      Vector                          &internal,
                                      Vector                          &external,
                                      const AffineConstraints<double> *constraints,
                                      NodeMatrix                      *tangent,
                                      Vector                          *rhs)
  {
    const auto set = [&](Vector &v, const std::vector<double> &values)
    {
      v.reinit(dof_handler.locally_owned_dofs(), dof_handler.get_communicator());
      std::copy_n(values.begin(), dim * nodes->n_owned(), v.trilinos_vector()[0]);
    };
    const auto set_all = [&]
    {
      set(internal, nodal_internal);
      set(external, nodal_external);
      if (rhs)
        set(*rhs, nodal_rhs);
    };

    if (is_last(u, t, constraints, tangent))
      return set_all();
    loads.evaluate(t);
    if (tangent)
      tangent->set_zero();
    for (auto *v : {&nodal_internal, &nodal_external, &nodal_rhs})
      std::fill(v->begin(), v->end(), 0.);

    std::string failure;
    for (unsigned int c = 0; c < cells.size(); ++c)
    {
      const unsigned int *const cell = cell_nodes.data() + c * n_nodes;
      for (unsigned int a = 0; a < n_nodes; ++a)
        std::copy_n(nodal_u.begin() + dim * cell[a], dim, cell_u.begin() + dim * a);
      const double det_F = kernel->integrate(
          &geometry[c * n_q], *materials[cells[c].body], cell_u, cell_internal, tangent ? &cell_tangent : nullptr);
      if (!(det_F > 0.))
      {
        std::ostringstream message;
        message << "Body " << int(cells[c].body) + 1 << ": the element centred at (" << cells[c].centre
                << ") in the reference configuration is turned inside out, det F = " << det_F;
        failure = message.str();
        break;
      }
      const bool loaded = loads.act_on(c);
      if (loaded)
      {
        cell_external = 0.;
        loads.add(c, {cell_u, cell_internal, cell_external, tangent ? &cell_tangent : nullptr});
      }

      for (unsigned int i = 0; i < dim * n_nodes; ++i)
      {
        const unsigned int dof = dim * cell[i / dim] + i % dim;
        nodal_internal[dof] += cell_internal(i);
        if (loaded)
          nodal_external[dof] += cell_external(i);
      }
      if (!tangent)
        continue;
      for (unsigned int i = 0; i < dim * n_nodes; ++i)
        cell_rhs(i) = (loaded ? cell_external(i) : 0.) - cell_internal(i);
      eliminate_prescribed(c, *constraints);
      for (unsigned int i = 0; i < dim * n_nodes; ++i)
        nodal_rhs[dim * cell[i / dim] + i % dim] += cell_rhs(i);
      scatter(c, *tangent);
    }

    set_all();
    if (!failure.empty())
      last_tangent = nullptr;
    throw_everywhere<SolverFailure>(failure, dof_handler.get_communicator());
  }

  SolidAssembler::SolidAssembler(const DoFHandler<dim>                        &dof_handler,
                                 const Mapping<dim>                           &mapping,
                                 const std::vector<std::unique_ptr<Material>> &materials,
                                 std::vector<BoundaryConditions::Load>        &loads)
      : scratch_(std::make_unique<Scratch>(dof_handler, mapping, materials, loads))
  {
  }

  SolidAssembler::~SolidAssembler() = default;

  void SolidAssembler::forces(const Vector &u, const double t, Vector &internal, Vector &external) const
  {
    scratch_->sweep(u, t, internal, external, nullptr, nullptr, nullptr);
  }

  void SolidAssembler::tangent(const Vector                    &u,
                               const double                     t,
                               const AffineConstraints<double> &constraints,
                               NodeMatrix                      &tangent,
                               Vector                          &rhs,
                               Vector                          &internal,
                               Vector                          &external) const
  {
    scratch_->sweep(u, t, internal, external, &constraints, &tangent, &rhs);
  }

  void SolidAssembler::make_sparsity(NodeMatrix &tangent) const
  {
    scratch_->make_positions(tangent);
  }
} // namespace Nodus
