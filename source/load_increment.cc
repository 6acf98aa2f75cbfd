#include <nodus/contact/site_values.h>
#include <nodus/contact_problem_implementation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <cmath>
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

    /// Forces below this fraction of stiffness times displacement are not resolved to the tolerance of Newton (1e-8).
    constexpr double relative_force_floor = 1e-5;
  } // namespace

  std::string coordinates(const Point &X)
  {
    std::ostringstream text;
    text << "(" << X << ")";
    return text.str();
  }

  /// The three nested fixed-point loops around Newton (theory section 6).
  void ContactProblem::Implementation::solve_increment()
  {
    counts = IterationCounts();
    status->begin_increment();
    surfaces->gather(committed.block(0), u_start);
    const Newton newton(parameters.newton);

    FixedPointLoop geometry("geometry", parameters.geometry_loop);
    do
    {
      pair_surfaces();

      FixedPointLoop threshold("threshold", parameters.threshold_loop);
      do
      {
        status->freeze_threshold(site_pressure(weights, *status, state.lambda));
        status->begin_loop();

        FixedPointLoop statuses("status", parameters.status_loop);
        do
        {
          pass.geometry  = geometry.counter() + 1;
          pass.threshold = threshold.counter() + 1;
          pass.status    = statuses.counter() + 1;
          const auto report =
              newton.solve(*this,
                           [&](const unsigned int iteration, const Norms &norms, const unsigned int krylov)
                           { console.newton_iteration(pass, iteration, norms, krylov); });
          counts.newton += report.iterations;
          counts.krylov += report.krylov_iterations;
        } while (!statuses_converged(statuses));
      } while (!threshold_converged(threshold));
    } while (!geometry_converged(geometry));
  }

  /// Freezes the geometry: projections, frames, jump operator and surface weights at the current positions.
  void ContactProblem::Implementation::pair_surfaces()
  {
    const auto    timer  = console.time("pairing");
    const Pairing before = pairing;
    gather_state();
    u_before_geometry = u_geometry;
    surfaces->gather(solution.block(0), u_geometry);

    const auto              &pairs = parameters.contact_pairs;
    const std::vector<Point> X     = surfaces->positions(std::vector<Vector3>(surfaces->nodes().size()));
    const ContactGeometry    geometry(pairs, *surfaces, state.x);
    AveragedJump             averaged;
    averaged.compute(pairs, *surfaces, geometry, state.x, X);
    pairing.project(pairs, *surfaces, geometry, averaged);
    jump.build(pairs, *surfaces, geometry, pairing, averaged);
    weights.compute(pairs, *surfaces, averaged, state.x, X);

    if (!paired_before)
    {
      std::vector<double> distance;
      for (unsigned int k = 0; k < pairing.size(); ++k)
        distance.push_back(contact->distance(state, k));
      status->initialize(pairing, distance);
      paired_before = true;
      return;
    }
    status->inherit(pairing);

    // Lambda keeps its direction in space and its length in the new tangent planes; nodes without partner lose all.
    const auto owned = surfaces->owned_slave_nodes();
    for (unsigned int k = owned.first; k < owned.second; ++k)
    {
      Vector3 Lambda;
      for (unsigned int i = 0; i < 2; ++i)
        Lambda += state.Lambda[k][i] * before[k].tangent[i];
      double component[2] = {0., 0.};
      for (unsigned int i = 0; i < 2; ++i)
        if (pairing[k].found && pairing[k].tangent_free[i])
          component[i] = Lambda * pairing[k].tangent[i];
      const double norm = std::hypot(component[0], component[1]);
      for (unsigned int i = 0; i < 2; ++i)
        solution.block(2)(2 * k + i) = norm > 0. ? component[i] * Lambda.norm() / norm : 0.;
      solution.block(1)(k) = pairing[k].found ? state.lambda[k] : 0.;
    }
    solution.block(1).compress(dealii::VectorOperation::insert);
    solution.block(2).compress(dealii::VectorOperation::insert);
    gather_state();
  }

  bool ContactProblem::Implementation::statuses_converged(FixedPointLoop &loop)
  {
    const Status::Update update =
        status->update(status_input(parameters.contact_pairs, *surfaces, pairing, weights, *status, *contact, state));
    ++counts.status;
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
            "the status loop cycles, also with one change at a time; the nodes that change back and forth: " + nodes);
      }
      if (update.period > 0)
      {
        cycling.assign(update.sites.begin(), update.sites.begin() + std::min<std::size_t>(3, update.sites.size()));
        console.remark("these statuses were met " + std::to_string(update.period) +
                       " passes ago: from here one node changes at a time");
      }
    }
    return loop.finished(update.changes, update.changes > 0 ? site_locus(update.sites.front()) : "");
  }

  bool ContactProblem::Implementation::threshold_converged(FixedPointLoop &loop)
  {
    ++counts.threshold;
    if (!status->has_friction())
      return loop.finished(0., "");
    const Status::Change change = status->threshold_change(site_pressure(weights, *status, state.lambda));
    std::ostringstream   text;
    text << "threshold changes by " << change.value << ", most at " << site_locus(change.site);
    console.remark(text.str());
    return loop.finished(change.value, site_locus(change.site));
  }

  bool ContactProblem::Implementation::geometry_converged(FixedPointLoop &loop)
  {
    ++counts.geometry;
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

  void ContactProblem::Implementation::gather_state()
  {
    std::vector<Vector3> u;
    surfaces->gather(solution.block(0), u);
    state.x = surfaces->positions(u);
    state.increment.resize(u.size());
    state.prescribed.resize(u.size());
    for (unsigned int i = 0; i < u.size(); ++i)
      state.increment[i] = u[i] - u_start[i];

    // Multipliers live with their owners; the nodal arrays are replicated.
    const unsigned int  n     = surfaces->slave_nodes().size();
    const auto          owned = surfaces->owned_slave_nodes();
    std::vector<double> all(3 * n, 0.);
    for (unsigned int k = owned.first; k < owned.second; ++k)
    {
      all[3 * k]     = solution.block(1)(k);
      all[3 * k + 1] = solution.block(2)(2 * k);
      all[3 * k + 2] = solution.block(2)(2 * k + 1);
    }
    dealii::Utilities::MPI::sum(all, communicator, all);
    state.lambda.resize(n);
    state.Lambda.resize(n);
    for (unsigned int k = 0; k < n; ++k)
    {
      state.lambda[k] = all[3 * k];
      state.Lambda[k] = {{all[3 * k + 1], all[3 * k + 2]}};
    }
  }

  NewtonProblem::Norms ContactProblem::Implementation::assemble()
  {
    relevant_u              = solution.block(0);
    const auto &constraints = boundary_conditions->increment_constraints(relevant_u);
    {
      const auto timer = console.time("bulk assembly");
      solid->tangent(relevant_u, time, constraints, system.bulk, system.rhs.block(0), internal, external);
    }

    const auto timer = console.time("contact assembly");
    gather_state();
    Norms  norms;
    Vector prescribed(surfaces->layout().owned[0], communicator);
    for (const auto i : surfaces->layout().owned[0])
      if (constraints.is_constrained(i))
        prescribed(i) = constraints.get_inhomogeneity(i);
    prescribed.compress(dealii::VectorOperation::insert);
    surfaces->gather(prescribed, state.prescribed);

    residual      = contact->assemble(state, system);
    contact_force = 0.;
    contact->add_forces(residual, contact_force);

    Vector moved(solution.block(0));
    moved -= committed.block(0);
    const double length = std::max(moved.linfty_norm(), length_scale);
    if (stiffness_scale == 0.)
    {
      stiffness_scale = system.bulk.largest_diagonal();
    }
    // The last term is round-off: without it a body that only translates would be measured against its own noise.
    const double scale = std::max({internal.linfty_norm(),
                                   external.linfty_norm(),
                                   contact_force.linfty_norm(),
                                   relative_force_floor * stiffness_scale * length});
    double       force = 0.;
    for (const auto i : surfaces->layout().owned[0])
      if (!constraints.is_constrained(i))
        force = std::max(force, std::abs(internal(i) - external(i) + contact_force(i)));
    force            = dealii::Utilities::MPI::max(force, communicator);
    norms.force      = scale > 0. ? force / scale : 0.;
    norms.contact    = contact->norm(residual, length);
    norms.prescribed = prescribed.linfty_norm() / length;
    return norms;
  }

  unsigned int ContactProblem::Implementation::solve(BlockVector &correction)
  {
    const auto                 timer  = console.time("linear solver");
    const LinearSolver::Report report = linear_solver->solve(system, correction);
    if (!report.null_pivots.empty())
      throw SolverFailure("the system is singular (" + std::to_string(report.null_pivots.size()) +
                          " null pivots), first at " + unknown_locus(report.null_pivots.front()));
    const long surplus = report.negative_pivots - 3 * static_cast<long>(surfaces->layout().n_slave_nodes);
    if (report.negative_pivots >= 0 && surplus != 0)
      console.remark("the tangent has " + std::to_string(std::abs(surplus)) + " negative eigenvalues " +
                     (surplus > 0 ? "more" : "less") + " than multipliers: the state is not stable");
    // The solver leaves prescribed components alone: they take what the constraints still ask for.
    boundary_conditions->increment_constraints(relevant_u).distribute(correction.block(0));
    return report.iterations;
  }

  void ContactProblem::Implementation::advance(const double factor, const BlockVector &correction)
  {
    solution.add(factor, correction);
  }

  std::string ContactProblem::Implementation::site_locus(const unsigned int site) const
  {
    if (site >= surfaces->n_sites())
      return "";
    const unsigned int p    = surfaces->pair(site);
    const auto        &name = parameters.contact_pairs[p].name;
    return (surfaces->is_point(site) ? "integration point " : "slave node ") +
           coordinates(surfaces->site_position(site)) + " of contact pair " + std::to_string(p + 1) +
           (name.empty() ? "" : " ('" + name + "')");
  }

  std::string ContactProblem::Implementation::unknown_locus(const DoFIndex flat_index) const
  {
    const BlockLayout &layout = surfaces->layout();
    if (flat_index >= layout.lambda(0))
    {
      const bool         pressure = flat_index < layout.Lambda(0, 0);
      const unsigned int k        = pressure ? flat_index - layout.lambda(0) : (flat_index - layout.Lambda(0, 0)) / 2;
      return (pressure ? "the contact multiplier of " : "the friction multiplier of ") + site_locus(k) +
             ": this constraint repeats another one (over-constraint)";
    }
    std::map<DoFIndex, Point> points;
    dealii::DoFTools::map_dofs_to_support_points(*mapping, dof_handler, points);
    const auto  owner = points.find(flat_index);
    std::string here =
        owner == points.end() || !surfaces->layout().owned[0].is_element(flat_index) ? "" : coordinates(owner->second);
    for (const auto &part : dealii::Utilities::MPI::all_gather(communicator, here))
      if (!part.empty())
        here = part;
    return "the displacement of node " + here +
           ": its body is free to move; hold it with a boundary condition, or close the contact first ('Initial status "
           "= closed')";
  }

  void ContactProblem::Implementation::commit()
  {
    std::vector<std::array<double, 2>> slip;
    for (unsigned int s = 0; s < surfaces->n_sites(); ++s)
      slip.push_back(contact->slip(state, s));
    status->commit(slip);
    committed = solution;
  }

  void ContactProblem::Implementation::roll_back()
  {
    solution = committed;
    status->roll_back();
  }
} // namespace Nodus
