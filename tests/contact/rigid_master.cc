// Blocks and shells on rigid masters in closed form, against analytic values:
// - pressed by a moving plane: uniaxial stress and the resultants on both sides;
// - dragged by a plane that slides: mu times the normal force, and work = stored + dissipated;
// - on a plane that turns under them: the moment of friction; tied to it: the rigid motion of the plane, without force;
// - shells pressed on by cylinders and spheres inside and outside: the pressures of Lame.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <fstream>

using namespace Cases;

namespace
{
  using Type   = BoundaryConditionParameters::Type;
  using Scheme = ContactPairParameters::Scheme;
  using Shape  = MasterSurfaceParameters::Shape;

  const std::vector<std::pair<std::string, Scheme>> schemes = {
      {"nodal", Scheme::nodal}, {"averaged", Scheme::averaged}, {"integration point", Scheme::integration_point}};

  ContactPairParameters
  on_rigid(const Shape shape, const RegionParameters &slave, const Scheme scheme, const double friction = 0.)
  {
    ContactPairParameters p;
    p.name                 = "pair";
    p.slave                = slave;
    p.scheme               = scheme;
    p.friction_coefficient = friction;
    p.master_surface.shape = shape;
    return p;
  }

  Parameters case_of(const std::string &name)
  {
    Parameters p;
    p.output.results_folder = "rigid_master_results/" + name;
    p.output.write_vtu      = false;
    return p;
  }

  /// A cube, E = 1000, nu = 0.3, that slides on its lower sides, compressed by 1 % by a plane from above.
  void check_pressed(const std::string &name, const Scheme scheme, const bool loops, const bool iterative)
  {
    Parameters p             = case_of("pressed");
    p.bodies                 = {box("cube", "3,3,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.3)};
    p.boundary_conditions    = {hold("x", region(1, {x_minus}), {0}),
                                hold("y", region(1, {y_minus}), {1}),
                                hold("z", region(1, {z_minus}), {2})};
    p.contact_pairs          = {on_rigid(Shape::plane, region(1, {z_plus}), scheme)};
    auto &plane              = p.contact_pairs[0].master_surface;
    plane.point              = Point(7., 8., 1.);
    plane.axis               = Vector3({0., 0., -2.});
    plane.motion.translation = {"t", "0", "-0.01*t"};
    p.load_stepping          = {{1.}, {2}};
    if (loops)
      use_loops(p);
    if (iterative)
      p.linear_solver.type = scheme == Scheme::integration_point ? LinearSolverParameters::Type::block
                                                                 : LinearSolverParameters::Type::condensed;
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto  &r     = problem.contact_resultants()[0];
    const double force = 10., arm = 0.5 * 1.003;
    check("pressed, " + name + (loops ? ", loops" : "") + (iterative ? ", iterative" : "") + ": force",
          r.slave_force[2],
          -force,
          1e-8);
    check("  force on the plane", r.master_force[2], force, 1e-8);
    check("  its moments", r.master_moment[0], arm * force, 1e-8);
    check("", r.master_moment[1], -arm * force, 1e-8);
    check("", r.master_moment[2], 0., 1e-8, force);
    check("  side", problem.displacement(1, Point(1, 1, 1))[0], 0.003, 1e-8);
    double deviation = 0.;
    for (const double pressure : problem.contact_fields()[0].pressure)
      deviation = std::max(deviation, std::abs(pressure / problem.contact_fields()[0].pressure[0] - 1.));
    check("  uniform pressure", deviation < 1e-7);
    check("  all nodes are closed", r.open == 0 && r.unpaired == 0);
  }

  /// Columns of the last rows of energy.csv: external work, stored, dissipated, imbalance.
  std::vector<std::array<double, 4>> energies(const Parameters &p)
  {
    MPI_Barrier(world());
    const char *const wanted[] = {"external work", "stored energy", "frictional dissipation", "imbalance"};
    std::ifstream     file(p.output.results_folder + "/energy.csv");
    std::vector<std::array<double, 4>> rows;
    std::vector<std::string>           titles;
    for (std::string line; std::getline(file, line);)
    {
      std::array<double, 4> row{};
      std::istringstream    stream(line);
      unsigned int          column = 0;
      for (std::string cell; std::getline(stream, cell, ','); ++column)
        if (rows.empty() && titles.size() == column)
          titles.push_back(cell.substr(0, cell.find(" [")));
        else
          for (unsigned int i = 0; i < 4; ++i)
            if (titles[column] == wanted[i])
              row[i] = std::stod(cell);
      rows.push_back(row);
    }
    return rows;
  }

  /// A stiff cube held on top and pressed down by 1 % on a plane that slides by 0.4 from t = 1 to 2.
  void check_dragged(const std::string &name, const Scheme scheme, const bool loops)
  {
    Parameters p          = case_of("dragged");
    p.bodies              = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.)};
    p.boundary_conditions = {
        condition("top", Type::displacement, region(1, {z_plus}), {0, 1, 2}, {"0", "0", "-0.01*min(t,1)"})};
    p.contact_pairs          = {on_rigid(Shape::plane, region(1, {z_minus}), scheme, 0.2)};
    auto &plane              = p.contact_pairs[0].master_surface;
    plane.axis               = Vector3({0., 0., 1.});
    plane.motion.translation = {"0.4*max(0,t-1)", "0.3*max(0,t-1)", "0"};
    p.load_stepping          = {{1., 2.}, {1, 4}};
    if (loops)
      use_loops(p);
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto &r = problem.contact_resultants()[0];
    check("dragged, " + name + (loops ? ", loops" : "") + ": friction x",
          r.slave_force[0] / r.slave_force[2],
          0.16,
          1e-8);
    check("  y", r.slave_force[1] / r.slave_force[2], 0.12, 1e-8);
    check("  on the plane", r.master_force[0] / r.slave_force[2], -0.16, 1e-8);
    check("  all nodes slip", r.open == 0 && r.stick == 0);
    const auto   rows = energies(p);
    const auto  &a = rows[rows.size() - 2], &b = rows.back();
    const double work = 0.2 * r.slave_force[2] * 0.125;
    check("  work of the plane in the last increment", b[0] - a[0], work, 1e-5);
    check("  dissipated", b[2] - a[2], work, 1e-5);
    check("  balance", b[3] - a[3], 0., 1e-5, work);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const auto &[name, scheme] : schemes)
  {
    for (const bool loops : {false, true})
    {
      check_pressed(name, scheme, loops, false);
      check_dragged(name, scheme, loops);
    }
    check_pressed(name, scheme, false, true);
  }
}
