// A restart may change what lies ahead of it: a cube, E = 10, nu = 0, whose top is pressed by 1 at t = 1, where the
// checkpoint is, and at t = 2 by what the restart says; u = -p/E there. What the state has come from may not change.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  BoundaryConditionParameters load(const std::string &name, const std::string &value, const double from)
  {
    BoundaryConditionParameters load =
        condition(name, BoundaryConditionParameters::Type::traction, region(1, {z_plus}), {2}, {value});
    load.active_from = from;
    return load;
  }

  Parameters cube()
  {
    Parameters p;
    p.bodies                     = {box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 10., 0.)};
    p.boundary_conditions        = {hold("bottom", region(1, {z_minus}), {0, 1, 2}), load("load", "-min(t,1)", 0.)};
    p.load_stepping              = {{1., 2.}, {2, 1}};
    p.output.write_vtu           = false;
    p.output.checkpoint_interval = 2;
    p.output.results_folder      = "ahead";
    return p;
  }

  /// @p first leaves a checkpoint at t = 1, and @p then goes on from it to t = 2, where @p top is the displacement.
  void change(const Parameters &first, const Parameters &then, const std::string &name, const double top = 0.)
  {
    ContactProblem(first, world(), log()).run();
    MPI_Barrier(world());
    try
    {
      ContactProblem problem(then, world(), log());
      problem.restart();
      problem.run();
      check(name, problem.displacement(1, {0, 0, 1})[2], top, 1e-9, 0.1);
    }
    catch (const InputError &error)
    {
      report(name, error.what());
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const Parameters p = cube();
  change(p, p, "as it was", -0.1);

  Parameters ends                          = p;
  ends.boundary_conditions[1].active_until = 1.;
  change(p, ends, "the load ends", 0.);
  change(ends, p, "it does not end after all", -0.1);

  Parameters more = p;
  more.boundary_conditions.push_back(load("more", "-2*(t-1)", 1.));
  change(p, more, "another load", -0.3);
  change(more, p, "no other load", -0.1);
  Parameters less                      = more;
  less.boundary_conditions[2].value[0] = "0.5*(t-1)";
  change(more, less, "another load of another size", -0.05);

  Parameters other                      = p;
  other.boundary_conditions[1].value[0] = "-2*min(t,1)";
  change(p, other, "another past");
  other                                    = p;
  other.boundary_conditions[1].active_from = 1.;
  change(p, other, "no past");
  other = p;
  other.boundary_conditions.push_back(load("more", "-t", 0.));
  change(p, other, "another load in the past");
  change(other, p, "a load less in the past");
}
