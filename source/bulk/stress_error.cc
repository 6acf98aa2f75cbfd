#include "bulk/stress_error.h"
#include "base/deal_ii_versions.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/lac/full_matrix.h>

namespace Nodus
{
  void add_stress_error(const double                                  weight,
                        const dealii::DoFHandler<dim>                &dof_handler,
                        const SolidAssembler                         &solid,
                        const std::vector<std::unique_ptr<Material>> &materials,
                        const Vector                                 &u,
                        const NodalStress                            &stress,
                        RefinementIndicator                          &indicator)
  {
    const auto                &fe     = dof_handler.get_fe();
    const auto                &scalar = fe.base_element(0);
    const unsigned int         n      = scalar.n_dofs_per_cell();
    const dealii::QGauss<dim>  quadrature(fe.degree + 1);
    dealii::FullMatrix<double> shape(quadrature.size(), n);
    dealii::FETools::compute_interpolation_to_quadrature_points_matrix(scalar, quadrature, shape);

    std::vector<DoFIndex>                        dofs(fe.n_dofs_per_cell());
    std::vector<dealii::SymmetricTensor<2, dim>> nodal(n);
    double                                       squared_norm = 0.;
    solid.visit(u,
                [&](const auto &cell, const std::vector<SolidAssembler::PointResult> &points)
                {
                  cell->get_dof_indices(dofs);
                  for (unsigned int a = 0; a < n; ++a)
                    nodal[a] = stress.stress(dofs[fe.component_to_system_index(0, a)]);
                  const double E = materials[cell->material_id()]->youngs_modulus();
                  for (unsigned int q = 0; q < points.size(); ++q)
                  {
                    auto difference = points[q].cauchy_stress;
                    squared_norm += difference * difference / E * points[q].JxW;
                    for (unsigned int a = 0; a < n; ++a)
                      difference -= shape(q, a) * nodal[a];
                    indicator.squared_error[cell->active_cell_index()] +=
                        weight * (difference * difference) / E * points[q].JxW;
                  }
                });
    indicator.squared_norm = dealii::Utilities::MPI::sum(squared_norm, communicator_of(dof_handler));
  }
} // namespace Nodus
