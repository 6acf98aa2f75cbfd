#include "run/contact_problem_implementation.h"

#include <algorithm>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Parts of the friction by which it grows.
    constexpr double largest_step = 0.25, smallest_step = 1. / 16.;
  } // namespace

  /// Comes to the friction of the increment from without: first all slides freely, which is close to where a body that
  /// is dragged ends up, then the limits grow. Newton starts each time from the solution before.
  void ContactProblem::Implementation::approach_friction()
  {
    struct Reached
    {
      BlockVector                        solution;
      Pairing                            pairing;
      std::vector<double>                area;
      Status::State                      statuses;
      std::vector<RigidBodies::Unknowns> rigid;
    };
    Reached reached;
    double  from = 0., step = largest_step;
    approaches = true;
    status->set_friction_fraction(0.);
    solve_loops();
    while (from < 1.)
    {
      reached         = {solution, pairing, nodal_area, status->state(), rigid_bodies->unknowns()};
      const double to = std::min(1., from + step);
      try
      {
        status->set_friction_fraction(to);
        approaches = to < 1.;
        solve_loops();
        from = to;
      }
      catch (const SolverFailure &failure)
      {
        step *= 0.5;
        if (step < smallest_step)
          throw;
        std::ostringstream text;
        text << failure.what() << "; back to " << from << " of the friction";
        console.remark(text.str());
        solution   = reached.solution;
        pairing    = reached.pairing;
        nodal_area = reached.area;
        rigid_bodies->set_unknowns(reached.rigid);
        status->set_friction_fraction(from);
        status->set_state(reached.statuses);
        gather_state();
      }
    }
  }
} // namespace Nodus
