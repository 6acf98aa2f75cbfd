// A mesh from files that is not refined is held in shares, one that may be by p4est: the same run on either, and a
// checkpoint of one continues on the other. A refined mesh cannot become one that is not.

#include "interrupted.h"
#include "sliding_block.h"

#include <deal.II/base/mpi.h>

#include <csignal>
#include <filesystem>

using namespace SlidingBlock;

namespace
{
  /// Cylinders with curved cells, radius 1: the upper one turned by 30 degrees, pressed down and dragged.
  Parameters cylinders()
  {
    Parameters p;
    for (const bool upper : {false, true})
    {
      BodyParameters body;
      body.mesh_file               = SOURCE_DIR "/../meshes/cylinder_27_2.msh";
      body.rotation_axis[2]        = 1.;
      body.rotation_angle          = upper ? 30. : 0.;
      body.translation[2]          = upper ? 1. : 0.;
      body.material.law            = MaterialParameters::Law::neo_hookean;
      body.material.youngs_modulus = upper ? 80. : 100.;
      body.material.poissons_ratio = 0.3;
      p.bodies.push_back(body);
    }
    p.degree                      = 2;
    p.boundary_conditions         = {hold("bottom", region(1, {1}), {0, 1, 2}),
                                     condition("top",
                                       BoundaryConditionParameters::Type::displacement,
                                       region(2, {2}),
                                       {0, 1, 2},
                                       {"0.05*t", "0.02*t", "-0.02*min(2*t,1)"})};
    p.contact_pairs               = {pair(region(2, {1}), region(1, {2}), 0.3)};
    p.load_stepping.interval_ends = {1.};
    p.load_stepping.increments    = {4};
    p.output.write_vtu            = false;
    p.output.results_folder       = "kinds_of_mesh_" + std::to_string(dealii::Utilities::MPI::n_mpi_processes(world()));
    return p;
  }

  Parameters refinable(Parameters p)
  {
    p.adaptivity.interval = 100;
    return p;
  }

  /// To the end, or until a signal comes in the increment after @p last.
  Outcome run(const Parameters &p, const bool restart, const unsigned int last = 0)
  {
    ContactProblem      problem(p, world(), log());
    std::vector<double> times;
    problem.on_increment(
        [&](const unsigned int increment, const double t)
        {
          times.push_back(t);
          if (increment == last)
            std::raise(SIGTERM);
        });
    run_until_interrupted(problem, restart);
    return outcome(problem, times);
  }

  void clear(const Parameters &p)
  {
    if (root())
      std::filesystem::remove_all(p.output.results_folder);
    MPI_Barrier(world());
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Signals::install();

  const Parameters shares = cylinders(), p4est = refinable(shares);
  clear(shares);
  const Outcome reference = run(shares, false);
  clear(shares);
  check("the same run with p4est", difference(run(p4est, false), reference) <= 1e-6);
  for (const auto &[name, first, second] :
       {std::make_tuple("from shares to p4est", shares, p4est), std::make_tuple("from p4est to shares", p4est, shares)})
  {
    clear(shares);
    run(first, false, 2);
    const Outcome continued = run(second, true);
    check_equal(std::string(name) + ": increments that are left", continued.times.size(), 2);
    check("  force at the end", force(continued), force(reference), 1e-6);
    check("  the same result", difference(continued, reference) <= 1e-6);
  }

  clear(shares);
  Parameters refined             = shares;
  refined.adaptivity.interval    = 1;
  refined.adaptivity.repetitions = 0;
  run(refined, false, 2);
  try
  {
    run(shares, true);
    check("a refined mesh without refinement is refused", false);
  }
  catch (const InputError &error)
  {
    check("a refined mesh without refinement is refused",
          std::string(error.what()).find("is of a refined mesh") != std::string::npos);
  }
}
