#include "bulk/nodal_stress.h"
#include "mesh/hanging_nodes.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    /// Where the six components of a symmetric tensor live in two vectors of three components per node. A third vector
    /// has the equivalent plastic strain in its first component.
    constexpr unsigned int stress_row[2][dim]    = {{0, 1, 2}, {1, 0, 0}};
    constexpr unsigned int stress_column[2][dim] = {{0, 1, 2}, {2, 2, 1}};
  } // namespace

  NodalStress::NodalStress(const DoFHandler<dim> &dof_handler,
                           const Mapping<dim>    &mapping,
                           const SolidAssembler  &solid,
                           const Vector          &u)
  {
    const auto       &fe    = dof_handler.get_fe();
    const auto       &owned = dof_handler.locally_owned_dofs();
    const QGauss<dim> quadrature(fe.degree + 1);
    FEValues<dim>     fe_values(mapping, fe, quadrature, update_values);
    const bool        plastic = solid.has_history();

    const AffineConstraints<double> hanging_nodes = hanging_constraints(dof_handler);

    Vector mass = sums_over_cells(dof_handler, hanging_nodes);
    values_.assign(plastic ? 3 : 2, mass);

    const unsigned int                  n_dofs = fe.n_dofs_per_cell();
    std::vector<DoFIndex>               dofs(n_dofs);
    std::vector<dealii::Vector<double>> cell_values(values_.size());
    dealii::Vector<double>              cell_mass(n_dofs);

    solid.visit(
        u,
        [&](const DoFHandler<dim>::active_cell_iterator &cell, const std::vector<SolidAssembler::PointResult> &points)
        {
          fe_values.reinit(cell);
          for (auto &v : cell_values)
            v.reinit(n_dofs);
          cell_mass = 0.;
          for (unsigned int q = 0; q < points.size(); ++q)
            for (unsigned int i = 0; i < n_dofs; ++i)
            {
              const unsigned int c      = fe.system_to_component_index(i).first;
              const double       weight = fe_values.shape_value(i, q) * points[q].JxW;
              cell_mass[i] += weight;
              for (unsigned int part = 0; part < 2; ++part)
                cell_values[part][i] += weight * points[q].cauchy_stress[stress_row[part][c]][stress_column[part][c]];
              if (plastic && c == 0)
                cell_values[2][i] += weight * points[q].equivalent_plastic_strain;
            }
          cell->get_dof_indices(dofs);
          hanging_nodes.distribute_local_to_global(cell_mass, dofs, mass);
          for (unsigned int part = 0; part < values_.size(); ++part)
            hanging_nodes.distribute_local_to_global(cell_values[part], dofs, values_[part]);
        });

    mass.compress(VectorOperation::add);
    for (unsigned int part = 0; part < values_.size(); ++part)
    {
      values_[part].compress(VectorOperation::add);
      for (const auto i : owned)
        if (!hanging_nodes.is_constrained(i))
          values_[part](i) /= mass(i);
      hanging_nodes.distribute(values_[part]);
      values_[part].update_ghost_values();
    }
  }

  SymmetricTensor<2, dim> NodalStress::stress(const DoFIndex first_dof) const
  {
    SymmetricTensor<2, dim> sigma;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int part = 0; part < 2; ++part)
        sigma[stress_row[part][c]][stress_column[part][c]] = values_[part](first_dof + c);
    return sigma;
  }
} // namespace Nodus
