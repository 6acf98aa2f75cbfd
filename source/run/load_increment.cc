#include "contact/site_values.h"
#include "run/contact_problem_implementation.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Newton iterations without progress after which a merged iteration is given up.
    constexpr unsigned int patience = 8;
    /// Geometry passes that change more than this fraction of the one before are mixed with those before it; with
    /// rigid bodies that forces drive, those that change more than the second are damped.
    constexpr double plain_contraction = 0.3, slow_contraction = 0.9;
    /// Times that a geometry loop may come back to the pass before the last.
    constexpr unsigned int tolerated_geometry_cycles = 2;
    /// Sites whose statuses cycle may contradict them by this much, of the largest pressure or of the cone.
    constexpr double tolerated_violation = 1e-3;
  } // namespace

  std::string MergedLoops::names() const
  {
    std::string text;
    for (const auto &[name, is_merged] :
         {std::make_pair("geometry", geometry), {"threshold", threshold}, {"status", status}})
      if (is_merged)
        text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
  }

  /// The loops as the parameters ask for them; where a merged iteration fails, once more with the geometry as a loop,
  /// then, with friction, from a first iterate that growing friction leads to, then with geometry and statuses as loops
  /// around thresholds that follow the pressure, which frozen ones need not contract to, and at last with all three. In
  /// each of these attempts laws hold in the mean from where statuses cycle, if sites share multipliers
  /// (Status::regularise). Where thresholds were to be a loop and that fails, they follow the pressure.
  void ContactProblem::Implementation::solve_increment()
  {
    struct Attempt
    {
      MergedLoops merged;
      bool        approach;
      const char *name;
    };
    counts = IterationCounts();
    direct_solver.reset();
    const bool        friction = status->has_friction();
    const auto       &pairs    = parameters.contact_pairs;
    const bool        slides   = friction && std::any_of(pairs.begin(),
                                                pairs.end(),
                                                [](const ContactPairParameters &pair) {
                                                  return pair.contact_law != ContactPairParameters::ContactLaw::tied;
                                                });
    const MergedLoops asked    = {parameters.geometry_loop.mode == LoopParameters::Mode::newton,
                                  parameters.threshold_loop.mode == LoopParameters::Mode::newton && friction,
                                  parameters.status_loop.mode == LoopParameters::Mode::newton};
    const MergedLoops inner    = {false, asked.threshold, asked.status};

    std::vector<Attempt> attempts{{asked, false, ""}};
    if (asked.geometry && inner.any())
      attempts.push_back({inner, false, "a geometry loop"});
    if (slides && asked.status && time != path.time()) // on a new mesh friction is there already
      attempts.push_back({inner, true, "a geometry loop and growing friction"});
    if (asked.threshold && asked.status)
      attempts.push_back({{false, true, false}, false, "geometry and status loops"});
    if (asked.any())
      attempts.push_back({MergedLoops(), false, "three loops"});
    if (parameters.threshold_loop.mode != LoopParameters::Mode::newton && status->threshold_follows_pressure())
      attempts.push_back({{false, true, false}, false, "the coupled threshold"});

    for (auto attempt = attempts.begin();; ++attempt)
      try
      {
        merged   = attempt->merged;
        singular = false;
        status->begin_increment();
        // closed sites have a partner, of which checkpoints know, too
        std::vector<char> closed(status->size());
        for (unsigned int s = 0; s < closed.size(); ++s)
          closed[s] = status->contact(s) ? 1 : 0;
        pairing.set_partnered(std::move(closed));
        diagnosis.begin_attempt(merged.names() + (attempt->approach ? "; friction grows" : ""));
        if (attempt->approach)
          approach_friction();
        else
          solve_loops();
        return;
      }
      catch (const SolverFailure &failure)
      {
        approaches = false;
        status->set_friction_fraction(1.);
        // without contact all attempts have the same system
        if (attempt + 1 == attempts.end() || (begins_singular() && n_closed() == 0))
          throw;
        console.remark((merged.any() ? "merged iteration given up: " : "three loops given up: ") +
                       std::string(failure.what()) + "; again with " + attempt[1].name);
        diagnosis.end_attempt(failure.what());
        roll_back();
        ++counts.fallbacks;
      }
  }

  /// Three nested loops around Newton (theory section 6); those merged into Newton are passed through once.
  void ContactProblem::Implementation::solve_loops()
  {
    rigid_waits = 0;
    const Newton newton(parameters.newton, merged.any() ? patience : 0);

    FixedPointLoop geometry("geometry", parameters.geometry_loop);
    AndersonMixing mixing;
    geometry_cycles = 0;
    do
    {
      pair_surfaces();

      FixedPointLoop     threshold("threshold", parameters.threshold_loop);
      SecantAcceleration secant(communicator);
      do
      {
        {
          const auto timer = profile.time(Phase::status);
          if (!merged.threshold && threshold.counter() == 0)
            freeze_threshold();
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
                         pass.fallbacks = counts.fallbacks;
                         const Tables::Iteration row{path.increment(), time, pass, iteration, norms, krylov};
                         tables->add(row);
                         diagnosis.add(row);
                         heed_signals();
                         counts.newton += iteration > 0;
                         counts.krylov += krylov;
                         profile.newton_iterations += iteration > 0;
                         profile.krylov_iterations += krylov;
                       });
        } while (!statuses_converged(statuses));
      } while (!threshold_converged(threshold, secant));
    } while (!geometry_converged(geometry, mixing));
    if (!merged.status)
      check_frozen_statuses();
  }

  void
  ContactProblem::Implementation::note_pass(const FixedPointLoop &loop, const double value, const std::string &worst)
  {
    diagnosis.add(Diagnosis::Pass{loop.name(), loop.counter() + 1, value, loop.tolerance(), worst});
  }

  bool ContactProblem::Implementation::statuses_converged(FixedPointLoop &loop)
  {
    ++counts.status;
    if (merged.status)
      return true;
    const Status::Update update = update_statuses();
    tables->add_status_changes(update.changes);
    note_pass(loop, update.changes, first_changed);
    if (update.frozen > 0)
      console.remark("the statuses cycle: " + std::to_string(update.frozen) +
                     " sites keep the one that they contradict least: " + cycling);
    return loop.finished(update.changes, first_changed);
  }

  /// Once all loops have converged: thresholds that are not final leave nodes neither open nor closed.
  void ContactProblem::Implementation::check_frozen_statuses()
  {
    const Status::Violation violation = status->frozen_violation(
        status_input(parameters.contact_pairs, *surfaces, pairing, weights, *status, *contact, state));
    if (violation.sites > 0)
    {
      const std::string  locus = site_locus(violation.site);
      std::ostringstream text;
      text << violation.sites << " sites whose statuses cycled contradict them, the worst by " << violation.value
           << " of the largest pressure or of the cone, at " << locus;
      if (violation.value > tolerated_violation)
        throw SolverFailure("the status loop cycles: " + text.str() + ", more than " +
                                dealii::Utilities::to_string(tolerated_violation),
                            SolverFailure::Kind::status_cycle);
      console.remark("warning: " + text.str());
    }
  }

  Status::Update ContactProblem::Implementation::update_statuses(const bool closing_only)
  {
    const auto           timer  = profile.time(Phase::status);
    const Status::Update update = status->update(
        status_input(parameters.contact_pairs, *surfaces, pairing, weights, *status, *contact, state), closing_only);
    std::vector<char> statuses(status->size());
    for (unsigned int s = 0; s < statuses.size(); ++s)
      statuses[s] = static_cast<char>(status->status(s));
    diagnosis.add_statuses(statuses);
    if (update.changes > 0)
    {
      const std::vector<std::string> loci = site_loci(update.sites, 3);
      first_changed                       = loci.front();
      console.remark(std::to_string(update.changes) + " statuses changed, first at " + first_changed);
      if (update.cycles)
        throw SolverFailure("the statuses cycle; the nodes that change back and forth: " + cycling,
                            SolverFailure::Kind::status_cycle);
      if (update.to_regularised)
      {
        console.remark("the statuses cycle: from here the laws hold in the mean (multipliers projected at integration "
                       "points, weights lumped)");
        pass_to_regularised_law();
        ++counts.fallbacks;
      }
      else if (update.period > 0)
      {
        cycling.clear();
        for (const std::string &locus : loci)
          cycling += (cycling.empty() ? "" : "; ") + locus;
        console.remark("these statuses were met " + std::to_string(update.period) +
                       (merged.status ? " iterations ago" : " passes ago: from here one node changes at a time"));
      }
    }
    return update;
  }

  bool ContactProblem::Implementation::threshold_converged(FixedPointLoop &loop, SecantAcceleration &secant)
  {
    ++counts.threshold;
    if (merged.threshold)
      return true;
    if (!status->has_friction())
      return loop.finished(0., "");
    const auto timer = profile.time(Phase::status);
    update_slip_rates();
    const std::vector<double> pressure = site_pressure(*surfaces, weights, *status, state.lambda);
    const Status::Change      change   = status->threshold_change(pressure);
    const std::string         worst    = site_locus(change.site);
    std::vector<double>       next     = secant.next(status->thresholds(), status->thresholds_at(pressure));
    std::ostringstream        text;
    text << "threshold changes by " << change.value << ", most at " << worst;
    if (secant.contraction() > 0.)
      text << ", " << secant.contraction() << " times the change before";
    console.remark(text.str());
    note_pass(loop, change.value, worst);
    if (loop.finished(change.value, worst))
      return true;
    status->freeze(std::move(next));
    return false;
  }

  bool ContactProblem::Implementation::geometry_converged(FixedPointLoop &loop, AndersonMixing &mixing)
  {
    ++counts.geometry;
    if (merged.geometry || approaches)
      return true;
    const auto   timer = profile.time(Phase::pairing);
    std::string  worst;
    const double change = largest_difference(solution.block(0), u_geometry, &worst);
    const double step   = largest_difference(u_geometry, committed.block(0));
    const double value  = change <= 1e-12 * length_scale ? 0. : step > 0. ? change / step : 1.;

    std::ostringstream text;
    text << "geometry changes by " << value << " of the step, most at " << worst;
    console.remark(text.str());
    note_pass(loop, value, worst);
    const double before = loop.value();
    if (loop.finished(value, worst))
      return true;

    // The solution of two passes ago again, while it differs from that of the last one: a 2-cycle; one that comes back
    // is no fixed point.
    const bool cycle = loop.counter() >= 3 && largest_difference(solution.block(0), u_before_geometry) <= 1e-6 * change;
    if (cycle && ++geometry_cycles > tolerated_geometry_cycles)
      throw SolverFailure(
          "the geometry loop cycles with period 2, criterion " + std::to_string(value) + ", worst at " + worst +
              ": a slave node crosses an edge of the faceted master and back; try 'Normal = averaged' or "
              "smaller increments",
          SolverFailure::Kind::geometry_cycle);
    if (rigid_bodies->size() == 0)
    {
      Vector correction(solution.block(0));
      correction -= u_geometry;
      const bool mix    = loop.counter() >= 3 && value > plain_contraction * before;
      solution.block(0) = mixing.next(correction, mix);
      solution.block(0) += u_geometry;
      if (mix)
      {
        console.remark("the geometry loop is slow: the next pass starts where the last ones lead to");
        gather_state();
      }
      return false;
    }
    if (cycle || (loop.counter() >= 3 && value > slow_contraction * before))
    {
      console.remark(cycle ? "the geometry loop cycles with period 2: the next pass starts half-way"
                           : "the geometry loop does not contract: the next pass starts half-way");
      solution.block(0).sadd(0.5, 0.5, u_geometry);
      auto unknowns = rigid_bodies->unknowns();
      for (unsigned int b = 0; b < unknowns.size(); ++b)
        unknowns[b] = {0.5 * (unknowns[b].translation + rigid_geometry[b].translation),
                       0.5 * (unknowns[b].rotation + rigid_geometry[b].rotation)};
      rigid_bodies->set_unknowns(unknowns);
      rigid_bodies->move(solution.block(0));
      gather_state();
    }
    return false;
  }

  /// Largest difference of two displacements at a surface node, and where it is. Collective.
  double
  ContactProblem::Implementation::largest_difference(const Vector &a, const Vector &b, std::string *const worst) const
  {
    std::vector<Vector3> u, v;
    surfaces->gather(a, u);
    surfaces->gather(b, v);
    double      largest = 0.;
    std::string here    = u.empty() ? "" : coordinates(surfaces->nodes()[0].X);
    for (unsigned int i = 0; i < u.size(); ++i)
      if (const double difference = (u[i] - v[i]).norm(); difference > largest)
      {
        largest = difference;
        here    = coordinates(surfaces->nodes()[i].X);
      }
    const auto all = dealii::Utilities::MPI::min_max_avg(largest, communicator);
    if (worst != nullptr)
      *worst = dealii::Utilities::MPI::broadcast(communicator, here, all.max_index);
    return all.max;
  }

  /// The increment converged: keeps all that the next one starts from, which is also what a checkpoint holds. History
  /// that is not kept here and rolled back below would make the result depend on increments that failed.
  void ContactProblem::Implementation::commit()
  {
    std::vector<std::array<double, 2>> slip;
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      slip.push_back(status->holds_friction(s) ? std::array<double, 2>{{0., 0.}} : contact->slip(state, s));
    status->commit(slip);
    solid->commit();
    audit_energies();
    rigid_bodies->commit(rigid_applied);
    committed                    = solution;
    committed_pairing            = pairing;
    committed_area               = weights.area();
    const std::vector<Vector3> u = surface_displacement();
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      committed_site_jump[s] = jump.jump(s, u);
    mesh_is_new = false;
    jump.set_stuck({});
    committed_stiffness_scale = stiffness_scale;
    const bool on_new_mesh    = time == path.time();
    if (on_new_mesh ? time == path.interval_begin() : path.ends_interval())
    {
      const auto &constraints = boundary_conditions->homogeneous_constraints();
      for (const DoFIndex i : surfaces->layout().owned[0])
        reaction(i) = constraints.is_constrained(i) ? internal(i) - external(i) + contact_force(i) : 0.;
      reaction.compress(dealii::VectorOperation::insert);
    }
  }

  void ContactProblem::Implementation::roll_back()
  {
    solution        = committed;
    pairing         = committed_pairing;
    nodal_area      = committed_area;
    stiffness_scale = committed_stiffness_scale;
    rigid_bodies->roll_back();
    status->roll_back();
    solid->roll_back();
    gather_state();
  }
} // namespace Nodus
