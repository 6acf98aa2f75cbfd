// A program of one's own around nodus: it reads a case, presses harder or softer after every increment until the top of
// the block has sunk as far as it is asked to, and takes pressures and displacements from memory.

#include <nodus/parameters/parameters.h>
#include <nodus/run/contact_problem.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const bool                               first_rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  try
  {
    const std::string folder = argc > 1 ? std::string(argv[1]) + '/' : "";
    auto parameters = Nodus::Parameters::read(folder + "block.prm", {"Output/Results folder=own_program_results"});

    // The load is this program's. It is the same on every rank, and changes between increments alone.
    double press = 0.1; // [force per area]
    for (Nodus::BoundaryConditionParameters &condition : parameters.boundary_conditions)
      if (condition.name == "press")
        condition.function = [&press](const Nodus::Point &, const double, const unsigned int) { return -press; };

    const double          wanted = 0.05; // how far the top is to sink [length]
    Nodus::ContactProblem problem(parameters, MPI_COMM_WORLD);
    problem.on_increment(
        [&](const unsigned int increment, const double t)
        {
          const double                sunk = -problem.displacement(1, Nodus::Point(1., 1., 1.))[2];
          const Nodus::ContactFields &foot = problem.contact_fields().front();
          if (first_rank)
            std::cout << "increment " << increment << ", t = " << t << ": pressed by " << press << ", sunk " << sunk
                      << ", contact force " << problem.contact_resultants().front().slave_force[2] << ", pressures "
                      << *std::min_element(foot.pressure.begin(), foot.pressure.end()) << " to "
                      << *std::max_element(foot.pressure.begin(), foot.pressure.end()) << std::endl;
          press *= wanted / sunk;
        });
    problem.run();

    // A column that is free to widen: pressure = Young's modulus times strain.
    const double sunk = -problem.displacement(1, Nodus::Point(1., 1., 1.))[2];
    if (first_rank)
      std::cout << "sunk by " << sunk << ", wanted " << wanted << "; error of the pressure against E u / h "
                << std::abs(press - 10. * wanted) << std::endl;
    return std::abs(sunk - wanted) < 1e-8 && std::abs(press - 10. * wanted) < 1e-6 ? 0 : 1;
  }
  catch (const std::exception &error)
  {
    if (first_rank)
      std::cerr << "own_program: " << error.what() << std::endl;
    return 1;
  }
}
