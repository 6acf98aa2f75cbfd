#include "run/equilibrium.h"
#include "base/text.h"
#include "bulk/cell_corners.h"
#include "mesh/sides.h"
#include "parallel/largest.h"
#include "parallel/owned_values.h"
#include "run/unheld_bodies.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Relative force residual up to which an iterate right after a prescribed motion has all its statuses tested.
    constexpr double settled_force = 1e-3;
    /// Relative force residual that a correction leaves behind, up to which the derivatives of the geometry tell where
    /// pairings go.
    constexpr double linear_geometry = 0.1;
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

  Equilibrium::Equilibrium(Model &model, Journal &journal, States &states)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , driven_(model, states)
      , arc_length_(model, states)
  {
  }

  void Equilibrium::begin_on_mesh()
  {
    const BlockLayout &layout = model_.contact->surfaces().layout();
    system_.layout            = &layout;
    layout.reinit(system_.rhs);
    layout.reinit(iterate_.unknowns);
    u_.reinit(layout.owned[0], model_.relevant, model_.communicator);
    for (Vector *v : {&forces_.internal,
                      &forces_.external,
                      &forces_.contact,
                      &forces_.drag,
                      &forces_.released,
                      &forces_.out_of_balance})
      v->reinit(layout.owned[0], model_.communicator);
    model_.solid->make_sparsity(system_.bulk);
    solver_ = std::make_unique<ChosenSolver>(
        model_.parameters,
        model_.parameters.strategy.uses(Remedy::direct_solver),
        layout,
        DisplacementNodes(OwnedNodes(model_.dof_handler, *model_.mapping).X, cell_corners(model_.dof_handler)),
        journal_.profile,
        [this](const std::string &text)
        {
          journal_.count(Remedy::direct_solver);
          journal_.console.remark(text);
        });
  }

  void Equilibrium::begin_increment(const Increment &increment)
  {
    const bool cut_back = increment.begin == increment_.begin && increment.duration() < increment_.duration();
    increment_          = increment;
    arc_length_.begin(increment);
    impose();
    model_.stabilisation->relax(0.);
    unstable_     = false;
    relaxed_work_ = 0.;
    forces_.drag  = 0.;
    motions_unknown_ =
        !increment.on_new_mesh() && increment.begins_interval() && model_.contact->surfaces().n_pairs() > 0;
    solver_->begin_increment(cut_back);
  }

  /// The conditions at the end of the increment.
  void Equilibrium::impose()
  {
    model_.impose(increment_);
    // Where a displacement was prescribed until the interval began, the force that held it goes to zero in it (eq. B4).
    const auto  &constraints = model_.boundary_conditions->homogeneous_constraints();
    const double rest        = increment_.left_to_release(increment_.end);
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      forces_.released(i) = constraints.is_constrained(i) ? 0. : rest * states_.now.reaction(i);
    forces_.released.compress(dealii::VectorOperation::insert);
  }

  void Equilibrium::begin_attempt(const MergedLoops &merged)
  {
    merged_   = merged;
    singular_ = false;
    start_    = {};
    if (arc_length_.acts() && increment_.end != increment_.begin) // of the attempt before
    {
      increment_.end = increment_.begin;
      impose();
    }
    model_.contact->begin_attempt();
  }

  void Equilibrium::begin_loops()
  {
    driven_.begin_loops();
  }

  void Equilibrium::pair()
  {
    const auto timer = journal_.profile.time(Phase::pairing);
    model_.contact->pair(states_.now.unknowns, states_.committed.unknowns.block(0));
  }

  void Equilibrium::hold(const double rate, const Vector &anchor)
  {
    model_.stabilisation->relax(rate);
    anchor_ = anchor;
  }

  NewtonProblem::Norms Equilibrium::evaluate(const bool measure, const bool last)
  {
    // The loops around Newton begin where it ends, with this tangent; and what is driven reads its forces in it.
    has_tangent_ = !last || !merged_.all(model_.contact->has_friction()) || model_.rigid_bodies.size() > 0 ||
                   arc_length_.acts() || model_.stabilisation->rate() > 0.;
    const Vector &u      = states_.now.unknowns.block(0);
    u_                   = u;
    constraints_         = &model_.boundary_conditions->increment_constraints(u_);
    const auto &assembly = model_.boundary_conditions->assembly_constraints();
    {
      const auto timer = journal_.profile.time(Phase::bulk_assembly);
      Vector    &rhs   = system_.rhs.block(0);
      if (has_tangent_)
        model_.solid->tangent(u_, increment_.end, assembly, system_.bulk, rhs, forces_.internal, forces_.external);
      else
        model_.solid->forces(u_, increment_.end, forces_.internal, forces_.external);
      forces_.external += forces_.released;
      rhs += forces_.released; // of no use without tangent
      forces_.drag = 0.;
      if (const double rate = model_.stabilisation->rate(); rate > 0.)
      {
        Vector       moved(u);
        const double part = model_.stabilisation->relaxation() / rate;
        if (part < 1.)
          moved.add(part - 1., states_.committed.unknowns.block(0));
        if (part > 0.)
          moved.add(-part, anchor_);
        model_.stabilisation->add(moved, assembly, system_.bulk, forces_.drag);
        driven_.add_drag(moved, forces_.drag);
        forces_.external += forces_.drag;
        rhs += forces_.drag;
      }
      driven_.take_faces(system_);
      bulk_rhs_ = rhs;
    }
    if (!measure)
      return {};
    model_.contact->gather(states_.now.unknowns, states_.committed.unknowns.block(0));
    return assemble_contact();
  }

  NewtonProblem::Norms Equilibrium::accept(const unsigned int iteration)
  {
    const bool        first   = iteration == 0;
    const Vector     &start   = states_.committed.unknowns.block(0);
    ContactInterface &contact = *model_.contact;
    if (merged_.geometry && !first)
      pair();
    {
      const auto timer = journal_.profile.time(Phase::contact_assembly);
      contact.gather(states_.now.unknowns, start);
    }
    if (merged_.threshold)
    {
      const auto timer = journal_.profile.time(Phase::status);
      contact.follow_pressure(increment_.duration(), states_.now.unknowns, start);
    }
    Norms norms = assemble_contact();
    if (std::exchange(motions_unknown_, false))
      warn_of_free_motions();
    // Newton starts with the statuses that it inherits. Where prescribed displacements have just moved the boundary and
    // left the bulk out of balance, gaps count but pressures do not.
    const bool moved = std::exchange(prescribed_before_, norms.prescribed) > model_.parameters.newton.contact_tolerance;
    const bool unsettled = !first && moved && norms.force > settled_force;
    if (merged_.status && (!first || Newton(model_.parameters.newton).converged(norms)))
      if (const unsigned int changes = update_statuses(unsettled).changes; changes > 0)
      {
        norms         = assemble_contact();
        norms.changes = changes;
      }
    scattered_ = !first && norms.force > linear_geometry;
    return norms;
  }

  /// Contact terms of the system at the trial, and the norms of its residual (eqs. N3 and N4).
  NewtonProblem::Norms Equilibrium::assemble_contact()
  {
    const auto  timer = journal_.profile.time(Phase::contact_assembly);
    Norms       norms;
    const auto &owned = model_.contact->surfaces().layout().owned[0];
    Vector      prescribed(forces_.contact); // its map: a new one would be collective
    prescribed = 0.;
    const OwnedValues given(prescribed);
    for (const auto i : owned)
      if (constraints_->is_constrained(i))
        given(i) = constraints_->get_inhomogeneity(i);
    model_.contact->set_prescribed(prescribed);

    system_.rhs.block(0) = bulk_rhs_;
    if (has_tangent_)
      model_.contact->assemble(system_, merged_.threshold);
    else
      model_.contact->evaluate();
    forces_.contact = 0.;
    model_.contact->add_forces(forces_.contact);

    double &stiffness_scale = states_.now.stiffness_scale;
    if (stiffness_scale == 0.)
      stiffness_scale = system_.bulk.largest_diagonal();
    const NormScales least(model_, states_.now.unknowns.block(0), states_.committed.unknowns.block(0), stiffness_scale);
    const double     length = least.length;
    const double     largest =
        std::max({largest_entry(forces_.internal), largest_entry(forces_.external), largest_entry(forces_.contact)});
    // Without the second a body that only translates would be measured against its own noise.
    const double scale = std::max(largest, least.force);
    forces_.largest    = largest;
    forces_.noise      = largest > 0. ? least.noise / largest : 0.;
    const OwnedValues out(forces_.out_of_balance), in(forces_.internal), ex(forces_.external), on(forces_.contact);
    for (const auto i : owned)
      out(i) = constraints_->is_constrained(i) ? 0. : in(i)-ex(i) + on(i);
    forces_.scale    = scale;
    norms.force      = scale > 0. ? largest_entry(forces_.out_of_balance) / scale : 0.;
    norms.contact    = model_.contact->norm(length);
    norms.prescribed = std::max(largest_entry(prescribed), std::abs(arc_length_.missing())) / length;
    driven_.add_to(system_, forces_.internal, forces_.external, scale, length, norms);
    return norms;
  }

  /// Adds what is not symmetric, the dearest part. @returns whether it is that of the last system, which will do as
  /// well.
  bool Equilibrium::complete_tangent(const bool again)
  {
    if (!has_tangent_)
    {
      evaluate(false, false);
      assemble_contact();
    }
    // what is driven has a part of it in the border
    if (again && variation_.complete && model_.rigid_bodies.size() == 0 && !arc_length_.acts())
    {
      system_.variation = variation_.entries;
      system_.symmetric = variation_.symmetric;
      return true;
    }
    // A converged iterate never needs it, and far from balance it leads astray: sites pass on to other faces.
    if (merged_.geometry && !scattered_)
    {
      const auto timer = journal_.profile.time(Phase::contact_assembly);
      model_.contact->add_geometry_tangent(system_);
    }
    model_.solid->add_variation(u_, *constraints_, system_);
    variation_ = {system_.variation, system_.symmetric, !merged_.geometry || !scattered_};
    return false;
  }

  unsigned int Equilibrium::solve(BlockVector &correction, const double relative_tolerance, const bool again)
  {
    start_.guess         = false;
    const bool as_before = complete_tangent(again);
    const auto timer     = journal_.profile.time(Phase::solver_iterations);
    iterate_.unknowns    = states_.now.unknowns;
    iterate_.rigid       = states_.now.rigid;
    if (as_before && solver_->type() == LinearSolverParameters::Type::direct &&
        solver_->solve_again(system_, system_.rhs, correction))
    {
      constraints_->distribute(correction.block(0));
      limit_step(correction);
      return 0;
    }
    std::optional<TimeRates> rates;
    if (arc_length_.acts())
      rates = arc_length_.rates(increment_.end, u_, driven_, merged_.threshold, merged_.geometry);
    std::vector<BlockVector> solutions; // the correction at this time, and its change per time
    LinearSolver::Report     report;
    if (model_.rigid_bodies.size() == 0)
    {
      std::vector<const BlockVector *> rhs = {&system_.rhs};
      if (rates)
        rhs.push_back(&rates->rhs);
      report = solver_->solve(system_, rhs, solutions, relative_tolerance);
    }
    else
    {
      std::string free;
      report    = driven_.solve(system_, rates ? &*rates : nullptr, *solver_, relative_tolerance, solutions, free);
      singular_ = singular_ || !free.empty();
      if (!free.empty())
        throw SolverFailure("the system is singular: " + free + ", and nothing resists it; " +
                                ways_to_hold("take components out of 'Rigid free' or 'Free'"),
                            SolverFailure::Kind::free_body);
    }
    const BlockLayout &layout = model_.contact->surfaces().layout();
    if (!report.null_pivots.empty())
    {
      null_pivot_ = report.null_pivots.front();
      singular_   = null_pivot_ < layout.n_u;
      throw SolverFailure("the system is singular (" + std::to_string(report.null_pivots.size()) +
                              " null pivots), first at " +
                              null_pivot_locus(model_, states_.now, increment_, null_pivot_),
                          singular_ ? SolverFailure::Kind::free_body : SolverFailure::Kind::over_constraint);
    }
    const long surplus = report.negative_pivots - 3 * static_cast<long>(layout.n_slave_nodes);
    if (report.negative_pivots >= 0 && surplus > 0 && !std::exchange(unstable_, true))
      journal_.console.remark("the tangent has " + std::to_string(surplus) +
                              " negative eigenvalues more than multipliers: the iterate is not stable");
    correction.reinit(solutions.front(), true); // swap() needs as many blocks
    correction.swap(solutions.front());
    if (rates)
    {
      arc_length_.find_step(increment_.end, correction, solutions[1]);
      correction.add(arc_length_.step(), solutions[1]);
      driven_.add_time(arc_length_.step());
    }
    // The solver leaves prescribed components alone: they take what the constraints still ask for.
    constraints_->distribute(correction.block(0));
    if (rates)
      correction.block(0).add(arc_length_.step(), rates->prescribed);
    limit_step(correction);
    return report.iterations;
  }

  /// A correction that takes nodes through the other surface of their pair, to where pairing does not see that, is
  /// shortened: they end a little behind it, and contact acts.
  void Equilibrium::limit_step(const BlockVector &correction)
  {
    step_limit_                     = 1.;
    const ContactSurfaces &surfaces = model_.contact->surfaces();
    if (surfaces.n_pairs() == 0 || !model_.parameters.strategy.uses(Remedy::limited_step))
      return;
    double seen = surfaces.face_size(0); // no step as short as this is too long
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      const double asked = model_.parameters.contact_pairs[p].search_distance;
      seen               = std::min({seen, surfaces.face_size(p), asked > 0. ? 0.5 * asked : surfaces.face_size(p)});
    }
    if (model_.rigid_bodies.size() == 0 && largest_entry(correction.block(0)) <= seen)
      return;
    move(1., correction);
    const double part = model_.contact->visible_part(iterate_.unknowns.block(0), states_.now.unknowns.block(0));
    if (part == 1.)
      return;
    if (start_.predicted)
      throw SolverFailure("the motion of the last increment leads astray: from there a correction goes through the "
                          "other surface",
                          SolverFailure::Kind::newton_stalled);
    journal_.count(Remedy::limited_step);
    journal_.console.remark(
        text("the correction would take bodies through each other unseen: ", part, " of it is taken"));
    step_limit_ = part;
  }

  void Equilibrium::move(const double factor, const BlockVector &correction)
  {
    if (factor < 1.)
      journal_.count(Remedy::shorter_step);
    states_.now.unknowns = iterate_.unknowns;
    states_.now.rigid    = iterate_.rigid;
    const double part    = factor * step_limit_;
    states_.now.unknowns.add(part, correction);
    if (arc_length_.acts())
    {
      increment_.end = arc_length_.time(part);
      impose();
    }
    model_.rigid_bodies.advance(part, driven_.correction());
    model_.rigid_bodies.move(states_.now.unknowns.block(0));
  }
} // namespace Nodus
