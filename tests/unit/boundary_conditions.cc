// Boundary conditions: which nodes are held, values in time, agreement and conflict of conditions, hanging nodes,
// reactions of a uniaxial test, and the messages for wrong input.

#include "base/deal_ii_versions.h"
#include "bulk/solid_assembler.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <sstream>

using namespace Nodus;
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

  BodyParameters box()
  {
    BodyParameters body;
    body.name                    = "block";
    body.generator               = "subdivided_hyper_rectangle";
    body.generator_arguments     = "2,2,2 : 0,0,0 : 2,2,2 : true";
    body.material.law            = MaterialParameters::Law::linear_elastic;
    body.material.youngs_modulus = 5.;
    return body;
  }

  BoundaryConditionParameters condition(const std::string                             &name,
                                        const Type                                     type,
                                        const std::vector<dealii::types::boundary_id> &ids,
                                        const std::string                             &where,
                                        const std::vector<unsigned int>               &components,
                                        const std::vector<std::string>                &value)
  {
    BoundaryConditionParameters result;
    result.name                = name;
    result.type                = type;
    result.region.boundary_ids = ids;
    result.region.where        = where;
    result.components          = components;
    result.value               = value;
    return result;
  }

  BoundaryConditionParameters hold(const std::string                             &name,
                                   const std::vector<dealii::types::boundary_id> &ids,
                                   const std::string                             &where,
                                   const std::vector<unsigned int>               &components,
                                   const std::vector<std::string>                &value)
  {
    return condition(name, Type::displacement, ids, where, components, value);
  }

  struct Model
  {
    explicit Model(const unsigned int degree)
        : bodies({box()}, communicator)
        , fe(dealii::FE_Q<dim>(degree), dim)
        , dof_handler(bodies.triangulation())
        , mapping(1)
    {
      dof_handler.distribute_dofs(fe);
      relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
      u.reinit(dof_handler.locally_owned_dofs(), relevant, communicator);
      u.update_ghost_values();
      points = support_points(mapping, dof_handler);
    }

    BoundaryConditions conditions(const std::vector<BoundaryConditionParameters> &parameters)
    {
      return BoundaryConditions(parameters, bodies, dof_handler, mapping, {4.});
    }

    /// Number of prescribed dofs and the sum of their values, of each reaction region and component.
    void report(BoundaryConditions &boundary_conditions)
    {
      const auto &constraints = boundary_conditions.increment_constraints(u);
      for (const auto &region : boundary_conditions.reaction_regions())
      {
        std::string line = "  " + region.name + ":";
        for (unsigned int c = 0; c < dim; ++c)
        {
          double sum = 0.;
          for (const auto dof : region.dofs[c])
            sum += constraints.get_inhomogeneity(dof);
          line += " " + number(dealii::Utilities::MPI::sum(region.dofs[c].size(), communicator)) + " (sum " +
                  number(dealii::Utilities::MPI::sum(sum, communicator)) + ")";
        }
        print(line);
      }
    }

    Bodies                    bodies;
    dealii::FESystem<dim>     fe;
    dealii::DoFHandler<dim>   dof_handler;
    dealii::MappingQ<dim>     mapping;
    dealii::IndexSet          relevant;
    Vector                    u;
    std::map<DoFIndex, Point> points;
  };

  void regions(const unsigned int degree)
  {
    print("degree " + std::to_string(degree) + ": face, line of free nodes, node at t = 0, 1, 3; u = 0.5 afterwards");
    Model model(degree);
    auto  boundary_conditions = model.conditions({hold("", {4}, "", {0, 1, 2}, {"0", "0", "0"}),
                                                  hold("line", {5}, "abs(x-1) < 1e-6", {2}, {"-0.1*t*y"}),
                                                  hold("node", {0, 5}, "x+y < 1e-6 && z > 1.9", {0, 1}, {"t*pi", "t-1"}),
                                                  // shares its edge with the first one, which keeps it
                                                  hold("side", {1}, "", {0}, {"0"})});
    for (const double t : {0., 1., 3.})
    {
      boundary_conditions.set_time(t);
      model.report(boundary_conditions);
    }
    Vector half(model.dof_handler.locally_owned_dofs(), communicator);
    half    = 0.5;
    model.u = half;
    model.report(boundary_conditions);

    // ghosts know what their owner prescribes
    const auto                   &lines = boundary_conditions.increment_constraints(model.u);
    std::vector<dealii::IndexSet> owned =
        dealii::Utilities::MPI::all_gather(communicator, model.dof_handler.locally_owned_dofs());
    const dealii::IndexSet active = dealii::DoFTools::extract_locally_active_dofs(model.dof_handler);
    print(std::string("  consistent in parallel: ") +
          (lines.is_consistent_in_parallel(owned, active, communicator) ? "yes" : "NO"));
    print(std::string("  closed, homogeneous lines are homogeneous: ") +
          (boundary_conditions.homogeneous_constraints().has_inhomogeneities() ? "NO" : "yes"));
  }

  struct Operator
  {
    const BlockCsrMatrix &matrix;
    void                  vmult(Vector &y, const Vector &x) const
    {
      matrix.vmult(y.begin(), x.begin());
    }
  };

  /// Two Newton corrections from a wrong start: the second one has nothing left to do.
  void uniaxial(const unsigned int degree)
  {
    print("uniaxial test, degree " + std::to_string(degree));
    Model                                  model(degree);
    auto                                   boundary_conditions = model.conditions({hold("x = 0", {0}, "", {0}, {"0"}),
                                                                                   hold("y = 0", {2}, "", {1}, {"0"}),
                                                                                   hold("z = 0", {4}, "", {2}, {"0"}),
                                                                                   hold("pull", {1}, "", {0}, {"0.1*t"})});
    std::vector<std::unique_ptr<Material>> materials;
    materials.push_back(make_material(box().material));
    const SolidAssembler assembler(model.dof_handler, model.mapping, materials, boundary_conditions.loads());
    BlockCsrMatrix       K;
    Vector               rhs, internal, external;
    assembler.make_sparsity(K);

    boundary_conditions.set_time(2.);
    Vector u(model.dof_handler.locally_owned_dofs(), communicator);
    for (unsigned int iteration = 0; iteration < 2; ++iteration)
    {
      const auto &constraints = boundary_conditions.increment_constraints(model.u);
      assembler.tangent(model.u, 2., constraints, K, rhs, internal, external);
      Vector                   correction(u);
      dealii::SolverControl    control(1000, 1e-12);
      dealii::SolverCG<Vector> solver(control);
      correction = 0.;
      solver.solve(Operator{K}, correction, rhs, dealii::PreconditionIdentity());
      constraints.distribute(correction);
      u += correction;
      model.u = u;
      print("  correction: " + number(correction.linfty_norm()));
    }
    assembler.forces(model.u, 2., internal, external);

    double error = 0.;
    for (unsigned int c = 0; c < dim; ++c)
      for (const auto dof : dealii::DoFTools::extract_dofs(
               model.dof_handler, model.fe.component_mask(dealii::FEValuesExtractors::Scalar(c))))
        error = std::max(error, std::abs(u(dof) - (c == 0 ? 0.1 : -0.03) * model.points.at(dof)[c]));
    error = dealii::Utilities::MPI::max(error, communicator);
    print(std::string("  exact displacement (1e-9): ") + (error < 1e-9 ? "yes" : "NO, error " + std::to_string(error)));
    for (const auto &region : boundary_conditions.reaction_regions())
    {
      double reaction = 0.;
      for (const auto &dofs : region.dofs)
        for (const auto dof : dofs)
          reaction += internal(dof);
      print("  reaction " + region.name + ": " + number(dealii::Utilities::MPI::sum(reaction, communicator)));
    }
  }

  void messages()
  {
    Model      model(1);
    const auto attempt = [&](const std::vector<BoundaryConditionParameters> &parameters)
    {
      std::string message = "accepted";
      try
      {
        model.conditions(parameters);
      }
      catch (const InputError &error)
      {
        message = error.what();
      }
      // every rank must say the same, or the next collective call hangs
      for (const auto &other : dealii::Utilities::MPI::all_gather(communicator, message))
        if (other != message)
          message += " BUT ANOTHER RANK SAYS " + other;
      print("  " + message);
    };
    const std::vector<std::string> zero = {"0"};

    print("wrong input");
    attempt({hold("drive", {0}, "", {0}, {"2*x+"})});
    attempt({hold("", {0}, "", {0}, {"u"})});
    attempt({hold("drive", {0}, "", {0, 1}, zero)});
    attempt({condition("press", Type::pressure, {0}, "", {}, {"1", "2"})});
    attempt({hold("first", {0}, "", {0}, zero), hold("drive", {3, 4}, "x > 5", {0}, zero)});
    attempt({condition("pull", Type::traction, {3}, "x > 5", {0}, {"1"})});
    attempt({condition("weight", Type::body_force, {}, "x > 5", {2}, {"-9.81"})});
    attempt({hold("drive", {17}, "", {0}, zero)});
    attempt({hold("drive", {0}, "y+z < 1e-6", {1}, {"sqrt(-1-y)"})});

    print("two conditions for the node at the origin");
    const std::string origin = "x+y+z < 1e-6";
    attempt({hold("one", {0}, origin, {0, 2}, {"0", "0.1*t"}), hold("two", {4}, origin, {2}, {"t/10"})});
    attempt({hold("one", {0}, origin, {0, 2}, {"0", "0.1*t"}), hold("two", {4}, origin, {2}, {"0.1"})});
    // equal at the start and the end, not in the middle
    attempt({hold("one", {0}, origin, {1}, {"t*(t-4)"}), hold("two", {4}, origin, {1}, zero)});
    attempt({hold("one", {0}, origin, {1}, zero), hold("", {4}, origin, {1}, {"x"})});

    print("boundary ids do not matter to a body force");
    attempt({condition("weight", Type::body_force, {17}, "", {2}, {"-9.81"})});
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  root = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  regions(1);
  regions(2);
  uniaxial(1);
  uniaxial(2);
  messages();
}
