// Volumetric locking: a cube of nearly incompressible Mooney-Rivlin rubber (an eighth of it) between bonded plates is
// compressed by 20 %. With mean dilatation the force of linear cells goes to that of quadratic ones; without, linear
// cells lock. Plane strain bending of a metal beam likewise: above the limit load, standard linear cells are far too
// stiff.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <cmath>

using namespace Cases;
using Treatment = BodyParameters::VolumetricTreatment;

namespace
{
  double force(const Parameters &parameters)
  {
    ContactProblem problem(parameters, world(), log());
    problem.run();
    for (const auto &[name, value] : problem.reactions())
      if (name == "plate")
        return value[2];
    throw std::runtime_error("no reaction");
  }

  double rubber(const unsigned int degree, const unsigned int n, const Treatment treatment, const double nu)
  {
    Parameters        p;
    const std::string cells = std::to_string(n);
    p.bodies.push_back(box("rubber", cells + "," + cells + "," + cells, Point(), Point(1., 1., 1.), 1., nu));
    p.bodies[0].material.law                 = MaterialParameters::Law::mooney_rivlin;
    p.bodies[0].material.mooney_rivlin_ratio = 0.25;
    p.bodies[0].volumetric_treatment         = treatment;
    p.degree                                 = degree;
    p.boundary_conditions                    = {hold("x", region(1, {x_minus}), {0}),
                                                hold("y", region(1, {y_minus}), {1}),
                                                hold("z", region(1, {z_minus}), {2}),
                                                hold("bond", region(1, {z_plus}), {0, 1}),
                                                drive("plate", region(1, {z_plus}), 2, "-0.2*t")};
    p.load_stepping.increments               = {2};
    p.output.results_folder                  = "volumetric_locking_results";
    p.output.write_vtu                       = false;
    return force(p);
  }

  /// An ideally plastic block, 1 thick, in plane strain under a bonded plate: the mean stress of homogeneous plastic
  /// flow is 2/sqrt(3) times the yield stress without the bond, which adds to it.
  double metal(const unsigned int degree, const unsigned int n, const Treatment treatment)
  {
    Parameters        p;
    const std::string cells = std::to_string(n);
    p.bodies.push_back(box("metal", cells + ",1," + cells, Point(), Point(1., 1., 1.), 1000., 0.3));
    p.bodies[0].material.law          = MaterialParameters::Law::j2_plasticity;
    p.bodies[0].material.yield_stress = 1.;
    p.bodies[0].volumetric_treatment  = treatment;
    p.degree                          = degree;
    p.boundary_conditions             = {hold("x", region(1, {x_minus}), {0}),
                                         hold("y", region(1, {y_minus, y_plus}), {1}),
                                         hold("z", region(1, {z_minus}), {2}),
                                         hold("bond", region(1, {z_plus}), {0}),
                                         drive("plate", region(1, {z_plus}), 2, "-0.02*t")};
    p.load_stepping.increments        = {4};
    p.output.results_folder           = "volumetric_locking_results";
    p.output.write_vtu                = false;
    return force(p);
  }

  void print(const std::string &what, const double value)
  {
    if (root() && std::getenv("NODUS_TEST_LOG") != nullptr)
      std::cout << "    " << what << ' ' << std::setprecision(10) << value << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const double nu = 0.4999, reference = rubber(2, 4, Treatment::mean_dilatation, nu);
  print("Q2 4", reference);
  for (const unsigned int n : {2, 4, 8})
    print("Q1 " + std::to_string(n), rubber(1, n, Treatment::mean_dilatation, nu));
  print("Q1 4 standard", rubber(1, 4, Treatment::standard, nu));
  print("Q2 2", rubber(2, 2, Treatment::mean_dilatation, nu));
  for (const unsigned int n : {4, 8})
    for (const unsigned int degree : {1, 2})
      for (const Treatment t : {Treatment::mean_dilatation, Treatment::standard})
        print("metal Q" + std::to_string(degree) + " " + std::to_string(n), metal(degree, n, t));
}
