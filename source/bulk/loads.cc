#include "bulk/loads.h"
#include "base/deal_ii_versions.h"
#include "bulk/face_table.h"
#include "bulk/follower_pressure.h"
#include "parallel/owned_values.h"
#include "parallel/ownership.h"
#include "parallel/throw_everywhere.h"
#include "parameters/expression.h"

#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    using Load         = BoundaryConditions::Load;
    using Type         = BoundaryConditionParameters::Type;
    using CellIterator = DoFHandler<dim>::active_cell_iterator;

    /// A face with a load at its Gauss points, or a cell with one at a point in it.
    struct LoadedFace
    {
      Load                    *load;
      const ShapeTable        *shape;    ///< at the points
      unsigned int             face = 0; ///< where the load is on one
      std::vector<LoadedPoint> points;
      std::vector<double>      values; ///< of the load at its current time: [point][component]
    };

    bool is_spring(const LoadedFace &loaded)
    {
      const Type type = loaded.load->parameters->type;
      return type == Type::spring || type == Type::point_spring;
    }

    struct LoadedCell
    {
      CellIterator            cell;
      std::vector<Load *>     body_forces;
      std::vector<LoadedFace> faces;
      dealii::Vector<double>  dead; ///< forces at the current time that do not depend on the displacement
    };
    /// Entries of the tangent below this part of the largest are what cancellation leaves.
    constexpr double cancelled = 1e-13;

    /// What stands for a degree of freedom: itself, what a hanging one hangs on, nothing where it is prescribed.
    std::vector<std::pair<DoFIndex, double>> resolved(const DoFIndex dof, const AffineConstraints<double> &constraints)
    {
      if (!constraints.is_constrained(dof))
        return {{dof, 1.}};
      const auto *const entries = constraints.get_constraint_entries(dof);
      return entries == nullptr ? std::vector<std::pair<DoFIndex, double>>()
                                : std::vector<std::pair<DoFIndex, double>>(entries->begin(), entries->end());
    }
  } // namespace

  struct Loads::Implementation
  {
    Implementation(const DoFHandler<dim>                        &dof_handler,
                   const Mapping<dim>                           &mapping,
                   const std::vector<std::unique_ptr<Material>> &materials,
                   std::vector<Load>                            &loads)
        : dof_handler(dof_handler)
        , mapping(mapping)
        , materials(materials)
        , loads(loads)
        , volume(mapping,
                 dof_handler.get_fe(),
                 QGauss<dim>(dof_handler.get_fe().degree + 1),
                 update_values | update_quadrature_points | update_JxW_values)
    {
      for (const auto face : GeometryInfo<dim>::face_indices())
        faces.emplace_back(dof_handler.get_fe().base_element(0), face);
    }

    void             add_cell(const CellIterator &cell);
    LoadedFace       on_face(Load &load, const CellIterator &cell, unsigned int face) const;
    LoadedFace       at_point(Load &load);
    void             evaluate(double t);
    double           value(const Load &load, const Point &X, unsigned int entry);
    void             evaluate_dead_loads(LoadedCell &loaded);
    bool             follows(const LoadedCell &cell, const LoadedFace &face) const;
    FollowerPressure follower(const LoadedFace &loaded) const;
    double displacement(const LoadedFace &loaded, unsigned int q, unsigned int c, const std::vector<double> &u) const;
    void   add_springs(const LoadedFace &loaded, const Cell &cell) const;

    unsigned int dof(const unsigned int node, const unsigned int component) const
    {
      return dof_handler.get_fe().component_to_system_index(component, node);
    }
    const Material &material(const CellIterator &cell) const
    {
      return *materials[cell->material_id()];
    }

    const DoFHandler<dim>                        &dof_handler;
    const Mapping<dim>                           &mapping;
    const std::vector<std::unique_ptr<Material>> &materials;
    std::vector<Load>                            &loads;
    FEValues<dim>                                 volume;
    std::vector<FaceTable>                        faces;
    std::vector<std::unique_ptr<PointTable>>      point_tables; ///< of the loads at points of these cells
    std::vector<int>                              load_of;      ///< per cell: index into loaded_cells or -1
    std::vector<LoadedCell>                       loaded_cells;
    double                                        time = std::numeric_limits<double>::quiet_NaN();
    std::string                                   problem; ///< with the values at this time
  };

  void Loads::Implementation::add_cell(const CellIterator &cell)
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
      if (load.place)
      {
        if (load.place->cell == cell->id())
          found.faces.push_back(at_point(load));
        continue;
      }
      for (const auto face : cell->face_indices())
        if (load.region.selects_face(mapping, cell, face))
          found.faces.push_back(on_face(load, cell, face));
    }
    load_of.push_back(-1);
    if (!found.body_forces.empty() || !found.faces.empty())
    {
      found.dead.reinit(dof_handler.get_fe().n_dofs_per_cell());
      load_of.back() = loaded_cells.size();
      loaded_cells.push_back(std::move(found));
    }
  }

  LoadedFace Loads::Implementation::on_face(Load &load, const CellIterator &cell, const unsigned int face) const
  {
    const FaceTable &table = faces[face];
    FEValues<dim>    values(
        mapping, dof_handler.get_fe(), Quadrature<dim>(table.points), update_quadrature_points | update_jacobians);
    values.reinit(cell);
    LoadedFace loaded{&load, &table, face, {}, {}};
    for (const auto q : values.quadrature_point_indices())
    {
      LoadedPoint point;
      point.X = values.quadrature_point(q);
      for (unsigned int s = 0; s < 2; ++s)
        for (unsigned int i = 0; i < dim; ++i)
          point.tangent[s][i] = values.jacobian(q)[i][table.direction[s]];
      point.weight = table.weights[q];
      point.area   = point.weight * cross_product_3d(point.tangent[0], point.tangent[1]).norm();
      loaded.points.push_back(point);
    }
    return loaded;
  }

  /// The value of the load is that of an area of 1.
  LoadedFace Loads::Implementation::at_point(Load &load)
  {
    point_tables.push_back(std::make_unique<PointTable>(dof_handler.get_fe().base_element(0), load.place->unit));
    return {&load, point_tables.back().get(), 0, {{load.point(), {}, 1., 1.}}, {}};
  }

  void Loads::Implementation::evaluate(const double t)
  {
    if (t == time)
      return;
    time = t;
    problem.clear();
    for (auto &load : loads)
      load.value->set_time(t);
    for (auto &loaded : loaded_cells)
    {
      for (auto &face : loaded.faces)
      {
        face.values.clear();
        for (const auto &point : face.points)
          for (unsigned int c = 0; c < face.load->value->n_components; ++c)
            face.values.push_back(value(*face.load, point.X, c));
      }
      evaluate_dead_loads(loaded);
    }
    throw_everywhere<InputError>(problem, communicator_of(dof_handler));
  }

  /// Of a load at its current time; notes the first one that is no number.
  double Loads::Implementation::value(const Load &load, const Point &X, const unsigned int entry)
  {
    const double number = load.parameters->acts(time) ? load.value->value(X, entry) : 0.;
    if (!std::isfinite(number) && problem.empty())
      problem = load.label + ": " + value_complaint(load.parameters->value[entry], number, X, time);
    return number;
  }

  void Loads::Implementation::evaluate_dead_loads(LoadedCell &loaded)
  {
    loaded.dead = 0.;
    if (!loaded.body_forces.empty())
      volume.reinit(loaded.cell);
    for (const auto *load : loaded.body_forces)
      for (const auto q : volume.quadrature_point_indices())
        for (unsigned int c = 0; c < load->directions.size(); ++c)
        {
          const double force = value(*load, volume.quadrature_point(q), c) * volume.JxW(q);
          for (unsigned int a = 0; a < dof_handler.get_fe().base_element(0).n_dofs_per_cell(); ++a)
            for (unsigned int i = 0; i < dim; ++i)
              loaded.dead(dof(a, i)) += force * load->directions[c][i] * volume.shape_value(dof(a, i), q);
        }
    for (const auto &face : loaded.faces)
    {
      const ShapeTable &table      = *face.shape;
      const auto       &load       = *face.load->parameters;
      const auto       &directions = face.load->directions;
      for (unsigned int q = 0; q < face.points.size(); ++q)
      {
        Vector3 force;
        if (load.type == Type::traction || load.type == Type::point_load)
          for (unsigned int c = 0; c < directions.size(); ++c)
            force += face.values[q * directions.size() + c] * face.points[q].area * directions[c];
        else if (load.type == Type::pressure && material(loaded.cell).small_strain())
          force = -face.values[q] * face.points[q].weight *
                  cross_product_3d(face.points[q].tangent[0], face.points[q].tangent[1]);
        for (unsigned int a = 0; a < table.nodes.size(); ++a)
          for (unsigned int i = 0; i < dim; ++i)
            loaded.dead(dof(table.nodes[a], i)) += table.value[q][a] * force[i];
      }
    }
  }

  /// Displacement at point @p q of the load along its direction @p c.
  double Loads::Implementation::displacement(const LoadedFace          &loaded,
                                             const unsigned int         q,
                                             const unsigned int         c,
                                             const std::vector<double> &u) const
  {
    const Vector3 &direction = loaded.load->directions[c];
    double         along     = 0.;
    for (unsigned int a = 0; a < loaded.shape->nodes.size(); ++a)
      for (unsigned int i = 0; i < dim; ++i)
        along += loaded.shape->value[q][a] * direction[i] * u[dof(loaded.shape->nodes[a], i)];
    return along;
  }

  void Loads::Implementation::add_springs(const LoadedFace &loaded, const Cell &cell) const
  {
    const unsigned int n_directions = loaded.load->directions.size();
    for (unsigned int q = 0; q < loaded.points.size(); ++q)
      for (unsigned int c = 0; c < n_directions; ++c)
      {
        const double stiffness = loaded.values[q * n_directions + c] * loaded.points[q].area;
        const double u         = displacement(loaded, q, c, cell.u);
        std::vector<std::pair<unsigned int, double>> shares; // of the displacements of the cell in that
        for (unsigned int a = 0; a < loaded.shape->nodes.size(); ++a)
          for (unsigned int i = 0; i < dim; ++i)
            if (const double along = loaded.load->directions[c][i]; along != 0.)
              shares.emplace_back(dof(loaded.shape->nodes[a], i), loaded.shape->value[q][a] * along);
        for (const auto &[i, share] : shares)
        {
          cell.internal(i) += stiffness * share * u;
          if (cell.tangent)
            for (const auto &[j, other] : shares)
              (*cell.tangent)(i, j) += stiffness * share * other;
        }
      }
  }

  /// Whether the load is a pressure that follows the face.
  bool Loads::Implementation::follows(const LoadedCell &cell, const LoadedFace &face) const
  {
    return face.load->parameters->type == Type::pressure && !material(cell.cell).small_strain();
  }

  FollowerPressure Loads::Implementation::follower(const LoadedFace &loaded) const
  {
    return {dof_handler.get_fe(), faces[loaded.face], loaded.points, loaded.values};
  }

  double Loads::spring_energy(const unsigned int number, const std::vector<double> &u) const
  {
    const Implementation &l      = *implementation_;
    double                energy = 0.;
    for (const LoadedFace &loaded : l.loaded_cells[l.load_of[number]].faces)
    {
      const unsigned int n_directions = loaded.load->directions.size();
      for (unsigned int q = 0; q < loaded.points.size() && is_spring(loaded); ++q)
        for (unsigned int c = 0; c < n_directions; ++c)
          energy += 0.5 * loaded.values[q * n_directions + c] * loaded.points[q].area *
                    std::pow(l.displacement(loaded, q, c, u), 2);
    }
    return energy;
  }

  Loads::Loads(const DoFHandler<dim>                        &dof_handler,
               const Mapping<dim>                           &mapping,
               const std::vector<std::unique_ptr<Material>> &materials,
               std::vector<Load>                            &loads)
      : implementation_(std::make_unique<Implementation>(dof_handler, mapping, materials, loads))
  {
  }

  Loads::~Loads() = default;

  void Loads::add_cell(const CellIterator &cell)
  {
    implementation_->add_cell(cell);
  }

  void Loads::evaluate(const double t)
  {
    implementation_->evaluate(t);
  }

  bool Loads::act_on(const unsigned int cell) const
  {
    return implementation_->load_of[cell] >= 0;
  }

  void Loads::add(const unsigned int number, const Cell &cell) const
  {
    const LoadedCell &loaded = implementation_->loaded_cells[implementation_->load_of[number]];
    cell.external += loaded.dead;
    for (const auto &face : loaded.faces)
      if (is_spring(face))
        implementation_->add_springs(face, cell);
      else if (implementation_->follows(loaded, face))
        implementation_->follower(face).add(cell.u, cell.external, cell.tangent);
  }

  void Loads::add_variation(const Vector &u, const AffineConstraints<double> &constraints, LinearSystem &system) const
  {
    const Implementation &l = *implementation_;
    if (std::none_of(
            l.loads.begin(), l.loads.end(), [](const Load &load) { return load.parameters->type == Type::pressure; }))
      return;
    const unsigned int       n = l.dof_handler.get_fe().n_dofs_per_cell();
    std::vector<DoFIndex>    dofs(n);
    std::vector<double>      at_cell(n);
    FullMatrix<double>       matrix(n, n);
    std::vector<MatrixEntry> entries, prescribed; // of the second, the columns mean nothing
    for (const LoadedCell &loaded : l.loaded_cells)
    {
      if (!loaded.cell->is_locally_owned()) // those of other ranks that stand here send theirs
        continue;
      matrix = 0.;
      loaded.cell->get_dof_indices(dofs);
      for (unsigned int i = 0; i < n; ++i)
        at_cell[i] = u(dofs[i]);
      for (const LoadedFace &face : loaded.faces)
        if (l.follows(loaded, face))
          l.follower(face).add_unsymmetric(at_cell, matrix);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          if (matrix(i, j) != 0.)
            for (const auto &[row, row_part] : resolved(dofs[i], constraints))
            {
              for (const auto &[column, part] : resolved(dofs[j], constraints))
                entries.push_back({row, column, row_part * part * matrix(i, j)});
              if (const double given = constraints.get_inhomogeneity(dofs[j]); given != 0.)
                prescribed.push_back({row, 0, row_part * matrix(i, j) * given});
            }
    }
    const Ownership   ownership(system.layout->owned[0], system.layout->communicator);
    const double      negligible = cancelled * system.bulk.largest_diagonal();
    const OwnedValues rhs(system.rhs.block(0));
    for (const MatrixEntry &e : ownership.exchange(std::move(prescribed)))
      rhs(e.row) -= e.value;
    bool any = false;
    for (const MatrixEntry &e : ownership.exchange(std::move(entries)))
      if (std::abs(e.value) > negligible)
      {
        any = true;
        system.variation.add(e.row, e.column, e.value);
      }
    if (Utilities::MPI::logical_or(any, system.layout->communicator))
      system.symmetric = false;
  }
} // namespace Nodus
