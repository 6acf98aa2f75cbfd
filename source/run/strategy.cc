#include "run/strategy.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

// What is tried where something fails, on one page. Names, columns of contact.csv and what each is good for:
// base/remedy.h and contrib/doc/architecture.md.
//
// | level          | what is tried                                | where                               |
// |----------------|----------------------------------------------|-------------------------------------|
// | increment      | the attempts of the ladder below             | Strategy::ladder                    |
// | increment      | halves                                       | LoadPath::solve                     |
// | geometry loop  | slow passes are mixed                        | IncrementLoops::geometry_converged  |
// | threshold loop | slow passes are mixed                        | IncrementLoops::threshold_converged |
// | statuses cycle | regularised law; frozen statuses             | Status::find_period                 |
// | Newton's step  | halved: inverted cells, line search          | Newton::take_step                   |
// | Newton's step  | limited: through the other surface           | Equilibrium::limit_step             |
// | linear solver  | the direct one                               | RescuedSolver                       |

namespace Nodus
{
  Strategy::Strategy(Model &model, Journal &journal, States &states, Equilibrium &equilibrium, IncrementLoops &loops)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , equilibrium_(equilibrium)
      , loops_(loops)
  {
  }

  std::vector<Strategy::Attempt> Strategy::ladder() const
  {
    using Mode                      = LoopParameters::Mode;
    using Kind                      = SolverFailure::Kind;
    const Parameters       &p       = model_.parameters;
    const ContactInterface &contact = *model_.contact;
    const MergedLoops       asked   = {p.geometry_loop.mode == Mode::newton,
                                       p.threshold_loop.mode == Mode::newton && contact.has_friction(),
                                       p.status_loop.mode == Mode::newton};
    const MergedLoops       coupled = {false, true, false}, none;
    const bool              frozen  = p.threshold_loop.mode != Mode::newton && contact.threshold_follows_pressure();

    // name, what is merged, what it counts as, what it answers: kinds of failure of the attempt before after which it
    // has ever helped (contrib/studies/robustness/README.md)
    std::vector<Attempt> attempts = {{"the loops as they are asked for", asked, {}, {}}};
    const auto           add      = [&](const bool fits, const Attempt &attempt)
    {
      if (fits && model_.parameters.strategy.uses(*attempt.remedy))
        attempts.push_back(attempt);
    };
    add(asked.any(),
        {"three loops",
         none,
         Remedy::three_loops,
         {Kind::newton_stalled,
          Kind::newton_limit,
          Kind::status_cycle,
          Kind::inverted_cell,
          Kind::geometry_cycle,
          Kind::loop_limit,
          Kind::not_finite,
          Kind::free_body,
          Kind::over_constraint,
          Kind::linear_solver}});
    add(frozen,
        {"the coupled threshold",
         coupled,
         Remedy::coupled_threshold,
         {Kind::newton_stalled, Kind::newton_limit, Kind::loop_limit}});
    return attempts;
  }

  void Strategy::solve_increment()
  {
    journal_.counts                     = IterationCounts();
    const std::vector<Attempt> attempts = ladder();
    for (auto attempt = attempts.begin();;)
      try
      {
        run(*attempt);
        return;
      }
      catch (const SolverFailure &failure)
      {
        const auto next = std::find_if(
            attempt + 1,
            attempts.end(),
            [&](const Attempt &other)
            { return std::find(other.answers.begin(), other.answers.end(), failure.kind()) != other.answers.end(); });
        // without contact all attempts have the same system
        if (next == attempts.end() || (begins_singular() && model_.contact->n_closed() == 0))
          throw;
        journal_.console.remark((attempt->merged.any() ? "merged iteration given up: " : "three loops given up: ") +
                                std::string(failure.what()) + "; again with " + next->name);
        journal_.diagnosis.end_attempt(failure.what());
        model_.roll_back(states_);
        ++journal_.counts.fallbacks;
        journal_.count(*next->remedy);
        attempt = next;
      }
  }

  void Strategy::run(const Attempt &attempt)
  {
    equilibrium_.begin_attempt(attempt.merged);
    journal_.diagnosis.begin_attempt(attempt.merged.names());
    loops_.solve();
  }

  bool Strategy::begins_singular() const
  {
    if (!equilibrium_.singular() || journal_.counts.newton > 0)
      return false;
    const ContactSurfaces &surfaces = model_.contact->surfaces();
    unsigned int           changed  = 0;
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      changed += surfaces.is_owned(s) && surfaces.has_status(s) &&
                 states_.committed.contact.statuses.contact[s] != states_.now.contact.statuses.contact[s];
    return dealii::Utilities::MPI::sum(changed, model_.communicator) == 0;
  }
} // namespace Nodus
