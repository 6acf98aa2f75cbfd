#include "contact/geometry_tangent.h"
#include "contact/site_values.h"
#include "mesh/sides.h"
#include "parallel/owned_values.h"
#include "run/contact_problem_implementation.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Forces below this fraction of stiffness times displacement are not resolved to the tolerance of Newton (1e-8).
    constexpr double relative_force_floor = 1e-5;
    /// Relative force residual up to which an iterate right after a prescribed motion has all its statuses tested.
    constexpr double settled_force = 1e-3;
    /// Displacements up to which the direct solver steps in for an iterative one that fails.
    constexpr DoFIndex largest_direct = 150000;
  } // namespace

  std::string coordinates(const Point &X)
  {
    std::ostringstream text;
    text << "(" << without_round_off(X, 1e-6 * X.norm()) << ")";
    return text.str();
  }

  std::string in_brackets(const std::string &name)
  {
    return name.empty() ? "" : " (" + name + ")";
  }

  /// Thresholds of the present pressures and, where friction depends on them, of the present slip rates.
  void ContactProblem::Implementation::freeze_threshold()
  {
    update_slip_rates();
    status->freeze_threshold(site_pressure(*surfaces, weights, *status, state.lambda));
  }

  void ContactProblem::Implementation::update_slip_rates()
  {
    if (!status->friction_varies() || time == path.time()) // equilibrium on a new mesh: the rates stay
      return;
    std::vector<double> rate(surfaces->n_sites(), 0.);
    for (unsigned int s = 0; s < rate.size(); ++s)
      if (surfaces->is_owned(s))
      {
        const auto slip = contact->slip(state, s);
        rate[s]         = std::hypot(slip[0], slip[1]) / (time - path.time());
      }
    status->set_slip_rates(rate);
  }

  void ContactProblem::Implementation::gather_state()
  {
    std::vector<Vector3> u, u_start;
    surfaces->gather(solution.block(0), u);
    surfaces->gather(committed.block(0), u_start);
    state.x = surfaces->positions(u);
    state.centre.resize(rigid_bodies->size());
    for (unsigned int b = 0; b < rigid_bodies->size(); ++b)
      state.centre[b] = rigid_bodies->centre(b);
    state.increment.resize(u.size());
    state.prescribed.resize(u.size());
    for (unsigned int i = 0; i < u.size(); ++i)
      state.increment[i] = u[i] - u_start[i];

    const unsigned int  n = surfaces->slave_nodes().size();
    std::vector<double> all(3 * n, 0.);
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
    {
      const DoFIndex multiplier = surfaces->multiplier(k);
      all[3 * k]                = solution.block(1)(multiplier);
      all[3 * k + 1]            = solution.block(2)(2 * multiplier);
      all[3 * k + 2]            = solution.block(2)(2 * multiplier + 1);
    }
    surfaces->slave_exchange().update(all, 3);
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
    const bool first        = std::exchange(newton_starts, false);
    relevant_u              = solution.block(0);
    const auto &constraints = boundary_conditions->increment_constraints(relevant_u);
    {
      const auto timer = profile.time(Phase::bulk_assembly);
      solid->tangent(relevant_u, time, constraints, system.bulk, system.rhs.block(0), internal, external);
      external += released;
      system.rhs.block(0) += released;
      if (stabilisation->acts())
      {
        Vector moved(solution.block(0));
        moved -= committed.block(0);
        drag = 0.;
        stabilisation->add(moved, constraints, system.bulk, drag);
        drag_rigid_bodies(moved);
        external += drag;
        system.rhs.block(0) += drag;
      }
    }
    if (merged.geometry && !first)
      pair_surfaces();
    {
      const auto timer = profile.time(Phase::contact_assembly);
      gather_state();
    }
    if (merged.threshold)
      follow_pressure();

    const Vector bulk_rhs(system.rhs.block(0));
    Norms        norms = assemble_contact(constraints);
    if (std::exchange(motions_unknown, false))
      warn_of_free_motions();
    // Newton starts with the statuses that it inherits. Where prescribed displacements have just moved the boundary and
    // left the bulk out of balance, gaps count but pressures do not.
    const bool moved     = std::exchange(prescribed_before, norms.prescribed) > parameters.newton.contact_tolerance;
    const bool unsettled = !first && moved && norms.force > settled_force;
    if (merged.status && (!first || Newton(parameters.newton).converged(norms)))
      if (const unsigned int changes = update_statuses(unsettled).changes; changes > 0)
      {
        system.rhs.block(0) = bulk_rhs;
        norms               = assemble_contact(constraints);
        norms.changes       = changes;
      }
    if (merged.geometry)
    {
      const auto timer = profile.time(Phase::contact_assembly);
      GeometryTangent(parameters.contact_pairs, *surfaces, *geometry, averaged, pairing, jump, weights, *status)
          .add(state, residual, system);
    }
    return norms;
  }

  void ContactProblem::Implementation::follow_pressure()
  {
    const auto          timer = profile.time(Phase::status);
    std::vector<double> before(status->size());
    for (unsigned int k = 0; k < before.size(); ++k)
      before[k] = status->friction(k) ? status->threshold(k) : 0.;
    freeze_threshold();

    // Sticking nodes keep their friction traction mu lambda Lambda: as unknown of the iteration it is linear.
    for (const ContactPoint &point : weights.points())
      if (const unsigned int k = point.slaves[0]; point.slaves.size() == 1 && surfaces->is_owned(k) &&
                                                  before[k] != 0. && status->friction(k) && status->stick(k))
        for (unsigned int i = 0; i < 2; ++i)
          solution.block(2)(2 * surfaces->multiplier(k) + i) = state.Lambda[k][i] * before[k] / status->threshold(k);
    solution.block(2).compress(dealii::VectorOperation::insert);
    gather_state();
  }

  NewtonProblem::Norms
  ContactProblem::Implementation::assemble_contact(const dealii::AffineConstraints<double> &constraints)
  {
    const auto  timer = profile.time(Phase::contact_assembly);
    Norms       norms;
    const auto &owned = surfaces->layout().owned[0];
    Vector      prescribed(contact_force); // its map: a new one would be collective
    prescribed = 0.;
    const OwnedValues given(prescribed);
    for (const auto i : owned)
      if (constraints.is_constrained(i))
        given(i) = constraints.get_inhomogeneity(i);
    surfaces->gather(prescribed, state.prescribed);

    residual      = contact->assemble(state, system, merged.threshold);
    contact_force = 0.;
    contact->add_forces(residual, contact_force);

    Vector moved(solution.block(0));
    moved -= committed.block(0);
    const double length = std::max(moved.linfty_norm(), length_scale);
    if (stiffness_scale == 0.)
      stiffness_scale = system.bulk.largest_diagonal();
    // The last term is round-off: without it a body that only translates would be measured against its own noise.
    const double      scale = std::max({internal.linfty_norm(),
                                        external.linfty_norm(),
                                        contact_force.linfty_norm(),
                                        relative_force_floor * stiffness_scale * length});
    const OwnedValues out(out_of_balance), in(internal), ex(external), on(contact_force);
    for (const auto i : owned)
      out(i) = constraints.is_constrained(i) ? 0. : in(i)-ex(i) + on(i);
    force_scale      = scale;
    norms.force      = scale > 0. ? out_of_balance.linfty_norm() / scale : 0.;
    norms.contact    = contact->norm(residual, length);
    norms.prescribed = prescribed.linfty_norm() / length;
    add_rigid_norms(length, norms);
    return norms;
  }

  /// An iterative solver that fails leaves the rest of the increment to the direct one, if the system is not too large
  /// for that: its next systems are no easier.
  LinearSolver::Report ContactProblem::Implementation::solve_system(const std::vector<const BlockVector *> &rhs,
                                                                    std::vector<BlockVector>               &corrections,
                                                                    const double relative_tolerance)
  {
    if (!direct_solver)
      try
      {
        return linear_solver->solve(system, rhs, corrections, relative_tolerance);
      }
      catch (const SolverFailure &failure)
      {
        if (linear_solver_parameters.type == LinearSolverParameters::Type::direct ||
            dof_handler.n_dofs() > largest_direct)
          throw;
        console.remark(std::string(failure.what()) +
                       "; this correction comes from the direct solver, and so do those after it in this increment");
        direct_solver = make_linear_solver(LinearSolverParameters(), surfaces->layout(), {});
        direct_solver->set_profile(&profile);
      }
    return direct_solver->solve(system, rhs, corrections, relative_tolerance);
  }

  unsigned int ContactProblem::Implementation::solve(BlockVector &correction, const double relative_tolerance)
  {
    const auto           timer = profile.time(Phase::solver_iterations);
    LinearSolver::Report report;
    if (rigid_bodies->size() > 0)
      report = solve_with_rigid_bodies(correction, relative_tolerance);
    else
    {
      std::vector<BlockVector> corrections;
      report = solve_system({&system.rhs}, corrections, relative_tolerance);
      correction.swap(corrections.front());
    }
    if (!report.null_pivots.empty())
    {
      null_pivot = report.null_pivots.front();
      singular   = null_pivot < surfaces->layout().n_u;
      throw SolverFailure("the system is singular (" + std::to_string(report.null_pivots.size()) +
                              " null pivots), first at " + unknown_locus(null_pivot),
                          singular ? SolverFailure::Kind::free_body : SolverFailure::Kind::over_constraint);
    }
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
    rigid_bodies->advance(factor, rigid_correction);
    rigid_bodies->move(solution.block(0));
  }

  /// Where the first of the sites is that the ranks name. Collective; an invalid number names none.
  std::string ContactProblem::Implementation::site_locus(const unsigned int site) const
  {
    const auto loci =
        site_loci(site < surfaces->n_sites() ? std::vector<unsigned int>{site} : std::vector<unsigned int>(), 1);
    return loci.empty() ? "" : loci.front();
  }

  /// Where the first @p n of the @p sites of all ranks are, owned ones. Collective.
  std::vector<std::string> ContactProblem::Implementation::site_loci(const std::vector<unsigned int> &sites,
                                                                     const unsigned int               n) const
  {
    std::vector<unsigned int> ordered(sites);
    std::sort(ordered.begin(),
              ordered.end(),
              [&](const auto a, const auto b) { return surfaces->order(a) < surfaces->order(b); });
    std::vector<std::pair<DoFIndex, std::string>> first;
    for (unsigned int i = 0; i < std::min<std::size_t>(n, ordered.size()); ++i)
    {
      const unsigned int site = ordered[i], p = surfaces->pair(site);
      const auto        &name = parameters.contact_pairs[p].name;
      first.emplace_back(surfaces->order(site),
                         (surfaces->is_point(site) ? "integration point " : "slave node ") +
                             coordinates(surfaces->site_position(site)) + " of contact pair " + std::to_string(p + 1) +
                             (name.empty() ? "" : " ('" + name + "')"));
    }
    std::vector<std::pair<DoFIndex, std::string>> all;
    for (const auto &part : dealii::Utilities::MPI::all_gather(communicator, first))
      all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    std::vector<std::string> loci;
    for (unsigned int i = 0; i < std::min<std::size_t>(n, all.size()); ++i)
      loci.push_back(all[i].second);
    return loci;
  }

  std::string ContactProblem::Implementation::unknown_locus(const DoFIndex flat_index) const
  {
    const BlockLayout &layout = surfaces->layout();
    if (flat_index >= layout.lambda(0))
    {
      const bool     pressure   = flat_index < layout.Lambda(0, 0);
      const DoFIndex multiplier = pressure ? flat_index - layout.lambda(0) : (flat_index - layout.Lambda(0, 0)) / 2;
      unsigned int   here       = dealii::numbers::invalid_unsigned_int;
      for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
        if (surfaces->multiplier(k) == multiplier)
          here = k;
      return (pressure ? "the contact multiplier of " : "the friction multiplier of ") + site_locus(here) +
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
    return "the displacement of node " + here + ": its body is free to move; " +
           ways_to_hold("hold it with a boundary condition (a soft spring will do)");
  }
} // namespace Nodus
