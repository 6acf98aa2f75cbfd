// compare_laws block.prm: a program that loads the plug-in of the case. The same block of nodus's neo-Hookean law, of
// the law of the plug-in without a limit, and with its limit: the first two have the same forces.

#include <nodus/parameters/parameters.h>
#include <nodus/run/contact_problem.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <ctime>
#include <iostream>
#include <sstream>

namespace
{
  struct Answer
  {
    Nodus::Vector3 force; ///< on the block at the end
    double         cpu;   ///< [s]
  };

  Answer run(Nodus::Parameters parameters)
  {
    parameters.newton.force_tolerance = 1e-12;
    parameters.output.write_vtu       = false;
    std::ostringstream    log;
    const std::clock_t    begin = std::clock();
    Nodus::ContactProblem problem(parameters, MPI_COMM_WORLD, log);
    problem.run();
    return {problem.contact_resultants().front().slave_force, double(std::clock() - begin) / CLOCKS_PER_SEC};
  }
} // namespace

int main(int argc, char **argv)
{
  int                                      no_options = 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi(no_options, argv, 1);
  try
  {
    if (argc < 2)
      throw Nodus::InputError("the parameter file is missing");
    const auto        limited = Nodus::Parameters::read(argv[1]);
    Nodus::Parameters free = Nodus::Parameters::read(argv[1], {"Body 1/Material/Gent/Limit=0"}), shipped = free;
    shipped.bodies[0].material.law = Nodus::MaterialParameters::Law::neo_hookean;

    const Answer ours = run(shipped), theirs = run(free), stiffer = run(limited);
    const double difference = (theirs.force - ours.force).norm() / ours.force.norm();
    std::cout << "force " << ours.force << ", of the plug-in " << theirs.force << ": relative difference " << difference
              << "; with a limit " << stiffer.force << "; CPU " << ours.cpu << " and " << theirs.cpu << " s, ratio "
              << theirs.cpu / ours.cpu << std::endl;
    return difference < 1e-10 && stiffer.force.norm() > 1.05 * ours.force.norm() ? 0 : 1;
  }
  catch (const std::exception &error)
  {
    std::cerr << "compare_laws: " << error.what() << std::endl;
    return 1;
  }
}
