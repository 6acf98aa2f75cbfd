#ifndef nodus_studies_plain_element_h
#define nodus_studies_plain_element_h

#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_vector.h>
#include <deal.II/physics/elasticity/kinematics.h>

#include <cmath>
#include <vector>

namespace Nodus
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;

  /// A distorted cube under a smooth large deformation.
  struct Problem
  {
    Problem(const unsigned int degree, const unsigned int n)
        : fe(dealii::FE_Q<dim>(degree), dim)
    {
      dealii::GridGenerator::subdivided_hyper_cube(triangulation, n);
      dealii::GridTools::distort_random(0.15, triangulation);
      dof_handler.reinit(triangulation);
      dof_handler.distribute_dofs(fe);
      u.reinit(dealii::complete_index_set(dof_handler.n_dofs()), MPI_COMM_WORLD);
      plain_u.reinit(dof_handler.n_dofs());
      std::vector<Point> points(dof_handler.n_dofs());
      dealii::DoFTools::map_dofs_to_support_points(mapping, dof_handler, points);
      std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
      for (const auto &cell : dof_handler.active_cell_iterators())
      {
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < dofs.size(); ++i)
        {
          const Point       &X = points[dofs[i]];
          const unsigned int c = fe.system_to_component_index(i).first;
          plain_u(dofs[i])     = 0.1 * std::sin(2. * X[(c + 1) % dim] + c) + 0.1 * X[c] * X[(c + 2) % dim];
          u(dofs[i])           = plain_u(dofs[i]);
        }
      }
      constraints.close();
    }

    dealii::MappingQ1<dim>            mapping;
    dealii::Triangulation<dim>        triangulation;
    dealii::FESystem<dim>             fe;
    dealii::DoFHandler<dim>           dof_handler;
    dealii::Vector<double>            plain_u;
    Vector                            u;
    dealii::AffineConstraints<double> constraints;
  };

  /// What one writes with the tools of deal.II, along the lines of step-44: neo-Hookean law on the current
  /// configuration, shape gradients hoisted out of the loops, the lower half of the symmetric tangent.
  class Plain
  {
  public:
    Plain(const Problem &problem, const MaterialParameters &parameters)
        : problem_(problem)
        , lambda_(parameters.youngs_modulus * parameters.poissons_ratio /
                  ((1. + parameters.poissons_ratio) * (1. - 2. * parameters.poissons_ratio)))
        , mu_(parameters.youngs_modulus / (2. * (1. + parameters.poissons_ratio)))
        , values_(problem.mapping,
                  problem.fe,
                  dealii::QGauss<dim>(problem.fe.degree + 1),
                  dealii::update_gradients | dealii::update_JxW_values)
        , n_(problem.fe.n_dofs_per_cell())
        , gradients_u_(values_.n_quadrature_points)
        , gradient_(n_)
        , symmetric_gradient_(n_)
        , matrix(n_, n_)
        , force(n_)
    {
    }

    void cell(const dealii::DoFHandler<dim>::active_cell_iterator &cell)
    {
      const dealii::FEValuesExtractors::Vector displacement(0);
      matrix = 0.;
      force  = 0.;
      values_.reinit(cell);
      values_[displacement].get_function_gradients(problem_.plain_u, gradients_u_);
      for (unsigned int q = 0; q < gradients_u_.size(); ++q)
      {
        const Tensor<2, dim>          F         = dealii::Physics::Elasticity::Kinematics::F(gradients_u_[q]);
        const Tensor<2, dim>          F_inverse = invert(F);
        const double                  log_J = std::log(determinant(F)), JxW = values_.JxW(q);
        const auto                    b   = dealii::Physics::Elasticity::Kinematics::b(F);
        const auto                    I   = dealii::unit_symmetric_tensor<dim>();
        const SymmetricTensor<2, dim> tau = mu_ * (b - I) + lambda_ * log_J * I;
        const Tensor<2, dim>          tau_full(tau);
        const SymmetricTensor<4, dim> Jc =
            lambda_ * outer_product(I, I) + 2. * (mu_ - lambda_ * log_J) * dealii::identity_tensor<dim>();
        for (unsigned int i = 0; i < n_; ++i)
        {
          gradient_[i]           = values_[displacement].gradient(i, q) * F_inverse;
          symmetric_gradient_[i] = symmetrize(gradient_[i]);
        }
        for (unsigned int i = 0; i < n_; ++i)
        {
          const unsigned int            component = problem_.fe.system_to_component_index(i).first;
          const SymmetricTensor<2, dim> stress    = symmetric_gradient_[i] * Jc;
          const Tensor<1, dim>          geometric = gradient_[i][component] * tau_full;
          force(i) += (symmetric_gradient_[i] * tau) * JxW;
          for (unsigned int j = 0; j <= i; ++j)
          {
            matrix(i, j) += (stress * symmetric_gradient_[j]) * JxW;
            if (component == problem_.fe.system_to_component_index(j).first)
              matrix(i, j) += (geometric * gradient_[j][component]) * JxW;
          }
        }
      }
      for (unsigned int i = 0; i < n_; ++i)
        for (unsigned int j = i + 1; j < n_; ++j)
          matrix(i, j) = matrix(j, i);
    }

  private:
    const Problem                       &problem_;
    const double                         lambda_, mu_;
    dealii::FEValues<dim>                values_;
    unsigned int                         n_;
    std::vector<Tensor<2, dim>>          gradients_u_, gradient_;
    std::vector<SymmetricTensor<2, dim>> symmetric_gradient_;

  public:
    dealii::FullMatrix<double> matrix;
    dealii::Vector<double>     force;
  };
} // namespace Nodus

#endif
