// A surface that touches itself ("Self contact"): uniform pressure between bodies of one surface, a thin sheet among
// them, which is one cell thick and touches on both sides.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;
  using Solver = LinearSolverParameters::Type;
  using Type   = BoundaryConditionParameters::Type;

  ContactPairParameters self(const std::vector<unsigned int> &bodies, const std::vector<unsigned int> &ids)
  {
    ContactPairParameters pair;
    pair.name         = "self";
    pair.slave        = region(bodies.front(), ids);
    pair.slave.bodies = bodies;
    pair.master       = pair.slave;
    pair.self_contact = true;
    return pair;
  }

  constexpr double E = 100., pressure = 1.;

  /// A sheet 0.1 thick between two blocks, all of other cells, pressed together; nu = 0.
  Parameters stack(const std::string &sheet, const double upper_E = E)
  {
    Parameters p;
    p.bodies                = {box("lower", "3,3,2", {0, 0, 0}, {1, 1, 0.4}, E, 0.),
                               box("sheet", sheet, {0, 0, 0.4}, {1, 1, 0.5}, 2. * E, 0.),
                               box("upper", "2,5,2", {0, 0, 0.5}, {1, 1, 1}, upper_E, 0.)};
    p.boundary_conditions   = {hold("x", region(0, {x_minus}), {0}),
                               hold("y", region(0, {y_minus}), {1}),
                               hold("ground", region(1, {z_minus}), {2}),
                               condition("load", Type::traction, region(3, {z_plus}), {2}, {"-1*t"})};
    p.contact_pairs         = {self({1, 2, 3}, {z_minus, z_plus})};
    p.load_stepping         = {{1.}, {1}};
    p.output.write_vtu      = false;
    p.output.results_folder = "self_contact_results";
    return p;
  }

  void check_stack(const std::string &name, const Parameters &p, const double tolerance = 1e-8)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    const ContactFields &fields = problem.contact_fields()[0];
    double               off    = 0.;
    for (unsigned int k = 0; k < fields.X.size(); ++k)
      if (fields.status[k] != ContactStatus::open && fields.area[k] > 0.)
        off = std::max(off, std::abs(fields.pressure[k] - pressure));
    report(name, "");
    check("  pressure of closed nodes, off by at most",
          dealii::Utilities::MPI::max(off, world()),
          0.,
          tolerance,
          pressure);
    check("  area of both interfaces", problem.contact_resultants()[0].contact_area, 2., tolerance);
    const double shortening = 0.4 / E + 0.1 / (2. * E) + 0.5 / p.bodies[2].material.youngs_modulus;
    check("  top", problem.displacement(3, Point(1., 1., 1.))[2], -shortening, tolerance);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_stack("sheet of finer cells: slave on both sides", stack("4,4,1"));
  check_stack("sheet of coarser cells: master on both sides", stack("1,2,1"));
  check_stack("sheet of two layers", stack("3,4,2"));
  for (const auto &[name, solver] :
       {std::make_pair("direct", Solver::direct), {"block", Solver::block}, {"condensed", Solver::condensed}})
  {
    Parameters p         = stack("3,3,1", 4. * E); // slave of the stiffer block, master of the softer one
    p.linear_solver.type = solver;
    check_stack(std::string("sheet like the lower block, ") + name, p);
    p.degree = 2;
    check_stack(std::string("the same, quadratic, ") + name, p);
  }
  for (const auto &[name, scheme] :
       {std::make_pair("nodal", Scheme::nodal), {"integration points", Scheme::integration_point}})
  {
    Parameters p                    = stack("3,3,1");
    p.bodies[2].generator_arguments = box("", "3,3,2", {0, 0, 0.5}, {1, 1, 1}, E, 0.).generator_arguments;
    p.contact_pairs[0].scheme       = scheme;
    check_stack(std::string("same cells everywhere, ") + name, p);
  }
  Parameters p                 = stack("4,4,1");
  p.bodies[0].local_refinement = 1;
  p.bodies[0].refine_where     = "x<0.5";
  p.bodies[1].local_refinement = 1;
  p.bodies[1].refine_where     = "y>0.5";
  check_stack("hanging nodes", p);
  return 0;
}
