#include "run/strategy.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

// What is tried where something fails, on one page. Names, columns of contact.csv and what each is good for:
// base/remedy.h and contrib/doc/architecture.md.
//
// | level          | what is tried                                | where                               |
// |----------------|----------------------------------------------|-------------------------------------|
// | increment      | the attempts of the ladder below             | Strategy::ladder                    |
// | increment      | left where it ends in no stable equilibrium  | Strategy::leave_if_unstable         |
// | increment      | halves, at once where Newton comes nowhere   | Strategy::solve_increment           |
// | increment      | halves; relaxation where not stable          | LoadPath::solve                     |
// | increment      | second pass of a pair that is too deep       | LoadPath::hold_master               |
// | geometry loop  | slow passes are mixed                        | IncrementLoops::geometry_converged  |
// | threshold loop | slow passes are mixed                        | IncrementLoops::threshold_converged |
// | statuses cycle | regularised law; frozen statuses             | Status::update, find_period         |
// | Newton's step  | halved: inverted cells, cycles, line search  | Newton::take_step                   |
// | Newton's step  | limited: through the other surface           | Equilibrium::limit_step             |
// | linear solver  | the direct one                               | ChosenSolver                       |

namespace Nodus
{
  Strategy::Strategy(Model &model, Journal &journal, States &states, Equilibrium &equilibrium, IncrementLoops &loops)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , equilibrium_(equilibrium)
      , loops_(loops)
      , stability_(model, equilibrium)
      , relaxation_(model, journal, states, equilibrium, loops, stability_)
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

    const std::vector<Kind> any_kind = {Kind::newton_stalled,
                                        Kind::newton_lost,
                                        Kind::newton_limit,
                                        Kind::status_cycle,
                                        Kind::inverted_cell,
                                        Kind::geometry_cycle,
                                        Kind::loop_limit,
                                        Kind::not_finite,
                                        Kind::free_body,
                                        Kind::over_constraint,
                                        Kind::linear_solver};

    // name, what is merged, what it counts as, what it answers: kinds of failure of the attempt before after which it
    // has ever helped (contrib/studies/robustness/README.md); whether it goes on along the last motion
    std::vector<Attempt> attempts = {{"the loops as they are asked for", asked, {}, {}, p.load_stepping.predictor}};
    if (attempts.front().goes_on)
      attempts.push_back({"the last state as the start", asked, {}, any_kind, false});
    const auto add = [&](const bool fits, const Attempt &attempt)
    {
      if (fits && model_.parameters.strategy.uses(*attempt.remedy))
        attempts.push_back(attempt);
    };
    add(asked.any(), {"three loops", none, Remedy::three_loops, any_kind, false});
    add(frozen,
        {"the coupled threshold",
         coupled,
         Remedy::coupled_threshold,
         {Kind::newton_stalled, Kind::newton_lost, Kind::newton_limit, Kind::loop_limit},
         false});
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
        return leave_if_unstable(*attempt);
      }
      catch (const SolverFailure &failure)
      {
        const auto next = std::find_if(
            attempt + 1,
            attempts.end(),
            [&](const Attempt &other)
            {
              const bool same = !other.remedy && !equilibrium_.predicted(); // nothing but another start
              // what another way through the same increment costs more than two halves
              const bool too_large = other.remedy && failure.kind() == SolverFailure::Kind::newton_lost &&
                                     equilibrium_.increment().may_be_halved;
              return !same && !too_large &&
                     std::find(other.answers.begin(), other.answers.end(), failure.kind()) != other.answers.end();
            });
        // without contact all attempts have the same system
        if (next == attempts.end() || (begins_singular() && model_.contact->n_closed() == 0))
          throw;
        journal_.console.remark((attempt->merged.any() ? "merged iteration given up: " : "three loops given up: ") +
                                std::string(failure.what()) + "; again with " + next->name);
        journal_.diagnosis.end_attempt(failure.what());
        model_.roll_back(states_);
        ++journal_.counts.fallbacks;
        if (next->remedy)
          journal_.count(*next->remedy);
        attempt = next;
      }
  }

  void Strategy::run(const Attempt &attempt)
  {
    equilibrium_.begin_attempt(attempt.merged);
    journal_.diagnosis.begin_attempt(attempt.merged.names());
    if (attempt.goes_on)
      equilibrium_.predict();
    loops_.solve();
  }

  void Strategy::relax_increment(const bool unstable)
  {
    journal_.counts = IterationCounts();
    try
    {
      relax(unstable ? Relaxation::Reason::unstable_iterates : Relaxation::Reason::no_equilibrium);
    }
    catch (const SolverFailure &failure)
    {
      if (unstable)
        throw;
      journal_.console.remark(std::string(failure.what()) + "; once more without, for the diagnosis");
      journal_.diagnosis.end_attempt(failure.what());
      model_.roll_back(states_);
      solve_increment();
    }
  }

  void Strategy::relax(const Relaxation::Reason reason)
  {
    ++journal_.counts.fallbacks;
    journal_.count(Remedy::relaxation);
    try
    {
      relaxation_.solve(ladder().front().merged, reason);
      stability_.release();
    }
    catch (const SolverFailure &)
    {
      stability_.release();
      throw;
    }
  }

  /// Newton's method finds equilibria that are not stable, too: a strut that has not buckled. Bodies do not stay there.
  void Strategy::leave_if_unstable(const Attempt &attempt)
  {
    // A straight path takes one system, which the softest motion of those before says little about.
    const bool straight = equilibrium_.predicted() && journal_.counts.newton == 1 &&
                          equilibrium_.solver_type() == LinearSolverParameters::Type::direct;
    if ((!stability_.follow() && !straight) || !stability_.can_count())
      return;
    const unsigned int n = stability_.n_unstable();
    if (n == 0)
      return;
    const std::string what = "the equilibrium that was found is not stable (" + std::to_string(n) +
                             (n == 1 ? " negative eigenvalue)" : " negative eigenvalues)");
    if (equilibrium_.increment().follows_branch)
      return journal_.console.remark(what);
    if (!may_relax())
      return journal_.console.remark("warning: " + what + ": the bodies would leave it");
    journal_.console.remark(what + ": the bodies are let go from it");
    try
    {
      relax(Relaxation::Reason::unstable_equilibrium);
    }
    catch (const SolverFailure &failure)
    {
      journal_.console.remark(std::string("warning: no stable equilibrium was found: ") + failure.what() +
                              "; the increment ends in the one that is not stable");
      journal_.diagnosis.end_attempt(failure.what());
      model_.roll_back(states_);
      run(attempt);
    }
  }

  bool Strategy::begins_singular() const
  {
    if (!equilibrium_.singular() || journal_.counts.newton > equilibrium_.driven().waits())
      return false;
    const ContactSurfaces &surfaces = model_.contact->surfaces();
    unsigned int           changed  = 0;
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      changed += surfaces.is_owned(s) && surfaces.has_status(s) &&
                 states_.committed.contact.statuses.contact[s] != states_.now.contact.statuses.contact[s];
    return dealii::Utilities::MPI::sum(changed, model_.communicator) == 0;
  }
} // namespace Nodus
