#include "bulk/viscous_stabilisation.h"
#include "mesh/hanging_nodes.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/la_parallel_vector.h>

namespace Nodus
{
  ViscousStabilisation::ViscousStabilisation(const Bodies                                 &bodies,
                                             const std::vector<std::unique_ptr<Material>> &materials,
                                             const dealii::DoFHandler<dim>                &dof_handler,
                                             const dealii::Mapping<dim>                   &mapping)
  {
    const dealii::IndexSet &owned = dof_handler.locally_owned_dofs();
    std::vector<double>     stiffness; // of a unit of volume
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      const auto   ends = bodies.bounding_box(b).get_boundary_points();
      const double size = ends.first.distance(ends.second);
      stiffness.push_back(materials[b]->youngs_modulus() / (size * size));
    }
    const auto           &fe = dof_handler.get_fe();
    dealii::FEValues<dim> values(
        mapping, fe, dealii::QGauss<dim>(fe.degree + 1), dealii::update_values | dealii::update_JxW_values);
    const dealii::AffineConstraints<double> hanging_nodes = hanging_constraints(dof_handler);
    Vector                                  sum           = sums_over_cells(dof_handler, hanging_nodes);
    std::vector<DoFIndex>                   dofs(fe.n_dofs_per_cell());
    dealii::Vector<double>                  part(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        values.reinit(cell);
        cell->get_dof_indices(dofs);
        part = 0.;
        for (unsigned int i = 0; i < dofs.size(); ++i)
          for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
            part(i) += stiffness[cell->material_id()] * values.shape_value(i, q) * values.JxW(q);
        hanging_nodes.distribute_local_to_global(part, dofs, sum);
      }
    sum.compress(dealii::VectorOperation::add);
    for (const DoFIndex i : owned)
      resistance_.push_back(sum(i));
  }

  void ViscousStabilisation::set_increment(const double viscosity,
                                           const double begin,
                                           const double end,
                                           const double interval_begin,
                                           const double interval_end)
  {
    if (end == begin) // equilibrium on a new mesh: as in the increment before
      return;
    // the last increment ends at the end of the interval up to round-off
    const double rest = (interval_end - end) / (interval_end - interval_begin);
    rate_             = rest < 1e-12 ? 0. : viscosity * rest * (interval_end - interval_begin) / (end - begin);
  }

  void ViscousStabilisation::add(const Vector                            &moved,
                                 const dealii::AffineConstraints<double> &constraints,
                                 BlockCsrMatrix                          &matrix,
                                 Vector                                  &force) const
  {
    if (rate() == 0.)
      return;
    const auto owned = force.locally_owned_elements();
    DoFIndex   n     = 0;
    for (const DoFIndex i : owned)
    {
      const double resistance = rate() * resistance_[n];
      if (!constraints.is_constrained(i))
      {
        force(i) -= resistance * moved(i);
        matrix.add_to_diagonal(n, resistance);
      }
      ++n;
    }
    force.compress(dealii::VectorOperation::add);
  }
} // namespace Nodus
