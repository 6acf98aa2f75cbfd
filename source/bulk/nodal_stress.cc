#include "bulk/nodal_stress.h"
#include "bulk/strain.h"
#include "mesh/hanging_nodes.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>

#include <array>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    /// Where the six components of a symmetric tensor live in two vectors of three components per node. The last vector
    /// has the equivalent plastic strain in its first component.
    constexpr unsigned int tensor_row[2][dim]    = {{0, 1, 2}, {1, 0, 0}};
    constexpr unsigned int tensor_column[2][dim] = {{0, 1, 2}, {2, 2, 1}};

    using Tensors = std::array<SymmetricTensor<2, dim>, 3>; // stress, strains in the order of StressAndStrain

    Tensors tensors_of(const SolidAssembler::PointResult &point, const bool with_strains)
    {
      Tensors tensors = {{point.cauchy_stress}};
      if (with_strains)
      {
        tensors[1] = green_lagrange_strain(point.deformation_gradient);
        tensors[2] = logarithmic_strain(point.deformation_gradient);
      }
      return tensors;
    }
  } // namespace

  NodalStress::NodalStress(const DoFHandler<dim> &dof_handler,
                           const SolidAssembler  &solid,
                           const Vector          &u,
                           const bool             with_strains)
      : n_tensors_(with_strains ? 3 : 1)
  {
    const auto        &fe     = dof_handler.get_fe();
    const auto        &scalar = fe.base_element(0);
    const auto        &owned  = dof_handler.locally_owned_dofs();
    const unsigned int n      = scalar.n_dofs_per_cell();
    const QGauss<dim>  quadrature(fe.degree + 1);
    FullMatrix<double> shape(quadrature.size(), n);
    FETools::compute_interpolation_to_quadrature_points_matrix(scalar, quadrature, shape);
    std::vector<std::array<unsigned int, dim>> number(n); // of a node's components in the cell
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int c = 0; c < dim; ++c)
        number[a][c] = fe.component_to_system_index(c, a);
    const bool plastic = solid.has_history();

    const AffineConstraints<double> hanging_nodes = hanging_constraints(dof_handler);

    Vector mass = sums_over_cells(dof_handler, hanging_nodes);
    values_.assign(2 * n_tensors_ + (plastic ? 1 : 0), mass);

    const unsigned int                  n_dofs = fe.n_dofs_per_cell();
    std::vector<DoFIndex>               dofs(n_dofs);
    std::vector<dealii::Vector<double>> cell_values(values_.size());
    dealii::Vector<double>              cell_mass(n_dofs);

    solid.visit(
        u,
        [&](const DoFHandler<dim>::active_cell_iterator &cell, const std::vector<SolidAssembler::PointResult> &points)
        {
          for (auto &v : cell_values)
            v.reinit(n_dofs);
          cell_mass = 0.;
          for (unsigned int q = 0; q < points.size(); ++q)
          {
            const Tensors tensors = tensors_of(points[q], with_strains);
            for (unsigned int a = 0; a < n; ++a)
            {
              const double weight = shape(q, a) * points[q].JxW;
              for (unsigned int c = 0; c < dim; ++c)
              {
                const unsigned int i = number[a][c];
                cell_mass[i] += weight;
                for (unsigned int part = 0; part < 2 * n_tensors_; ++part)
                  cell_values[part][i] +=
                      weight * tensors[part / 2][tensor_row[part % 2][c]][tensor_column[part % 2][c]];
              }
              if (plastic)
                cell_values.back()[number[a][0]] += weight * points[q].equivalent_plastic_strain;
            }
          }
          cell->get_dof_indices(dofs);
          hanging_nodes.distribute_local_to_global(cell_mass, dofs, mass);
          for (unsigned int part = 0; part < values_.size(); ++part)
            hanging_nodes.distribute_local_to_global(cell_values[part], dofs, values_[part]);
        });

    mass.compress(VectorOperation::add);
    for (Vector &values : values_)
    {
      values.compress(VectorOperation::add);
      for (const auto i : owned)
        if (!hanging_nodes.is_constrained(i))
          values(i) /= mass(i);
      hanging_nodes.distribute(values);
      values.update_ghost_values();
    }
  }

  SymmetricTensor<2, dim> NodalStress::tensor(const unsigned int number, const DoFIndex first_dof) const
  {
    SymmetricTensor<2, dim> tensor;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int part = 0; part < 2; ++part)
        tensor[tensor_row[part][c]][tensor_column[part][c]] = values_[2 * number + part](first_dof + c);
    return tensor;
  }

  StressAndStrain NodalStress::at(const DoFIndex first_dof) const
  {
    StressAndStrain values;
    values.cauchy_stress = tensor(0, first_dof);
    if (n_tensors_ > 1)
    {
      values.green_lagrange_strain = tensor(1, first_dof);
      values.logarithmic_strain    = tensor(2, first_dof);
    }
    if (values_.size() > 2 * n_tensors_)
      values.equivalent_plastic_strain = values_.back()(first_dof);
    return values;
  }

  CellStress::CellStress(const DoFHandler<dim> &dof_handler, const SolidAssembler &solid, const Vector &u)
  {
    const unsigned int                    degree = dof_handler.get_fe().degree;
    const FE_DGQArbitraryNodes<dim>       through_points(QGauss<1>(degree + 1)); // shape function q is 1 at point q
    const std::vector<dealii::Point<dim>> nodes = FE_DGQ<dim>(degree).get_unit_support_points(); // lexicographic
    n_nodes_                                    = nodes.size();
    values_.resize(dof_handler.get_triangulation().n_active_cells() * n_nodes_);
    solid.visit(
        u,
        [&](const DoFHandler<dim>::active_cell_iterator &cell, const std::vector<SolidAssembler::PointResult> &points)
        {
          for (unsigned int q = 0; q < points.size(); ++q)
          {
            const Tensors tensors = tensors_of(points[q], true);
            for (unsigned int j = 0; j < n_nodes_; ++j)
            {
              StressAndStrain &values = values_[cell->active_cell_index() * n_nodes_ + j];
              const double     share  = through_points.shape_value(q, nodes[j]);
              values.cauchy_stress += share * tensors[0];
              values.green_lagrange_strain += share * tensors[1];
              values.logarithmic_strain += share * tensors[2];
              values.equivalent_plastic_strain += share * points[q].equivalent_plastic_strain;
            }
          }
        });
  }
} // namespace Nodus
