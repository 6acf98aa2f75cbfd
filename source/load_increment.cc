#include <nodus/contact/site_values.h>
#include <nodus/contact_problem_implementation.h>

#include <algorithm>
#include <sstream>

namespace Nodus
{
  namespace
  {
    double largest_entry(const std::vector<Vector3> &a, const std::vector<Vector3> &b)
    {
      double largest = 0.;
      for (unsigned int i = 0; i < a.size(); ++i)
        largest = std::max(largest, (a[i] - b[i]).norm());
      return largest;
    }

    /// Newton iterations without progress after which a merged iteration is given up.
    constexpr unsigned int patience = 8;
  } // namespace

  /// The loops as the parameters ask for them; where a merged iteration fails, once more with the geometry as a loop,
  /// and at last with all three as loops.
  void ContactProblem::Implementation::solve_increment()
  {
    counts = IterationCounts();
    merged = {parameters.geometry_loop.mode == LoopParameters::Mode::newton,
              parameters.threshold_loop.mode == LoopParameters::Mode::newton && status->has_friction(),
              parameters.status_loop.mode == LoopParameters::Mode::newton};
    while (merged.any())
      try
      {
        solve_loops();
        return;
      }
      catch (const SolverFailure &failure)
      {
        MergedLoops fewer;
        if (merged.geometry)
          fewer = {false, merged.threshold, merged.status};
        console.remark(std::string("merged iteration given up: ") + failure.what() + "; again with " +
                       (fewer.any() ? "a geometry loop" : "three loops"));
        roll_back();
        merged = fewer;
        ++counts.fallbacks;
      }
    solve_loops();
  }

  /// Three nested loops around Newton (theory section 6); those merged into Newton are passed through once.
  void ContactProblem::Implementation::solve_loops()
  {
    status->begin_increment();
    surfaces->gather(committed.block(0), u_start);
    const Newton newton(parameters.newton, merged.any() ? patience : 0);

    FixedPointLoop geometry("geometry", parameters.geometry_loop);
    do
    {
      pair_surfaces();

      FixedPointLoop threshold("threshold", parameters.threshold_loop);
      do
      {
        {
          const auto timer = profile.time(Phase::status);
          if (!merged.threshold)
            status->freeze_threshold(site_pressure(weights, *status, state.lambda));
          status->begin_loop(merged.status);
        }

        FixedPointLoop statuses("status", parameters.status_loop);
        do
        {
          pass.geometry  = geometry.counter() + 1;
          pass.threshold = threshold.counter() + 1;
          pass.status    = statuses.counter() + 1;
          newton_starts  = true;

          newton.solve(*this,
                       [&](const unsigned int iteration, const Norms &norms, const unsigned int krylov)
                       {
                         console.newton_iteration(pass, iteration, norms, krylov);
                         counts.newton += iteration > 0;
                         counts.krylov += krylov;
                         profile.newton_iterations += iteration > 0;
                         profile.krylov_iterations += krylov;
                       });
        } while (!statuses_converged(statuses));
      } while (!threshold_converged(threshold));
    } while (!geometry_converged(geometry));
  }

  bool ContactProblem::Implementation::statuses_converged(FixedPointLoop &loop)
  {
    ++counts.status;
    if (merged.status)
      return true;
    const Status::Update update = update_statuses();
    return loop.finished(update.changes, update.changes > 0 ? site_locus(update.sites.front()) : "");
  }

  Status::Update ContactProblem::Implementation::update_statuses(const bool closing_only)
  {
    const auto           timer  = profile.time(Phase::status);
    const Status::Update update = status->update(
        status_input(parameters.contact_pairs, *surfaces, pairing, weights, *status, *contact, state), closing_only);
    if (update.changes > 0)
    {
      console.remark(std::to_string(update.changes) + " statuses changed, first at " +
                     site_locus(update.sites.front()));
      if (update.cycles)
      {
        std::string nodes;
        for (const unsigned int k : cycling)
          nodes += (nodes.empty() ? "" : "; ") + site_locus(k);
        throw SolverFailure(
            (merged.status ? "the statuses cycle" : "the status loop cycles, also with one change at a time") +
            std::string("; the nodes that change back and forth: ") + nodes);
      }
      if (update.period > 0)
      {
        cycling.assign(update.sites.begin(), update.sites.begin() + std::min<std::size_t>(3, update.sites.size()));
        console.remark("these statuses were met " + std::to_string(update.period) +
                       (merged.status ? " iterations ago" : " passes ago: from here one node changes at a time"));
      }
    }
    return update;
  }

  bool ContactProblem::Implementation::threshold_converged(FixedPointLoop &loop)
  {
    ++counts.threshold;
    if (merged.threshold)
      return true;
    if (!status->has_friction())
      return loop.finished(0., "");
    const auto           timer  = profile.time(Phase::status);
    const Status::Change change = status->threshold_change(site_pressure(weights, *status, state.lambda));
    std::ostringstream   text;
    text << "threshold changes by " << change.value << ", most at " << site_locus(change.site);
    console.remark(text.str());
    return loop.finished(change.value, site_locus(change.site));
  }

  bool ContactProblem::Implementation::geometry_converged(FixedPointLoop &loop)
  {
    ++counts.geometry;
    if (merged.geometry)
      return true;
    const auto           timer = profile.time(Phase::pairing);
    std::vector<Vector3> u;
    surfaces->gather(solution.block(0), u);
    const double change = largest_entry(u, u_geometry);
    const double step   = largest_entry(u_geometry, u_start);
    const double value  = change <= 1e-12 * length_scale ? 0. : step > 0. ? change / step : 1.;

    unsigned int worst = 0;
    for (unsigned int i = 1; i < u.size(); ++i)
      if ((u[i] - u_geometry[i]).norm() > (u[worst] - u_geometry[worst]).norm())
        worst = i;
    std::ostringstream text;
    text << "geometry changes by " << value << " of the step, most at "
         << (u.empty() ? "" : coordinates(surfaces->nodes()[worst].X));
    console.remark(text.str());

    // The solution of two passes ago again, while it differs from that of the last one: a 2-cycle.
    if (loop.counter() >= 3 && value > parameters.geometry_loop.tolerance &&
        largest_entry(u, u_before_geometry) <= 1e-6 * change)
      throw SolverFailure("the geometry loop cycles with period 2, criterion " + std::to_string(value) + ", worst at " +
                          coordinates(surfaces->nodes()[worst].X) +
                          ": a slave node crosses an edge of the faceted master and back; try 'Normal = averaged' or "
                          "smaller increments");
    return loop.finished(value, u.empty() ? "" : coordinates(surfaces->nodes()[worst].X));
  }

  void ContactProblem::Implementation::commit()
  {
    std::vector<std::array<double, 2>> slip;
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      slip.push_back(contact->slip(state, s));
    status->commit(slip);
    committed         = solution;
    committed_pairing = pairing;
    committed_area    = weights.area();
  }

  void ContactProblem::Implementation::roll_back()
  {
    solution   = committed;
    pairing    = committed_pairing;
    nodal_area = committed_area;
    status->roll_back();
    gather_state();
  }
} // namespace Nodus
