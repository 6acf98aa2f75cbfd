// Meshed rigid bodies that move as prescribed, on linear and quadratic cells:
// - one that presses a cube: uniaxial stress, and its reaction; its work is what the cube stores;
// - one that turns by 60 degrees about an oblique axis with a cube tied to it: both move rigidly, without force;
// - one that is dragged over a cube: mu times the normal force.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <fstream>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;

  /// A cube and a rigid plate above it, whose mesh does not match.
  Parameters cube_and_plate(const unsigned int degree, const double nu)
  {
    Parameters p;
    p.degree                  = degree;
    p.bodies                  = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, nu),
                                 box("plate", "3,3,2", {-0.5, -0.5, 1}, {1.5, 1.5, 1.5}, 0, 0)};
    p.bodies[1].material      = MaterialParameters();
    p.bodies[1].rigid         = true;
    p.contact_pairs           = {ContactPairParameters()};
    p.contact_pairs[0].slave  = region(1, {z_plus});
    p.contact_pairs[0].master = region(2, {z_minus});
    p.output.results_folder   = "rigid_body_results";
    p.output.write_vtu        = false;
    return p;
  }

  void check_pressed(const unsigned int degree, const LinearSolverParameters::Type solver)
  {
    Parameters p                   = cube_and_plate(degree, 0.3);
    p.boundary_conditions          = {hold("x", region(1, {x_minus}), {0}),
                                      hold("y", region(1, {y_minus}), {1}),
                                      hold("z", region(1, {z_minus}), {2})};
    p.bodies[1].motion.translation = {"0", "0", "-0.01*t"};
    p.linear_solver.type           = solver;
    p.load_stepping                = {{1.}, {2}};
    ContactProblem problem(p, world(), log());
    problem.run();
    const std::string name = "degree " + std::to_string(degree) + ", " + text_of(solver);
    check("pressed, " + name + ": force on the plate", problem.contact_resultants()[0].master_force[2], 10., 1e-8);
    check("  side of the cube", problem.displacement(1, Point(1, 1, 1))[0], 0.003, 1e-8);
    check("  reaction of the plate",
          problem.reactions().back().first == "plate" ? problem.reactions().back().second[2] : 0.,
          -10.,
          1e-8);
    MPI_Barrier(world());
    std::ifstream file(p.output.results_folder + "/energy.csv");
    std::string   line, last;
    while (std::getline(file, line))
      last = line;
    std::vector<double> row;
    std::istringstream  cells(last);
    for (std::string cell; std::getline(cells, cell, ',');)
      row.push_back(std::stod(cell));
    check("  its work", row[2], 0.05, 1e-7);
    check("  is stored", row[5], 0.05, 1e-7);
  }

  void check_tied(const unsigned int degree)
  {
    Parameters p                   = cube_and_plate(degree, 0.3);
    p.bodies[0].material.law       = MaterialParameters::Law::neo_hookean;
    p.contact_pairs[0].contact_law = ContactPairParameters::ContactLaw::tied;
    auto &motion                   = p.bodies[1].motion;
    motion.rotation                = "60*t";
    motion.rotation_axis           = Vector3({1., 2., 3.});
    motion.rotation_centre         = {2., 1., 0.};
    motion.translation             = {"t", "-2*t", "t^2"};
    p.load_stepping                = {{1.}, {6}};
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto exact = [&](const Point &X)
    {
      const Vector3 e = motion.rotation_axis / std::sqrt(14.), d = X - Point(2, 1, 0);
      return Vector3(std::cos(dealii::numbers::PI / 3.) * d + 0.5 * (e * d) * e +
                     std::sin(dealii::numbers::PI / 3.) * dealii::cross_product_3d(e, d) + Vector3({1., -2., 1.}) - d);
    };
    check("tied, degree " + std::to_string(degree) + ": displacement of the cube",
          problem.displacement(1, Point(0, 1, 0)),
          exact(Point(0, 1, 0)),
          1e-6);
    check("  of the plate", problem.displacement(2, Point(1.5, -0.5, 1.5)), exact(Point(1.5, -0.5, 1.5)), 1e-12);
    check("  no force", problem.contact_resultants()[0].slave_force.norm() < 1e-3);
  }

  void check_dragged()
  {
    Parameters p                            = cube_and_plate(1, 0.);
    p.boundary_conditions                   = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    p.bodies[1].motion.translation          = {"0.4*max(0,t-1)", "0", "-0.01*min(t,1)"};
    p.contact_pairs[0].friction_coefficient = 0.2;
    p.load_stepping                         = {{1., 2.}, {1, 4}};
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto &r = problem.contact_resultants()[0];
    check("dragged: friction", r.master_force[0] / r.master_force[2], -0.2, 1e-8);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Solver = LinearSolverParameters::Type;
  for (const Solver solver : {Solver::direct, Solver::condensed, Solver::block})
    check_pressed(1, solver);
  check_pressed(2, Solver::direct);
  check_tied(1);
  check_tied(2);
  check_dragged();
}
