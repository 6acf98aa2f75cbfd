#include "run/equilibrium.h"
#include "run/unheld_bodies.h"

#include <utility>

// The motion that an attempt starts along, and what others hear of an equilibrium: forces, systems, statuses that
// change, and what nothing holds.

namespace Nodus
{
  void Equilibrium::predict()
  {
    const State &last = states_.committed;
    if (last.motion_time == 0. || increment_.begins_interval() || increment_.on_new_mesh() || increment_.arc > 0.)
      return;
    u_                = states_.now.unknowns.block(0);
    constraints_      = &model_.boundary_conditions->increment_constraints(u_);
    const double part = increment_.duration() / last.motion_time;
    Vector       motion(last.motion);
    motion *= part;
    constraints_->distribute(motion);
    Vector &u = states_.now.unknowns.block(0);
    u += motion;
    model_.rigid_bodies.go_on(part);
    model_.rigid_bodies.move(u);
    start_.predicted = start_.guess = model_.contact->visible_part(last.unknowns.block(0), u) == 1.;
    if (start_.guess)
      return;
    u                 = last.unknowns.block(0);
    states_.now.rigid = last.rigid;
  }

  void Equilibrium::keep_motion(const bool guides)
  {
    State       &now   = states_.now;
    const State &start = states_.committed;
    now.motion         = now.unknowns.block(0);
    now.motion -= start.unknowns.block(0);
    now.motion_time = guides ? increment_.duration() : 0.;
    model_.rigid_bodies.keep_motion(start.rigid);
  }

  Vector Equilibrium::applied_forces() const
  {
    const auto &constraints = model_.boundary_conditions->homogeneous_constraints();
    Vector      applied(forces_.external);
    applied -= forces_.drag;
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      if (constraints.is_constrained(i))
        applied(i) = forces_.internal(i) + forces_.contact(i);
    for (unsigned int b = 0; b < model_.rigid_bodies.size(); ++b) // what drives these counts as force and moment
      for (const RigidBodies::Node &node : model_.rigid_bodies.nodes(b))
        for (unsigned int c = 0; c < dim; ++c)
          if (model_.rigid_bodies.moves(b, c))
            applied(node.dof + c) = forces_.external(node.dof + c) - forces_.drag(node.dof + c);
    applied.compress(dealii::VectorOperation::insert);
    return applied;
  }

  Vector Equilibrium::reactions() const
  {
    const auto &constraints = model_.boundary_conditions->homogeneous_constraints();
    Vector      reactions(forces_.internal);
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      reactions(i) =
          constraints.is_constrained(i) ? forces_.internal(i) - forces_.external(i) + forces_.contact(i) : 0.;
    reactions.compress(dealii::VectorOperation::insert);
    return reactions;
  }

  const LinearSystem &Equilibrium::symmetric_system(const double rate)
  {
    const double held   = model_.stabilisation->relaxation();
    const bool   merged = std::exchange(merged_.threshold, false);
    model_.stabilisation->relax(rate);
    evaluate(true, false);
    merged_.threshold = merged;
    model_.stabilisation->relax(held);
    return system_;
  }

  bool Equilibrium::solve_again(const BlockVector &rhs, BlockVector &solution)
  {
    // Factors are at hand; an iterative solver takes half as long without variation, with the bulk of the iterate
    // before where that is the last tangent.
    if (solver_->type() != LinearSolverParameters::Type::direct && !(has_tangent_ && system_.symmetric))
      model_.contact->assemble(system_);
    return solver_->solve_again(system_, rhs, solution);
  }

  /// Names the rigid motions that nothing holds as the increment begins: contact has to, or the system is singular.
  void Equilibrium::warn_of_free_motions()
  {
    std::string text;
    for (const auto &motion : free_motions(model_, states_.now, increment_.end))
      text += (text.empty() ? "" : "; ") + motion.text;
    const bool has_closed = model_.contact->n_closed() > 0;
    if (!text.empty())
      journal_.console.remark("nothing holds these motions as the increment begins: " + text +
                              (model_.stabilisation->acts() ? "; viscous stabilisation does"
                               : has_closed ? "; the closed contact does not, and no more may close in time"
                                            : "; contact has to close at once"));
  }

  std::string Equilibrium::ways_to_hold(const std::string &first) const
  {
    // what resists a coupled face may be slender, and its stiffness less than an iterative solver tells from none
    const bool untold = model_.rigid_bodies.has_faces() && solver_->type() != LinearSolverParameters::Type::direct;
    return Nodus::ways_to_hold(model_,
                               states_.now,
                               increment_,
                               first +
                                   (untold ? ", set 'Linear solver/Type = direct' if a slender part resists it" : ""));
  }

  Equilibrium::StatusChanges Equilibrium::update_statuses(const bool closing_only)
  {
    const auto           timer   = journal_.profile.time(Phase::status);
    ContactInterface    &contact = *model_.contact;
    const Status::Update update  = contact.update_statuses(closing_only);
    std::vector<char>    statuses(contact.status().size());
    for (unsigned int s = 0; s < statuses.size(); ++s)
      statuses[s] = static_cast<char>(contact.status().status(s));
    journal_.diagnosis.add_statuses(statuses);
    StatusChanges result{update.changes, update.frozen, ""};
    if (update.frozen > 0)
      journal_.count(Remedy::frozen_statuses);
    if (update.changes == 0)
      return result;
    const std::vector<std::string> loci = contact.loci(update.sites, 3);
    result.first                        = loci.front();
    journal_.console.remark(std::to_string(update.changes) + " statuses changed, first at " + result.first);
    if (update.cycles)
      throw SolverFailure("the statuses cycle; the nodes that change back and forth: " + cycling_,
                          SolverFailure::Kind::status_cycle);
    if (update.to_regularised)
    {
      journal_.count(Remedy::regularised_law);
      journal_.console.remark("the statuses do not settle: from here the laws are regularised (multipliers projected "
                              "at integration points, weights lumped)");
      contact.pass_to_regularised_law(states_.now.unknowns, states_.committed.unknowns.block(0));
      ++journal_.counts.fallbacks;
    }
    else if (update.period > 0)
    {
      cycling_.clear();
      for (const std::string &locus : loci)
        cycling_ += (cycling_.empty() ? "" : "; ") + locus;
      journal_.console.remark("these statuses were met " + std::to_string(update.period) +
                              (merged_.status ? " iterations ago" : " passes ago"));
    }
    return result;
  }
} // namespace Nodus
