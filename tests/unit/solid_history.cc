// States of laws with history in the solid assembler, for both volumetric treatments and degrees: a roll-back is exact,
// a commit keeps the stress, a superimposed rotation turns the forces, and states that are read and written again give
// the same forces on any number of ranks.

#include "base/deal_ii_versions.h"
#include "bulk/solid_assembler.h"

#include "../numbers.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <cmath>
#include <functional>
#include <iostream>

using namespace Nodus;
using dealii::Tensor;
using Treatment = BodyParameters::VolumetricTreatment;

namespace
{
  bool root;

  void check(const std::string &what, const double error, const double tolerance)
  {
    if (!root)
      return;
    std::cout << "  " << what << " (" << tolerance << "): ";
    if (error <= tolerance)
      std::cout << "yes" << std::endl;
    else
      std::cout << "NO, error " << error << std::endl;
  }

  /// Prints @p value, which has to be above @p least.
  void check_above(const std::string &what, const double value, const double least)
  {
    if (root)
      std::cout << "  " << what << ": " << Numbers::number(value) << (value > least ? "" : ": NO") << std::endl;
  }

  /// A plastic body between two elastic ones in the numbering of the cells.
  std::vector<BodyParameters> bodies(const Treatment treatment)
  {
    std::vector<BodyParameters> result(2);
    for (unsigned int b = 0; b < 2; ++b)
    {
      result[b].generator               = "subdivided_hyper_rectangle";
      result[b].generator_arguments     = "3,3,1 : 0,0,0 : 1,1,0.5 : true";
      result[b].translation[2]          = 2. * b;
      result[b].volumetric_treatment    = treatment;
      result[b].material.youngs_modulus = 3.;
    }
    result[1].material.law               = MaterialParameters::Law::j2_plasticity;
    result[1].material.yield_stress      = 0.05;
    result[1].material.hardening_modulus = 0.2;
    return result;
  }

  struct Model
  {
    Model(const unsigned int degree, const Treatment treatment)
        : parameters(bodies(treatment))
        , mesh(parameters, MPI_COMM_WORLD)
        , fe(dealii::FE_Q<dim>(degree), dim)
        , dof_handler(mesh.triangulation())
        , mapping(1)
    {
      dof_handler.distribute_dofs(fe);
      relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
      none     = no_constraints(dof_handler);
      none.close();
      for (const auto &body : parameters)
        materials.push_back(make_material(body.material));
      assembler = make_assembler();
      points    = support_points(mapping, dof_handler);
      u.reinit(dof_handler.locally_owned_dofs(), relevant, MPI_COMM_WORLD);
    }
    std::unique_ptr<SolidAssembler> make_assembler()
    {
      auto result = std::make_unique<SolidAssembler>(
          dof_handler,
          mapping,
          materials,
          loads,
          std::vector<Treatment>{Treatment::standard, parameters[1].volumetric_treatment});
      result->make_sparsity(K);
      return result;
    }

    /// Sets the displacement and assembles; returns the internal forces.
    Vector go(const std::function<Vector3(const Point &)> &displacement)
    {
      Vector owned(dof_handler.locally_owned_dofs(), MPI_COMM_WORLD);
      for (const auto i : dof_handler.locally_owned_dofs())
        owned(i) = displacement(points.at(i))[i % dim];
      owned.compress(dealii::VectorOperation::insert);
      u = owned;
      assembler->tangent(u, 1., none, K, rhs, internal, external);
      return internal;
    }

    std::vector<BodyParameters>            parameters;
    Bodies                                 mesh;
    dealii::FESystem<dim>                  fe;
    dealii::DoFHandler<dim>                dof_handler;
    dealii::MappingQ<dim>                  mapping;
    dealii::IndexSet                       relevant;
    dealii::AffineConstraints<double>      none;
    std::vector<std::unique_ptr<Material>> materials;
    std::vector<BoundaryConditions::Load>  loads;
    BlockCsrMatrix                         K;
    std::unique_ptr<SolidAssembler>        assembler;
    std::map<DoFIndex, Point>              points;
    Vector                                 u, internal, external, rhs;
  };

  Vector3 rest(const Point &)
  {
    return Vector3();
  }
  Vector3 first(const Point &X)
  {
    return Vector3({0.1 * X[0] * X[1], -0.05 * X[1] + 0.05 * X[0] * X[0], 0.1 * X[2] * X[0]});
  }
  Vector3 second(const Point &X)
  {
    return Vector3({0.1 * X[0] * X[1] + 0.1 * X[2], 0.1 * std::sin(2. * X[0]), -0.1 * X[2] * X[1]});
  }
  Vector3 turned(const Point &X)
  {
    const Tensor<2, dim> R({{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.}, {0.48, 0.64, 0.6}});
    return R * (X + second(X)) - X;
  }

  /// Largest difference of two force vectors, relative; the second turned back when asked.
  double difference(const Model &model, const Vector &a, const Vector &b, const bool turn = false)
  {
    const Tensor<2, dim> R({{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.}, {0.48, 0.64, 0.6}});
    double               largest = 0.;
    for (const auto i : model.dof_handler.locally_owned_dofs())
      if (i % dim == 0)
      {
        const Vector3 one({a(i), a(i + 1), a(i + 2)}), other({b(i), b(i + 1), b(i + 2)});
        largest = std::max(largest, (one - (turn ? transpose(R) * other : other)).norm());
      }
    return dealii::Utilities::MPI::max(largest, MPI_COMM_WORLD) / a.linfty_norm();
  }

  double plastic_strain(const Model &model)
  {
    double largest = 0., dissipated = 0.;
    model.assembler->visit(model.u,
                           [&](const auto &, const auto &points)
                           {
                             for (const auto &point : points)
                             {
                               largest = std::max(largest, point.equivalent_plastic_strain);
                               dissipated += point.dissipation * point.JxW;
                             }
                           });
    return dealii::Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }

  void test(const unsigned int degree, const Treatment treatment)
  {
    if (root)
      std::cout << "degree " << degree << (treatment == Treatment::standard ? ", standard" : ", mean dilatation")
                << std::endl;
    Model        model(degree, treatment);
    const Vector once   = model.go(first);
    const double K_once = model.K.norm_squared();
    check_above("largest force", once.linfty_norm(), 0.);
    check("nothing is plastic before a commit", plastic_strain(model), 0.);
    model.assembler->start_from(model.assembler->start());
    check("rolled back, the same forces", difference(model, once, model.go(first)), 0.);
    check("and the same tangent", std::abs(model.K.norm_squared() / K_once - 1.), 0.);
    model.assembler->start_from(model.assembler->start());
    check("at rest no forces", model.go(rest).linfty_norm() / once.linfty_norm(), 1e-14);
    model.go(second);
    check("from elsewhere, the same forces", difference(model, once, model.go(first)), 0.);

    model.assembler->start_from(model.assembler->reached());
    check("committed, the same forces", difference(model, once, model.go(first)), 1e-10);
    check_above("and a stiffer tangent, times that before, squared", model.K.norm_squared() / K_once, 1.);
    check_above("equivalent plastic strain", plastic_strain(model), 0.05);
    model.go(rest);
    check_above("back at rest, forces are left", model.internal.linfty_norm() / once.linfty_norm(), 0.01);

    const Vector on = model.go(second);
    check_above("largest force", on.linfty_norm(), 0.);
    check("turned with the body", difference(model, on, model.go(turned), true), 1e-12);

    const auto history = model.assembler->history();
    model.assembler    = model.make_assembler();
    model.assembler->set_history(history);
    check("states written and read again, the same forces", difference(model, on, model.go(second)), 1e-13);
    const double sum = dealii::Utilities::MPI::sum(double(history.size()), MPI_COMM_WORLD);
    check("one state for each of " + Numbers::plain(sum) + " cells",
          std::abs(sum - model.mesh.triangulation().n_global_active_cells()),
          0.);

    unsigned int refused = 0;
    try
    {
      auto shorter = history;
      if (!shorter.empty())
        shorter.pop_back();
      model.assembler->set_history(shorter);
    }
    catch (const InputError &error)
    {
      refused = 1;
    }
    check("too few states refused on every rank", 1. - dealii::Utilities::MPI::min(refused, MPI_COMM_WORLD), 0.);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  for (const unsigned int degree : {1, 2})
    for (const Treatment treatment : {Treatment::standard, Treatment::mean_dilatation})
      test(degree, treatment);
}
