#include "run/friction_continuation.h"

#include <algorithm>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Parts of the friction by which it grows.
    constexpr double largest_step = 0.25, smallest_step = 1. / 16.;

    /// All friction limits are in force again when it dies.
    struct FullFriction
    {
      Status &status;
      ~FullFriction()
      {
        status.set_friction_fraction(1.);
      }
    };
  } // namespace

  void continue_in_friction(Model &model, Journal &journal, States &states, IncrementLoops &loops)
  {
    Status            &status = model.contact->status();
    const FullFriction in_the_end{status};
    double             from = 0., step = largest_step;
    status.set_friction_fraction(0.);
    loops.solve(true);
    while (from < 1.)
    {
      const State  reached = states.now;
      const double to      = std::min(1., from + step);
      try
      {
        status.set_friction_fraction(to);
        loops.solve(to < 1.);
        from = to;
      }
      catch (const SolverFailure &failure)
      {
        step *= 0.5;
        if (step < smallest_step || !model.parameters.strategy.uses(Remedy::smaller_friction_steps))
          throw;
        journal.count(Remedy::smaller_friction_steps);
        std::ostringstream text;
        text << failure.what() << "; back to " << from << " of the friction";
        journal.console.remark(text.str());
        status.set_friction_fraction(from);
        model.return_to(reached, states);
      }
    }
  }
} // namespace Nodus
