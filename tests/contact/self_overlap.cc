// Overlaps at the start of a surface that touches itself: up to half of a wall they are pressed out as those of a pair
// by hand are, however flat the cells; deeper ones are refused, those of two bodies and those of one body. Bodies that
// are excluded may overlap, and what touches is no overlap.

#include "../cases.h"
#include "../messages.h"

#include <filesystem>
#include <fstream>

using namespace Cases;

namespace
{
  ContactPairParameters self(const std::vector<unsigned int> &bodies)
  {
    ContactPairParameters pair;
    pair.name         = "self";
    pair.slave.bodies = bodies;
    pair.slave.where  = "1";
    pair.master       = pair.slave;
    pair.self_contact = true;
    return pair;
  }

  Parameters stack(const double overlap, const std::string &upper_cells, const double upper_height)
  {
    Parameters p;
    p.bodies                = {box("lower", "2,2,5", {0, 0, 0}, {2, 2, 1}, 100., 0.),
                               box("upper", upper_cells, {0.2, 0.2, 1. - overlap}, {1.8, 1.8, 1. - overlap + upper_height}, 100., 0.)};
    p.boundary_conditions   = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                               hold("top", region(2, {z_plus}), {0, 1, 2})};
    p.contact_pairs         = {self({1, 2})};
    p.load_stepping         = {{1.}, {1}};
    p.output.write_vtu      = false;
    p.output.results_folder = "self_overlap_results";
    return p;
  }

  double force(const Parameters &p)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    return problem.contact_resultants()[0].slave_force.norm();
  }

  std::string outcome(const Parameters &p)
  {
    try
    {
      force(p);
    }
    catch (const std::exception &error)
    {
      return error.what();
    }
    return "no failure";
  }

  /// One body of two columns, one on the other, a wider one, which are @p apart.
  Parameters two_columns(const double apart)
  {
    const std::string file = "self_overlap_results/two_columns.msh";
    if (root())
    {
      std::filesystem::create_directories("self_overlap_results");
      std::ofstream mesh(file);
      mesh << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n24\n";
      unsigned int number = 0;
      for (const double bottom : {0., 2. + apart})
        for (unsigned int layer = 0; layer < 3; ++layer)
          for (const auto &[x, y] : {std::make_pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
            mesh << ++number << ' ' << (bottom > 0. ? 3. * x - 1. : x) << ' ' << (bottom > 0. ? 3. * y - 1. : y) << ' '
                 << bottom + layer << '\n';
      mesh << "$EndNodes\n$Elements\n4\n";
      for (unsigned int cell = 0; cell < 4; ++cell)
      {
        mesh << cell + 1 << " 5 2 1 1";
        for (unsigned int n = 1; n <= 8; ++n)
          mesh << ' ' << 4 * cell + (cell > 1 ? 4 : 0) + n;
        mesh << '\n';
      }
      mesh << "$EndElements\n";
    }
    MPI_Barrier(world());
    Parameters p                    = stack(0., "1,1,1", 1.);
    p.bodies                        = {p.bodies[0]};
    p.bodies[0].generator           = "";
    p.bodies[0].mesh_file           = file;
    p.bodies[0].generator_arguments = "";
    std::ostringstream top;
    top << "z>" << 3.9 + apart;
    p.boundary_conditions = {hold("ground", region(1, {}, "z<0.1"), {0, 1, 2}),
                             hold("top", region(1, {}, top.str()), {0, 1, 2})};
    p.contact_pairs       = {self({1})};
    return p;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  // deeper than the middle of the cells behind, which the wall of either body has several of
  Parameters p                    = stack(0.15, "3,3,5", 1.);
  p.contact_pairs[0].slave        = region(2, {z_minus});
  p.contact_pairs[0].master       = region(1, {z_plus});
  p.contact_pairs[0].self_contact = false;
  const double by_hand            = force(p);
  p.contact_pairs                 = {self({1, 2})};
  check("0.15 into cells of 0.2: force, as of a pair by hand", force(p), by_hand, 1e-8);

  check_words("deeper than half of a face: refused",
              outcome(stack(0.35, "3,3,5", 1.)),
              {"overlap at the start", "'self'", "Overclosure limit"});
  check_words("a sheet inside of a block: refused",
              outcome(stack(0.3, "3,3,1", 0.1)),
              {"overlap at the start", "inside", "half of the wall", "a pair of their own"});
  p                                  = stack(0.35, "3,3,5", 1.);
  p.contact_pairs[0].excluded_bodies = {{1, 2}};
  check("excluded bodies that overlap: force", force(p), 0., 1e-12, 1.);

  check("one body of two columns that touch: force", force(two_columns(0.)), 0., 1e-9, 1.);
  check("one body of two columns, 0.1 into each other: force", force(two_columns(-0.1)) > 1.);
  check_words("one body of two columns, 0.8 into each other: refused",
              outcome(two_columns(-0.8)),
              {"overlap at the start", "inside"});
  return 0;
}
