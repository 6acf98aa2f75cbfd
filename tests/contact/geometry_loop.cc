// The geometry loop ends where forces and contact laws hold in the geometry that the last solution leads to. Three
// loops with the tolerances that they have by default give the forces of merged ones to 1e-4: a block is pressed onto
// one whose faces do not match and dragged over it, so that pairing and normals change with every pass. With a
// criterion on the change of displacements (1e-2 of the step) forces were off by up to 4e-4 of each other.

#include "../restart/sliding_block.h"

#include <deal.II/base/mpi.h>

using namespace SlidingBlock;

namespace
{
  Vector3 run(const Parameters &p, unsigned int &passes)
  {
    ContactProblem problem(p, world(), log());
    passes = 0;
    problem.on_increment([&](unsigned int, double) { passes = std::max(passes, problem.iterations().geometry); });
    problem.run();
    return problem.contact_resultants()[0].slave_force;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  for (const auto scheme : {ContactPairParameters::Scheme::averaged, ContactPairParameters::Scheme::nodal})
  {
    Parameters p                   = parameters("geometry_loop_results");
    p.contact_pairs[0].scheme      = scheme;
    p.boundary_conditions[1].value = {"0.12*sin(3*t)", "0.02*t", "-0.06*min(2*t,1)"};
    p.output.write_vtu             = false;
    Parameters loops               = p;
    use_loops(loops);
    unsigned int  passes;
    const Vector3 merged = run(p, passes), looped = run(loops, passes);
    check(text_of(scheme) + ": force of three loops", looped, merged, 1e-4);
    if (root() && std::getenv("NODUS_TEST_LOG") != nullptr)
      std::cout << "    difference " << (looped - merged).norm() / merged.norm() << std::endl;
    check_count("passes of the geometry loop in an increment", passes, 10);
  }
}
