#include <nodus/bulk/element_kernel.h>
#include <nodus/bulk/face_table.h>
#include <nodus/bulk/solid_assembler.h>
#include <nodus/bulk/throw_everywhere.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/lac/trilinos_vector.h>

#include <limits>
#include <sstream>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    using Load         = BoundaryConditions::Load;
    using Type         = BoundaryConditionParameters::Type;
    using CellIterator = DoFHandler<dim>::active_cell_iterator;

    /// Quadrature point of a loaded face.
    struct FacePoint
    {
      Point   X;
      Vector3 tangent[2]; ///< dX/d(unit coordinate), their cross product points out of the body
      double  weight;     ///< on the unit face
      double  area;       ///< weight times reference area
    };

    struct LoadedFace
    {
      Load                  *load;
      unsigned int           face;
      std::vector<FacePoint> points;
      std::vector<double>    values; ///< of the load at its current time: [point][component]
    };

    struct LoadedCell
    {
      CellIterator            cell;
      std::vector<Load *>     body_forces;
      std::vector<LoadedFace> faces;
      dealii::Vector<double>  dead; ///< forces at the current time that do not depend on the displacement
    };
  } // namespace

  struct SolidAssembler::Scratch
  {
    Scratch(const DoFHandler<dim>                        &dof_handler,
            const Mapping<dim>                           &mapping,
            const std::vector<std::unique_ptr<Material>> &materials,
            std::vector<Load>                            &loads);

    void sweep(const Vector                    &u,
               double                           t,
               Vector                          &internal,
               Vector                          &external,
               const AffineConstraints<double> *constraints,
               SparseMatrix                    *tangent,
               Vector                          *rhs);

    const DoFHandler<dim> &dof_handler;
    IndexSet               relevant;

  private:
    void find_loads(const CellIterator &cell, const Mapping<dim> &mapping);
    void evaluate_loads(double t);
    void evaluate_dead_loads(LoadedCell &loaded);
    void add_pressure(const LoadedFace &loaded);
    void add_springs(const LoadedFace &loaded);

    unsigned int dof(const unsigned int node, const unsigned int component) const
    {
      return dof_handler.get_fe().component_to_system_index(component, node);
    }
    const Material &material(const CellIterator &cell) const
    {
      return *materials[cell->material_id()];
    }

    const std::vector<std::unique_ptr<Material>> &materials;
    std::vector<Load>                            &loads;

    std::unique_ptr<ElementKernel>              kernel;
    FEValues<dim>                               volume;
    std::vector<FaceTable>                      faces;
    std::vector<CellIterator>                   cells;    ///< owned
    std::vector<ElementKernel::QuadraturePoint> geometry; ///< [cell][point]
    std::vector<DoFIndex>                       dofs;     ///< [cell][local dof]
    std::vector<int>                            load_of;  ///< per cell: index into loaded_cells or -1
    std::vector<LoadedCell>                     loaded_cells;
    double                                      load_time = std::numeric_limits<double>::quiet_NaN();
    Vector                                      zero; ///< writable for the dofs of all owned cells

    // of the cell at hand
    std::vector<double>    cell_u;
    dealii::Vector<double> cell_internal, cell_external;
    FullMatrix<double>     cell_tangent;
    bool                   with_tangent = false;
  };

  SolidAssembler::Scratch::Scratch(const DoFHandler<dim>                        &dof_handler,
                                   const Mapping<dim>                           &mapping,
                                   const std::vector<std::unique_ptr<Material>> &materials,
                                   std::vector<Load>                            &loads)
      : dof_handler(dof_handler)
      , relevant(DoFTools::extract_locally_relevant_dofs(dof_handler))
      , materials(materials)
      , loads(loads)
      , kernel(ElementKernel::make(dof_handler.get_fe()))
      , volume(mapping,
               dof_handler.get_fe(),
               QGauss<dim>(dof_handler.get_fe().degree + 1),
               update_values | update_quadrature_points | update_inverse_jacobians | update_JxW_values)
  {
    const auto        &fe = dof_handler.get_fe();
    const unsigned int n  = fe.n_dofs_per_cell();
    for (const auto face : GeometryInfo<dim>::face_indices())
      faces.emplace_back(fe.base_element(0), face);
    zero.reinit(dof_handler.locally_owned_dofs(), relevant, dof_handler.get_communicator(), /* writable = */ true);
    cell_u.resize(n);
    cell_internal.reinit(n);
    cell_external.reinit(n);
    cell_tangent.reinit(n, n);

    std::vector<DoFIndex> cell_dofs(n);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
      {
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
        cell->get_dof_indices(cell_dofs);
        dofs.insert(dofs.end(), cell_dofs.begin(), cell_dofs.end());
        cells.push_back(cell);
        find_loads(cell, mapping);
      }
  }

  void SolidAssembler::Scratch::find_loads(const CellIterator &cell, const Mapping<dim> &mapping)
  {
    LoadedCell found;
    found.cell = cell;
    for (auto &load : loads)
    {
      if (load.parameters->type == Type::body_force)
      {
        if (load.region.selects_cell(mapping, cell))
          found.body_forces.push_back(&load);
        continue;
      }
      for (const auto face : cell->face_indices())
        if (load.region.selects_face(mapping, cell, face))
        {
          const FaceTable &table = faces[face];
          FEValues<dim>    values(mapping,
                               dof_handler.get_fe(),
                               Quadrature<dim>(table.points),
                               update_quadrature_points | update_jacobians);
          values.reinit(cell);
          LoadedFace loaded;
          loaded.load = &load;
          loaded.face = face;
          for (const auto q : values.quadrature_point_indices())
          {
            FacePoint point;
            point.X = values.quadrature_point(q);
            for (unsigned int s = 0; s < 2; ++s)
              for (unsigned int i = 0; i < dim; ++i)
                point.tangent[s][i] = values.jacobian(q)[i][table.direction[s]];
            point.weight = table.weights[q];
            point.area   = point.weight * cross_product_3d(point.tangent[0], point.tangent[1]).norm();
            loaded.points.push_back(point);
          }
          found.faces.push_back(std::move(loaded));
        }
    }
    load_of.push_back(-1);
    if (!found.body_forces.empty() || !found.faces.empty())
    {
      found.dead.reinit(dof_handler.get_fe().n_dofs_per_cell());
      load_of.back() = loaded_cells.size();
      loaded_cells.push_back(std::move(found));
    }
  }

  void SolidAssembler::Scratch::evaluate_loads(const double t)
  {
    if (t == load_time)
      return;
    for (auto &load : loads)
      load.value->set_time(t);
    for (auto &loaded : loaded_cells)
    {
      for (auto &face : loaded.faces)
      {
        face.values.clear();
        for (const auto &point : face.points)
          for (unsigned int c = 0; c < face.load->value->n_components; ++c)
            face.values.push_back(face.load->value->value(point.X, c));
      }
      evaluate_dead_loads(loaded);
    }
    load_time = t;
  }

  void SolidAssembler::Scratch::evaluate_dead_loads(LoadedCell &loaded)
  {
    loaded.dead = 0.;
    if (!loaded.body_forces.empty())
      volume.reinit(loaded.cell);
    for (const auto *load : loaded.body_forces)
      for (const auto q : volume.quadrature_point_indices())
        for (unsigned int c = 0; c < load->parameters->components.size(); ++c)
        {
          const double force = load->value->value(volume.quadrature_point(q), c) * volume.JxW(q);
          for (unsigned int a = 0; a < dof_handler.get_fe().base_element(0).n_dofs_per_cell(); ++a)
          {
            const unsigned int i = dof(a, load->parameters->components[c]);
            loaded.dead(i) += force * volume.shape_value(i, q);
          }
        }
    for (const auto &face : loaded.faces)
    {
      const FaceTable &table = faces[face.face];
      const auto      &load  = *face.load->parameters;
      for (unsigned int q = 0; q < face.points.size(); ++q)
      {
        Vector3 force;
        if (load.type == Type::traction)
          for (unsigned int c = 0; c < load.components.size(); ++c)
            force[load.components[c]] = face.values[q * load.components.size() + c] * face.points[q].area;
        else if (load.type == Type::pressure && material(loaded.cell).small_strain())
          force = -face.values[q] * face.points[q].weight *
                  cross_product_3d(face.points[q].tangent[0], face.points[q].tangent[1]);
        for (unsigned int a = 0; a < table.nodes.size(); ++a)
          for (unsigned int i = 0; i < dim; ++i)
            loaded.dead(dof(table.nodes[a], i)) += table.value[q][a] * force[i];
      }
    }
  }

  /// Follower pressure: f_a = - int p N_a (t_0 x t_1) with the current tangents t. Of its derivative
  /// - int p N_a [v_b] du_b, v_b = N_b,0 t_1 - N_b,1 t_0, the symmetric half is kept: exact for uniform pressure when
  /// the edge of the loaded patch is held or the patch is closed, since the rest is an integral along that edge.
  void SolidAssembler::Scratch::add_pressure(const LoadedFace &loaded)
  {
    const FaceTable     &table = faces[loaded.face];
    const unsigned int   n     = table.nodes.size();
    std::vector<Vector3> v(n);
    for (unsigned int q = 0; q < loaded.points.size(); ++q)
    {
      Vector3 t[2] = {loaded.points[q].tangent[0], loaded.points[q].tangent[1]};
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int s = 0; s < 2; ++s)
            t[s][i] += cell_u[dof(table.nodes[a], i)] * table.gradient[s][q][a];
      const double  p     = loaded.values[q] * loaded.points[q].weight;
      const Vector3 force = -p * cross_product_3d(t[0], t[1]);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          cell_external(dof(table.nodes[a], i)) += table.value[q][a] * force[i];
      if (!with_tangent)
        continue;
      for (unsigned int a = 0; a < n; ++a)
        v[a] = table.gradient[0][q][a] * t[1] - table.gradient[1][q][a] * t[0];
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
        {
          const Vector3 w = p / 2. * (table.value[q][a] * v[b] - table.value[q][b] * v[a]);
          for (unsigned int i = 0; i < dim; ++i)
          {
            const unsigned int k = (i + 1) % dim, m = (i + 2) % dim;
            cell_tangent(dof(table.nodes[a], i), dof(table.nodes[b], k)) += w[m];
            cell_tangent(dof(table.nodes[a], i), dof(table.nodes[b], m)) -= w[k];
          }
        }
    }
  }

  void SolidAssembler::Scratch::add_springs(const LoadedFace &loaded)
  {
    const FaceTable &table      = faces[loaded.face];
    const auto      &components = loaded.load->parameters->components;
    for (unsigned int q = 0; q < loaded.points.size(); ++q)
      for (unsigned int c = 0; c < components.size(); ++c)
      {
        const double stiffness = loaded.values[q * components.size() + c] * loaded.points[q].area;
        double       u         = 0.;
        for (unsigned int a = 0; a < table.nodes.size(); ++a)
          u += table.value[q][a] * cell_u[dof(table.nodes[a], components[c])];
        for (unsigned int a = 0; a < table.nodes.size(); ++a)
        {
          const unsigned int i = dof(table.nodes[a], components[c]);
          cell_internal(i) += stiffness * table.value[q][a] * u;
          if (with_tangent)
            for (unsigned int b = 0; b < table.nodes.size(); ++b)
              cell_tangent(i, dof(table.nodes[b], components[c])) += stiffness * table.value[q][a] * table.value[q][b];
        }
      }
  }

  void SolidAssembler::Scratch::sweep(const Vector                    &u,
                                      const double                     t,
                                      Vector                          &internal,
                                      Vector                          &external,
                                      const AffineConstraints<double> *constraints,
                                      SparseMatrix                    *tangent,
                                      Vector                          *rhs)
  {
    evaluate_loads(t);
    internal.reinit(zero);
    external.reinit(zero);
    with_tangent = tangent != nullptr;
    if (with_tangent)
    {
      *tangent = 0.;
      rhs->reinit(zero);
    }

    const unsigned int    n   = dof_handler.get_fe().n_dofs_per_cell();
    const unsigned int    n_q = volume.n_quadrature_points;
    std::vector<DoFIndex> cell_dofs(n);
    std::string           failure;
    for (unsigned int c = 0; c < cells.size(); ++c)
    {
      cell_dofs.assign(dofs.begin() + c * n, dofs.begin() + (c + 1) * n);
      u.extract_subvector_to(cell_dofs.begin(), cell_dofs.end(), cell_u.begin());
      const double det_F = kernel->integrate(
          &geometry[c * n_q], material(cells[c]), cell_u, cell_internal, with_tangent ? &cell_tangent : nullptr);
      if (!(det_F > 0.))
      {
        std::ostringstream message;
        message << "Body " << cells[c]->material_id() + 1 << ": the element centred at (" << cells[c]->center()
                << ") in the reference configuration is turned inside out, det F = " << det_F;
        failure = message.str();
        break;
      }

      cell_external = 0.;
      if (load_of[c] >= 0)
      {
        const LoadedCell &loaded = loaded_cells[load_of[c]];
        cell_external            = loaded.dead;
        for (const auto &face : loaded.faces)
          if (face.load->parameters->type == Type::spring)
            add_springs(face);
          else if (face.load->parameters->type == Type::pressure && !material(cells[c]).small_strain())
            add_pressure(face);
      }

      internal.add(n, cell_dofs.data(), cell_internal.begin());
      external.add(n, cell_dofs.data(), cell_external.begin());
      if (with_tangent)
      {
        cell_external -= cell_internal;
        constraints->distribute_local_to_global(cell_tangent, cell_external, cell_dofs, *tangent, *rhs);
      }
    }

    // before any throw, so that no rank keeps entries of another one
    internal.compress(VectorOperation::add);
    external.compress(VectorOperation::add);
    if (with_tangent)
    {
      tangent->compress(VectorOperation::add);
      rhs->compress(VectorOperation::add);
    }
    throw_everywhere<SolverFailure>(failure, dof_handler.get_communicator());
  }

  SolidAssembler::SolidAssembler(const DoFHandler<dim>                        &dof_handler,
                                 const Mapping<dim>                           &mapping,
                                 const std::vector<std::unique_ptr<Material>> &materials,
                                 std::vector<Load>                            &loads)
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
                               SparseMatrix                    &tangent,
                               Vector                          &rhs,
                               Vector                          &internal,
                               Vector                          &external) const
  {
    scratch_->sweep(u, t, internal, external, &constraints, &tangent, &rhs);
  }

  void SolidAssembler::make_sparsity(const AffineConstraints<double> &constraints, SparseMatrix &matrix) const
  {
    const auto                       &dof_handler  = scratch_->dof_handler;
    const IndexSet                   &owned        = dof_handler.locally_owned_dofs();
    const MPI_Comm                    communicator = dof_handler.get_communicator();
    TrilinosWrappers::SparsityPattern pattern(owned, owned, scratch_->relevant, communicator);
    DoFTools::make_sparsity_pattern(
        dof_handler, pattern, constraints, false, Utilities::MPI::this_mpi_process(communicator));
    pattern.compress();
    matrix.reinit(pattern);
  }
} // namespace Nodus
