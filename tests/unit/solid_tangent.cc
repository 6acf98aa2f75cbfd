// Solid assembler: the tangent is the derivative of the forces for each law, volumetric treatment, degree and load;
// forces of rigid motions, homogeneous deformations and loads are the exact ones; an inverted element fails on every
// rank and leaves no trace.

#include "base/deal_ii_versions.h"
#include "bulk/solid_assembler.h"
#include "solve/linear_system.h"

#include "../numbers.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <sstream>

using namespace Nodus;
using dealii::FullMatrix;
using dealii::Tensor;
using Law  = MaterialParameters::Law;
using Type = BoundaryConditionParameters::Type;

namespace
{
  const MPI_Comm communicator = MPI_COMM_WORLD;
  bool           root;

  void print(const std::string &line)
  {
    if (root)
      std::cout << line << std::endl;
  }

  std::string number(const double value)
  {
    std::ostringstream text;
    text.precision(5);
    text << (std::abs(value) < 1e-10 ? 0. : value);
    return text.str();
  }

  void check(const std::string &what, const double error, const double tolerance)
  {
    std::ostringstream text;
    text << "  " << what << " (" << tolerance << "): ";
    if (error < tolerance)
      text << "yes";
    else
      text << "NO, error " << error;
    print(text.str());
  }

  using Treatment = BodyParameters::VolumetricTreatment;

  BodyParameters body(const std::string &generator, const std::string &arguments, const Law law)
  {
    BodyParameters body;
    body.generator                    = generator;
    body.generator_arguments          = arguments;
    body.material.law                 = law;
    body.material.youngs_modulus      = 3.;
    body.material.mooney_rivlin_ratio = 0.4;
    if (law == Law::ogden)
    {
      body.material.youngs_modulus  = 0.;
      body.material.ogden_exponents = {1.8, -2.};
      body.material.ogden_moduli    = {1., -0.2};
    }
    if (law == Law::j2_plasticity)
    {
      body.material.yield_stress      = 0.3;
      body.material.hardening_modulus = 0.2;
    }
    return body;
  }
  BodyParameters ball(const Law law)
  {
    return body("quarter_hyper_ball", "0,0,0 : 1", law);
  }
  BodyParameters box(const Law law)
  {
    return body("subdivided_hyper_rectangle", "2,1,1 : 0,0,0 : 1,1,1 : true", law);
  }

  BoundaryConditionParameters load(const Type                                     type,
                                   const std::vector<dealii::types::boundary_id> &ids,
                                   const std::vector<unsigned int>               &components,
                                   const std::vector<std::string>                &value)
  {
    BoundaryConditionParameters result;
    result.type                = type;
    result.region.boundary_ids = ids;
    result.components          = components;
    result.value               = value;
    return result;
  }

  struct Model
  {
    Model(const BodyParameters                           &parameters,
          const unsigned int                              degree,
          const std::vector<BoundaryConditionParameters> &conditions = {})
        : bodies({parameters}, communicator)
        , fe(dealii::FE_Q<dim>(degree), dim)
        , dof_handler(bodies.triangulation())
        , mapping(1)
    {
      dof_handler.distribute_dofs(fe);
      relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
      none     = no_constraints(dof_handler);
      none.close();
      boundary_conditions =
          std::make_unique<BoundaryConditions>(conditions, bodies, dof_handler, mapping, std::vector<double>{2.});
      materials.push_back(make_material(parameters.material));
      assembler = std::make_unique<SolidAssembler>(dof_handler,
                                                   mapping,
                                                   materials,
                                                   boundary_conditions->loads(),
                                                   std::vector<Treatment>{parameters.volumetric_treatment});
      assembler->make_sparsity(K);
      layout.communicator = communicator;
      layout.owned[0]     = dof_handler.locally_owned_dofs();
      layout.n_u          = dof_handler.n_dofs();
      system.layout       = &layout;
      layout.reinit(system.rhs);
      u.reinit(dof_handler.locally_owned_dofs(), relevant, communicator);
      points = support_points(mapping, dof_handler);
    }

    /// Interpolates a displacement.
    void set(const std::function<Vector3(const Point &)> &displacement)
    {
      Vector owned(dof_handler.locally_owned_dofs(), communicator);
      for_owned([&](const DoFIndex dof, const Point &X, const unsigned int component)
                { owned(dof) = displacement(X)[component]; });
      owned.compress(dealii::VectorOperation::insert);
      u = owned;
    }
    /// Displacement @p base with a change of one degree of freedom.
    void set(const Vector &base, const DoFIndex dof, const double change)
    {
      Vector owned(base);
      if (owned.in_local_range(dof))
        owned(dof) += change;
      owned.compress(dealii::VectorOperation::add);
      u = owned;
    }
    void forces()
    {
      assembler->forces(u, time, internal, external);
    }
    void tangent()
    {
      assembler->tangent(u, time, none, K, rhs, internal, external);
    }
    void for_owned(const std::function<void(DoFIndex, const Point &, unsigned int)> &action) const
    {
      for (unsigned int component = 0; component < dim; ++component)
        for (const auto dof : dealii::DoFTools::extract_dofs(dof_handler, mask(component)))
          action(dof, points.at(dof), component);
    }
    dealii::ComponentMask mask(const unsigned int component) const
    {
      return fe.component_mask(dealii::FEValuesExtractors::Scalar(component));
    }
    Vector3 sum(const Vector &v, const std::function<bool(const Point &)> &where) const
    {
      Vector3 result;
      for_owned([&](const DoFIndex dof, const Point &X, const unsigned int component)
                { result[component] += where(X) ? v(dof) : 0.; });
      return dealii::Utilities::MPI::sum(result, communicator);
    }

    Bodies                                 bodies;
    dealii::FESystem<dim>                  fe;
    dealii::DoFHandler<dim>                dof_handler;
    dealii::MappingQ<dim>                  mapping;
    dealii::IndexSet                       relevant;
    dealii::AffineConstraints<double>      none;
    std::unique_ptr<BoundaryConditions>    boundary_conditions;
    std::vector<std::unique_ptr<Material>> materials;
    std::unique_ptr<SolidAssembler>        assembler;
    std::map<DoFIndex, Point>              points;
    BlockLayout                            layout{};
    LinearSystem                           system;
    BlockCsrMatrix                        &K = system.bulk;
    Vector                                 u, internal, external, rhs;
    double                                 time = 1.;
  };

  bool everywhere(const Point &)
  {
    return true;
  }

  Vector3 wavy(const Point &X)
  {
    return Vector3(
        {0.15 * std::sin(2. * X[0] + X[1]), 0.2 * X[0] * X[1] - 0.1 * X[2], 0.1 * std::cos(3. * X[2]) - 0.2 * X[0]});
  }

  /// Entries gathered on every rank.
  FullMatrix<double> dense(const Model &model)
  {
    FullMatrix<double> result(model.dof_handler.n_dofs(), model.dof_handler.n_dofs());
    const NodeMap     &nodes = model.K.map();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      model.K.for_row(i,
                      [&](const unsigned int j, const double *block, const bool transposed)
                      {
                        for (unsigned int c = 0; c < dim; ++c)
                          for (unsigned int d = 0; d < dim; ++d)
                            result(dim * nodes.global(i) + c, dim * nodes.global(j) + d) =
                                block[transposed ? dim * d + c : dim * c + d];
                      });
    dealii::Utilities::MPI::sum(result, communicator, result);
    return result;
  }

  /// d(internal - external)/du by central differences.
  FullMatrix<double> difference_quotient(Model &model)
  {
    const double       h = 1e-5;
    FullMatrix<double> result(model.dof_handler.n_dofs(), model.dof_handler.n_dofs());
    Vector             base(model.dof_handler.locally_owned_dofs(), communicator);
    base = model.u;
    base.zero_out_ghost_values(); // or nothing could be added to a copy
    for (DoFIndex column = 0; column < model.dof_handler.n_dofs(); ++column)
      for (const double sign : {1., -1.})
      {
        model.set(base, column, sign * h);
        model.forces();
        for (const auto row : model.dof_handler.locally_owned_dofs())
          result(row, column) += sign * (model.internal(row) - model.external(row)) / (2. * h);
      }
    dealii::Utilities::MPI::sum(result, communicator, result);
    return result;
  }

  /// The part that Loads::add_variation() adds under @p constraints, and its right-hand side, on every rank.
  FullMatrix<double>
  variation(Model &model, const dealii::AffineConstraints<double> &constraints, std::vector<double> &rhs)
  {
    const DoFIndex     n = model.dof_handler.n_dofs();
    FullMatrix<double> result(n, n);
    model.system.variation.clear();
    model.system.rhs       = 0.;
    model.system.symmetric = true;
    model.assembler->add_variation(model.u, constraints, model.system);
    for (std::size_t k = 0; k < model.system.variation.value.size(); ++k)
      result(model.system.variation.row[k], model.system.variation.column[k]) += model.system.variation.value[k];
    dealii::Utilities::MPI::sum(result, communicator, result);
    rhs.assign(n, 0.);
    for (const auto i : model.dof_handler.locally_owned_dofs())
      rhs[i] = model.system.rhs.block(0)(i);
    dealii::Utilities::MPI::sum(rhs, communicator, rhs);
    return result;
  }

  void compare_tangent(Model &model, const bool is_symmetric = true)
  {
    model.set(wavy);
    model.tangent();
    auto                K        = dense(model);
    const auto          expected = difference_quotient(model);
    std::vector<double> rhs;
    model.set(wavy);
    K.add(1., variation(model, model.none, rhs));
    double error = 0., asymmetry = 0.;
    for (unsigned int i = 0; i < K.m(); ++i)
      for (unsigned int j = 0; j < K.m(); ++j)
      {
        error     = std::max(error, std::abs(K(i, j) - expected(i, j)));
        asymmetry = std::max(asymmetry, std::abs(K(i, j) - K(j, i)));
      }
    check("tangent = difference quotient, largest row sum " + Numbers::number(K.linfty_norm()),
          error / K.linfty_norm(),
          1e-8);
    if (is_symmetric)
      check("tangent symmetric", asymmetry / K.linfty_norm(), 1e-13);
    print(std::string("  said to be ") + (model.system.symmetric ? "symmetric" : "unsymmetric"));
  }

  /// Where a displacement is prescribed, its column goes to the right-hand side, and its row is empty.
  void compare_prescribed(Model &model)
  {
    const double given = 0.01;
    model.set(wavy);
    model.tangent();
    std::vector<double>      rhs;
    const FullMatrix<double> all     = variation(model, model.none, rhs);
    DoFIndex                 dof     = 0; // whose column is the largest
    double                   largest = 0.;
    for (DoFIndex j = 0; j < all.n(); ++j)
      for (DoFIndex i = 0; i < all.m(); ++i)
        if (i != j && std::abs(all(i, j)) > largest)
        {
          largest = std::abs(all(i, j));
          dof     = j;
        }
    dealii::AffineConstraints<double> constraints(model.relevant);
    if (model.relevant.is_element(dof))
    {
      constraints.add_line(dof);
      constraints.set_inhomogeneity(dof, given);
    }
    constraints.close();
    const FullMatrix<double> rest  = variation(model, constraints, rhs);
    double                   error = 0., left = 0.;
    for (DoFIndex i = 0; i < all.m(); ++i)
    {
      error = std::max(error, std::abs(rhs[i] + (i == dof ? 0. : given * all(i, dof))));
      for (DoFIndex j = 0; j < all.n(); ++j)
        left = std::max(left, std::abs(rest(i, j) - (i == dof || j == dof ? 0. : all(i, j))));
    }
    check("its prescribed column is on the right-hand side", error / (given * largest), 1e-12);
    check("its other columns as before, prescribed row and column empty", left / largest, 1e-12);
  }

  /// Rotation by 50 degrees about (1, 2, 2)/3.
  Tensor<2, dim> rotation()
  {
    const double   angle = 50. * dealii::numbers::PI / 180.;
    const Vector3  a({1. / 3., 2. / 3., 2. / 3.});
    Tensor<2, dim> result;
    for (unsigned int i = 0; i < dim; ++i)
    {
      const unsigned int j = (i + 1) % dim, k = (i + 2) % dim;
      result[i][i] = std::cos(angle);
      result[i][j] -= std::sin(angle) * a[k];
      result[i][k] += std::sin(angle) * a[j];
    }
    return result + (1. - std::cos(angle)) * outer_product(a, a);
  }

  std::string numbers(const Vector3 &v)
  {
    return number(v[0]) + " " + number(v[1]) + " " + number(v[2]);
  }

  void laws(const unsigned int degree, const Treatment treatment)
  {
    const auto treated = [treatment](BodyParameters body)
    {
      body.volumetric_treatment = treatment;
      return body;
    };
    const std::pair<const char *, Law> all[] = {{"linear elastic", Law::linear_elastic},
                                                {"St Venant-Kirchhoff", Law::st_venant_kirchhoff},
                                                {"neo-Hookean", Law::neo_hookean},
                                                {"Mooney-Rivlin", Law::mooney_rivlin},
                                                {"Ogden", Law::ogden},
                                                {"J2 plasticity", Law::j2_plasticity}};
    for (const auto &[name, law] : all)
    {
      print("degree " + std::to_string(degree) + (treatment == Treatment::standard ? ", " : ", mean dilatation, ") +
            name);
      Model model(treated(ball(law)), degree);
      compare_tangent(model);
      if (law != Law::linear_elastic)
      {
        model.set([](const Point &X) { return rotation() * X - X + Vector3({0.3, -0.1, 2.}); });
        model.forces();
        check("no forces from a rigid motion", model.internal.linfty_norm(), 1e-12);
      }

      // the nodes at x = 1 carry the first column of P
      Tensor<2, dim> F({{1.2, 0.3, 0.}, {0.1, 0.8, 0.2}, {0., -0.1, 1.1}});
      Model          cube(treated(box(law)), degree);
      cube.set([&](const Point &X) { return F * X - X; });
      cube.forces();
      dealii::SymmetricTensor<2, dim> S;
      cube.materials[0]->evaluate(F, S, nullptr);
      const Tensor<2, dim> P = law == Law::linear_elastic ? Tensor<2, dim>(S) : F * Tensor<2, dim>(S);
      print("  force on the face x = 1: " +
            numbers(cube.sum(cube.internal, [](const Point &X) { return X[0] > 0.999; })));
      print("  expected                : " + numbers(Vector3({P[0][0], P[1][0], P[2][0]})));
    }
  }

  void loads(const unsigned int degree)
  {
    const std::string title = "degree " + std::to_string(degree) + ", ";
    const auto        law   = Law::neo_hookean;
    {
      print(title + "uniform pressure on a closed surface");
      Model model(ball(law), degree, {load(Type::pressure, {0, 1}, {}, {"0.7*t"})});
      compare_tangent(model);
      model.forces();
      check("no resultant", model.sum(model.external, everywhere).norm(), 1e-12);
    }
    {
      print(title + "pressure on an open patch");
      Model model(ball(law), degree, {load(Type::pressure, {0}, {}, {"1+x-0.5*y"})});
      compare_tangent(model, false);
      compare_prescribed(model);
    }
    {
      print(title + "pressure on the face x = 1, its turned and stretched area: resultant, expected");
      Model                model(box(law), degree, {load(Type::pressure, {1}, {}, {"2*t"})});
      const Tensor<2, dim> F = rotation() * Tensor<2, dim>({{1.2, 0., 0.}, {0., 1.5, 0.}, {0., 0., 0.5}});
      model.set([&](const Point &X) { return F * X - X; });
      model.forces();
      print("  " + numbers(model.sum(model.external, everywhere)));
      print("  " + numbers(-2. * 0.75 * (rotation() * Vector3({1., 0., 0.}))));
    }
    {
      print(title + "pressure on a linear elastic body: resultant, expected");
      Model model(box(Law::linear_elastic), degree, {load(Type::pressure, {1}, {}, {"2*t"})});
      compare_tangent(model);
      print("  " + numbers(model.sum(model.external, everywhere)));
      print("  -2 0 0");
    }
    {
      print(title + "springs, half of the face y = 1: resultant, expected");
      auto springs         = load(Type::spring, {3}, {1, 2}, {"2*x", "3*t"});
      springs.region.where = "x < 0.5";
      Model model(box(law), degree, {springs});
      compare_tangent(model);
      model.set([](const Point &) { return Vector3({0.1, 0.2, -0.4}); });
      model.forces();
      print("  " + numbers(model.sum(model.internal, everywhere)));
      print("  0 0.05 -0.6");
    }
    {
      print(title + "traction and body force: resultant at t = 1, t = 2, expected");
      Model model(box(law),
                  degree,
                  {load(Type::traction, {5}, {0, 2}, {"6*t*x^2", "y"}), load(Type::body_force, {}, {2}, {"-4*t*z"})});
      compare_tangent(model);
      print("  " + numbers(model.sum(model.external, everywhere)));
      model.time = 2.;
      model.forces();
      print("  " + numbers(model.sum(model.external, everywhere)));
      print("  2 0 -1.5");
      print("  4 0 -3.5");
    }
  }

  void inversion()
  {
    print("inverted element");
    Model model(box(Law::neo_hookean), 1);
    model.set(wavy);
    model.tangent();
    const double norm = std::sqrt(model.K.norm_squared());
    Vector       internal(model.internal);
    model.set([](const Point &X) { return X.distance(Point(1., 1., 1.)) < 1e-6 ? Vector3({-2., 0., 0.}) : Vector3(); });
    unsigned int failures = 0;
    std::string  message;
    for (const bool with_tangent : {true, false})
      try
      {
        with_tangent ? model.tangent() : model.forces();
      }
      catch (const SolverFailure &failure)
      {
        ++failures;
        message = failure.what();
      }
    failures = dealii::Utilities::MPI::sum(failures, communicator);
    print("  " + message);
    print("  failures for each rank: " +
          std::to_string(failures / dealii::Utilities::MPI::n_mpi_processes(communicator)));
    model.set(wavy);
    model.tangent();
    internal -= model.internal;
    check("afterwards the same tangent", std::abs(std::sqrt(model.K.norm_squared()) / norm - 1.), 1e-13);
    check("afterwards the same forces", internal.linfty_norm(), 1e-13);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  root = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  for (const unsigned int degree : {1, 2})
  {
    laws(degree, Treatment::standard);
    laws(degree, Treatment::mean_dilatation);
    loads(degree);
  }
  inversion();
}
