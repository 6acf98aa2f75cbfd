// Volumetric locking. A cube of nearly incompressible Mooney-Rivlin rubber (an eighth of it) between bonded plates is
// compressed by 20 % in two steps: with mean dilatation the force of linear cells goes to that of quadratic ones,
// without it they lock. An ideally plastic block in plane strain between rough plates: its limit load, and no limit for
// standard cells.

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
    p.strategy.without                       = {"relaxation"}; // cells that lock buckle under their own pressure
    p.output.results_folder                  = "volumetric_locking_results";
    p.output.write_vtu                       = false;
    return force(p);
  }

  /// A quarter of an ideally plastic block between bonded plates in plane strain, linear cells.
  double metal(const unsigned int n, const Treatment treatment)
  {
    Parameters        p;
    const std::string cells = std::to_string(n);
    p.bodies.push_back(box("metal", cells + ",1," + cells, Point(), Point(1., 1., 1.), 1000., 0.3));
    p.bodies[0].material.law          = MaterialParameters::Law::j2_plasticity;
    p.bodies[0].material.yield_stress = 1.;
    p.bodies[0].volumetric_treatment  = treatment;
    p.boundary_conditions             = {hold("x", region(1, {x_minus}), {0}),
                                         hold("y", region(1, {y_minus, y_plus}), {1}),
                                         hold("z", region(1, {z_minus}), {2}),
                                         hold("bond", region(1, {z_plus}), {0}),
                                         drive("plate", region(1, {z_plus}), 2, "-0.01*t")};
    p.load_stepping.increments        = {4};
    p.output.results_folder           = "volumetric_locking_results";
    p.output.write_vtu                = false;
    return force(p);
  }

  /// Prints the value, and "NO" unless it @p holds.
  void check_value(const std::string &what, const double value, const bool holds)
  {
    report(what, Numbers::number(value, 4) + (holds ? "" : ": NO"));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  {
    const double nu = 0.4999, reference = rubber(2, 4, Treatment::mean_dilatation, nu);
    double       before = 1.;
    for (const unsigned int n : {2, 4, 8})
    {
      const double error = rubber(1, n, Treatment::mean_dilatation, nu) / reference - 1.;
      check_value("rubber, linear cells, " + std::to_string(n) + " per edge: above quadratic ones, falling, by",
                  error,
                  error > 0. && error < 0.75 * before);
      before = error;
    }
    check_value("rubber, linear cells, 8 per edge: at most 0.03", before, before < 0.03);
    const double coarse = rubber(2, 2, Treatment::mean_dilatation, nu) / reference - 1.;
    check_value("rubber, quadratic cells, 2 per edge: above 4, at most 0.03", coarse, std::abs(coarse) < 0.03);
    const double locked = rubber(1, 4, Treatment::standard, nu) / reference;
    check_value("rubber, standard linear cells, 4 per edge: times as stiff, more than 20", locked, locked > 20.);
  }
  {
    // Prandtl's blocks between rough plates: rigid-plastic and as high as wide, 2 k = 2/sqrt(3) yield (Hill, The
    // Mathematical Theory of Plasticity, 1950, ch. 9); the area has grown by about 1 %
    const double limit = 2. / std::sqrt(3.);
    check("metal, linear cells, 8 per edge: limit load", -metal(8, Treatment::mean_dilatation), 1.01 * limit, 0.05);
    const double locked = -metal(8, Treatment::standard) / limit;
    check_value("metal, standard linear cells, 8 per edge: over the limit load, more than 1.1", locked, locked > 1.1);
  }
}
