#include "run/contact_problem_implementation.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Forces of viscous stabilisation beyond this part of the largest nodal force are warned of.
    constexpr double large_drag = 0.01;
  } // namespace

  /// Increment after increment; one that fails is tried again in halves, from exactly the state before.
  void ContactProblem::Implementation::follow_load_path()
  {
    const unsigned int first = path.increment();
    std::vector<bool>  never_closed(surfaces->n_pairs(), true);
    console.begin_at(path.progress());
    while (!path.finished())
    {
      console.begin_increment(path.increment(), path.time(), path.target());
      diagnosis.begin_increment(path.increment(), path.time(), path.target());
      impose(path.target());
      try
      {
        solve_increment();
        check_stabilised_motion();
      }
      catch (const SolverFailure &failure)
      {
        std::ostringstream reason;
        reason << "geometry pass " << pass.geometry << ", threshold pass " << pass.threshold << ", status pass "
               << pass.status << ": " << failure.what();
        diagnosis.end_attempt(failure.what());
        const bool        may_shrink = !begins_singular();
        const bool        again      = may_shrink && path.cut_back();
        const std::string hint       = again ? "" : diagnose(failure, may_shrink);
        roll_back();
        if (!again)
          give_up(reason.str(), hint, path.increment() > first, may_shrink);
        console.remark(reason.str() + "; the increment is halved");
        continue;
      }
      if (mesh_repetitions < parameters.adaptivity.repetitions)
      {
        if (adapt_mesh())
        {
          ++mesh_repetitions;
          console.remark("the increment is repeated on the new mesh");
          continue;
        }
      }
      mesh_repetitions = 0;
      warn_of_lost_partners();
      report_stabilisation();
      commit();
      const unsigned int increment = path.increment();
      path.accept(counts.newton, counts.fallbacks == 0);
      {
        const auto timer = profile.time(Phase::output);
        update_results();
        write(increment, path.finished());
      }
      for (unsigned int p = 0; p < never_closed.size(); ++p)
        never_closed[p] = never_closed[p] && resultants[p].slip + resultants[p].stick == 0;
      console.end_increment(counts, resultants, path.progress());
      if (callback)
        callback(increment, time);
      const unsigned int every = parameters.adaptivity.interval;
      if (every > 0 && increment % every == 0 && !path.finished() && adapt_mesh())
        restore_equilibrium();
      const unsigned int interval = parameters.output.checkpoint_interval;
      if (interval > 0 && increment % interval == 0)
        write_checkpoint();
    }
    for (unsigned int p = 0; p < never_closed.size(); ++p)
      if (never_closed[p] && first == 1)
        console.remark("contact pair " + std::to_string(p + 1) + in_brackets(parameters.contact_pairs[p].name) +
                       " was open at the end of every increment; --validate tells its gaps");
  }

  /// Closed sites that end the increment without a master point slid off the master surface, or went through it: that
  /// satisfies the equations.
  void ContactProblem::Implementation::warn_of_lost_partners()
  {
    unsigned int              n_closed = 0;
    std::vector<unsigned int> lost;
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      if (surfaces->is_owned(s) && surfaces->has_status(s) && status->kept(s).front() != 0.)
      {
        ++n_closed;
        if (!pairing[s].found)
          lost.push_back(s);
      }
    const unsigned int n_lost = dealii::Utilities::MPI::sum(static_cast<unsigned int>(lost.size()), communicator);
    n_closed                  = dealii::Utilities::MPI::sum(n_closed, communicator);
    if (n_lost > 0)
      console.remark("warning: " + std::to_string(n_lost) + " of " + std::to_string(n_closed) +
                     " closed sites have no master point any more, first " + site_loci(lost, 1).front() +
                     ": they slid off the master surface, or went through it in too large an increment");
  }

  /// What is left at time @p t, in the interval at hand, of the reactions that are released in it.
  double ContactProblem::Implementation::release_fraction(const double t) const
  {
    return (path.interval_end() - t) / (path.interval_end() - path.interval_begin());
  }

  /// Says how much of the balance of the increment is due to viscous stabilisation.
  void ContactProblem::Implementation::report_stabilisation()
  {
    if (!stabilisation->acts())
      return;
    const double       part = drag.linfty_norm() / force_scale;
    std::ostringstream text;
    text << std::setprecision(2) << "viscous stabilisation carries " << 100. * part << " % of the largest nodal force ("
         << drag.linfty_norm() << " of " << force_scale << ')';
    if (part > large_drag)
      text << ": dashpots hold this state in part; they are gone at t = " << path.interval_end()
           << ", and if states before that matter, give more increments or a smaller 'Viscous stabilisation'";
    console.remark(text.str());
  }

  /// Sets the boundary conditions of time @p t. Where a displacement was prescribed until the interval began, the force
  /// that held it goes to zero in the course of the interval.
  void ContactProblem::Implementation::impose(const double t)
  {
    time = t;
    if (boundary_conditions->set_time(t))
      surfaces->set_fixed(boundary_conditions->homogeneous_constraints());
    surfaces->move_rigid_masters(path.time(), t);
    rigid_bodies->set_time(t);
    const auto  &constraints = boundary_conditions->homogeneous_constraints();
    const double interval_1  = parameters.load_stepping.interval_ends.front();
    stabilisation->set_increment(path.time(), t, path.interval_begin(), path.interval_end());
    drag            = 0.;
    motions_unknown = path.time() == path.interval_begin() && surfaces->n_pairs() > 0;
    status->set_resolved_interference(std::min(1., t / interval_1));
    const double rest = release_fraction(t);
    for (const DoFIndex i : surfaces->layout().owned[0])
      released(i) = constraints.is_constrained(i) ? 0. : rest * reaction(i);
    released.compress(dealii::VectorOperation::insert);
  }

  /// The state is the last one that converged, in this run if @p converged_before. @p hint: where to read more.
  /// @p may_shrink: smaller increments might have come further.
  void ContactProblem::Implementation::give_up(const std::string &reason,
                                               const std::string &hint,
                                               const bool         converged_before,
                                               const bool         may_shrink)
  {
    tables->add_failure();
    if (vtu && converged_before)
    {
      const auto timer = profile.time(Phase::output);
      relevant_u       = committed.block(0);
      vtu->write(path.increment() - 1, path.time(), relevant_u, fields);
    }
    std::ostringstream message;
    message << "increment " << path.increment() << " (t = " << path.target() << "), " << reason
            << ". The last converged state is t = " << path.time()
            << (path.increment() > 1 ? "" : " (no increment converged)");
    if (!may_shrink)
      message << ". Smaller increments begin with the same system, so the increment was not cut back";
    else if (!parameters.load_stepping.cut_back)
      message << ". Give more Increments, or set 'Load stepping/Cut back = true'";
    else
      message << ". The increment was cut back to " << path.target() - path.time()
              << "; if the case itself is right, give a smaller 'Load stepping/Minimum increment' or more "
                 "'Newton/Maximum iterations'";
    message << hint;
    throw SolverFailure(message.str());
  }
} // namespace Nodus
