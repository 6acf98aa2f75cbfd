// Conditions whose values come from tables: a unit cube, E = 200, nu = 0, pulled and pressed along x as the tables say:
// stress E u or the traction itself; and the table within expressions.

#include "../cases.h"

#include "bulk/condition_value.h"
#include "parameters/table_file.h"

#include <deal.II/base/mpi.h>

#include <fstream>

using namespace Cases;

namespace
{
  using Type = BoundaryConditionParameters::Type;

  constexpr double E = 200.;

  void run(const std::string &name, const BoundaryConditionParameters &driven, const std::vector<double> &displacements)
  {
    Parameters p;
    p.bodies                = {box("cube", "2,1,1", {0, 0, 0}, {1, 1, 1}, E, 0.)};
    p.boundary_conditions   = {hold("x", region(1, {x_minus}), {0}),
                               hold("y", region(1, {y_minus}), {1}),
                               hold("z", region(1, {z_minus}), {2}),
                               driven};
    p.load_stepping         = {{4.}, {8}};
    p.output.results_folder = "tables_" + name;
    p.output.write_vtu      = false;
    ContactProblem problem(p, world(), log());
    problem.on_increment(
        [&](const unsigned int increment, const double t)
        {
          std::ostringstream what;
          what << name << ", t = " << t << ": displacement";
          const double u = displacements[increment - 1];
          check(what.str(), problem.displacement(1, {1, 0, 0})[0], u, 1e-9, 0.1);
          check("  reaction", problem.reactions()[0].second[0], -E * u, 1e-9, 0.1 * E);
        });
    problem.run();
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  auto driven         = drive("pull", region(1, {x_plus}), 0, "table");
  driven.table_times  = {1., 2., 3.5};
  driven.table_values = {0., 0.1, -0.05};
  run("displacement", driven, {0., 0., 0.05, 0.1, 0.05, 0., -0.05, -0.05});

  if (root())
    std::ofstream("tables_history.csv") << "time, load\n# in words\n0, 0\n2;20\n\n 4 -10\r\n";
  MPI_Barrier(world());
  driven            = condition("traction", Type::traction, region(1, {x_plus}), {0}, {"0.5*table"});
  driven.table_file = "tables_history.csv";
  report("the file", read_table(driven).empty() ? "is read" : "NO");
  run("traction", driven, {0.0125, 0.025, 0.0375, 0.05, 0.03125, 0.0125, -0.00625, -0.025});
  driven.type       = Type::pressure;
  driven.components = {};
  run("pressure", driven, {-0.0125, -0.025, -0.0375, -0.05, -0.03125, -0.0125, 0.00625, 0.025});

  driven              = condition("expressions", Type::displacement, region(1, {x_plus}), {0, 1}, {"", ""});
  driven.value        = {"table^2*x - t*y", "if(table > 0.5, 1, z)"};
  driven.table_times  = {0., 1., 3.};
  driven.table_values = {-1., 1., 0.};
  const auto  value   = make_condition_value(driven, "condition");
  const Point X(2, 3, 5);
  for (const auto &[t, table] : {std::make_pair(-1., -1.), {0., -1.}, {0.25, -0.5}, {1., 1.}, {2., 0.5}, {7., 0.}})
  {
    value->set_time(t);
    std::ostringstream what;
    what << "table " << table << " at t = " << t;
    check(what.str(), value->value(X, 0), table * table * 2 - t * 3, 1e-12, 1.);
    check("  second expression", value->value(X, 1), table > 0.5 ? 1. : 5., 1e-12, 1.);
  }
}
