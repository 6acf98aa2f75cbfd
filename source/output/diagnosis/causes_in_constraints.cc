#include "output/diagnosis/suspected_causes.h"

#include <algorithm>
#include <cmath>
#include <iomanip>

// Systems that have no unique solution: motions that nothing resists, and constraints that repeat others.

namespace Nodus
{
  namespace Suspects
  {
    namespace
    {
      /// Surfaces touch that are nearer than this [face sizes].
      constexpr double touching = 1e-2;

      /// A subsection to append to the case.
      std::string spring_condition(const unsigned int number, const FailureEvidence::Spring &spring)
      {
        std::string components;
        for (unsigned int c = 0; c < dim; ++c)
          if (spring.components[c])
            components += (components.empty() ? "" : ", ") + std::string(1, "xyz"[c]);
        return text("subsection Boundary condition ",
                    number,
                    "\n  set Name         = soft spring ",
                    spring.body + 1,
                    "\n  set Type         = spring\n  set Body         = ",
                    spring.body + 1,
                    "\n  set Boundary ids = ",
                    spring.boundary_id,
                    "\n  set Components   = ",
                    components,
                    "\n  set Value        = ",
                    std::setprecision(2),
                    spring.stiffness,
                    "\nend\n");
      }

      /// Whether a condition may hold nodes of a contact surface: it has a boundary id of its faces, or @p around, of
      /// any faces of its bodies, whose edges they may share.
      bool may_hold(const BoundaryConditionParameters &condition, const RegionParameters &side, const bool around)
      {
        if (!condition.holds())
          return false;
        for (const unsigned int body : side.bodies)
        {
          const auto takes = [&](const auto id) { return condition.region.takes(body, id); };
          const auto own   = side.ids_of_body.find(body);
          if (condition.region.has_body(body) &&
              (around || !condition.region.has_ids() || !side.has_ids() ||
               std::any_of(side.boundary_ids.begin(), side.boundary_ids.end(), takes) ||
               (own != side.ids_of_body.end() && std::any_of(own->second.begin(), own->second.end(), takes))))
            return true;
        }
        return false;
      }
    } // namespace

    void add_prescribed_contact(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes)
    {
      SuspectedCause cause{"displacements of both sides of the contact are prescribed", {evidence.message}, {}};
      for (const bool around : {false, true})
        for (unsigned int c = 0; c < parameters.boundary_conditions.size() && (!around || cause.changes.empty()); ++c)
        {
          const auto &condition = parameters.boundary_conditions[c];
          for (unsigned int p = 0; p < parameters.contact_pairs.size(); ++p)
            for (const RegionParameters *side :
                 {&parameters.contact_pairs[p].slave, &parameters.contact_pairs[p].master})
              if (may_hold(condition, *side, around))
                cause.changes.push_back(
                    {text("Boundary condition ", c + 1, condition.region.has_ids() ? "/Boundary ids" : "/Where"),
                     condition.region.has_ids() ? condition.region.ids_text() : condition.region.where,
                     "another face",
                     text("it holds ",
                          side == &parameters.contact_pairs[p].slave ? "the slave" : "the master",
                          " side of ",
                          pair_name(parameters, p),
                          ", and one side of the contact must be free")});
        }
      causes.push_back(cause);
    }

    void add_instability(const Parameters      &parameters,
                         const History         &history,
                         const FailureEvidence &evidence,
                         Causes                &causes)
    {
      using Type = BoundaryConditionParameters::Type;
      SuspectedCause cause{"the bodies are not stable: they buckle, snap through or soften", {}, {}};
      cause.evidence.push_back("the tangent of iterates had more negative eigenvalues than there are multipliers");
      if (evidence.motion_known && !evidence.state.empty())
        cause.evidence.push_back("the motion that was resisted least when the last increment had converged is the "
                                 "field softest_motion of " +
                                 evidence.state);
      const auto &without = parameters.strategy.without;
      if (!parameters.strategy.uses(Remedy::relaxation))
      {
        std::string others;
        for (const std::string &name : without)
          if (name != remedy_names[static_cast<unsigned int>(Remedy::relaxation)])
            others += (others.empty() ? "" : ", ") + name;
        cause.changes.push_back({"Strategy/Without",
                                 "with relaxation",
                                 others,
                                 "the bodies creep into the stable equilibrium that they would snap into"});
      }
      else if (evidence.relaxed)
        cause.evidence.push_back("relaxation found no stable equilibrium under the loads of this increment");
      for (unsigned int c = 0; c < parameters.boundary_conditions.size(); ++c)
      {
        const auto &condition = parameters.boundary_conditions[c];
        if (condition.type == Type::traction || condition.type == Type::pressure || condition.type == Type::body_force)
          cause.changes.push_back({text("Boundary condition ", c + 1, "/Type"),
                                   text_of(condition.type),
                                   "displacement",
                                   "beyond the largest load that the bodies carry there is no equilibrium; a "
                                   "prescribed displacement of the same place follows them"});
      }
      add_smaller_increments(parameters, history, cause);
      causes.push_back(cause);
    }

    /// Of the interval at hand alone: where contact holds the bodies, dashpots would carry loads in its place.
    void add_stabilisation(const LoadSteppingParameters &load, const History &history, SuspectedCause &cause)
    {
      const auto interval = interval_of(load, history);
      if (load.stabilisation(interval) > 0.)
        return;
      std::vector<double> now;
      for (unsigned int i = 0; i < load.interval_ends.size(); ++i)
        now.push_back(load.stabilisation(i));
      auto then      = now;
      then[interval] = 0.01;
      SuspectedCause::Change change{"Load stepping/Viscous stabilisation",
                                    as_list(now),
                                    as_list(then),
                                    "dashpots hold the body until contact does"};
      auto                   increments = load.increments; // dashpots fade in the course of the interval
      if (increments[interval] == 1)
      {
        increments[interval] = 4;
        change.together.emplace_back("Increments", as_list(increments));
      }
      cause.changes.push_back(change);
    }

    void
    add_free_body(const Parameters &parameters, const History &history, const FailureEvidence &evidence, Causes &causes)
    {
      SuspectedCause cause{"a body can move freely", {}, {}};
      if (evidence.kind == Kind::free_body)
        cause.evidence.push_back("the linear solver met a null pivot of a displacement");
      for (const std::string &motion : evidence.free_motions)
        cause.evidence.push_back("no prescribed displacement, spring or closed contact resists this: " + motion);
      for (unsigned int p = 0; p < evidence.pairs.size(); ++p)
      {
        const auto &pair = evidence.pairs[p];
        cause.evidence.push_back(text(pair_name(parameters, p),
                                      ": ",
                                      pair.closed,
                                      " of ",
                                      pair.sites,
                                      " sites are closed, ",
                                      pair.slipping,
                                      " of these slip or have no friction"));
      }
      const bool open =
          std::none_of(evidence.pairs.begin(), evidence.pairs.end(), [](const auto &pair) { return pair.closed > 0; });
      std::vector<SuspectedCause::Change> springs;
      unsigned int                        next = parameters.boundary_conditions.size();
      for (const FailureEvidence::Spring &spring : evidence.springs)
      {
        ++next;
        springs.push_back({text("Boundary condition ", next),
                           "does not exist",
                           text("a soft spring on ", body_name(parameters, spring.body)),
                           "resists the motions above; or hold these components (Type = displacement)",
                           {},
                           spring_condition(next, spring)});
      }
      if (!open)
        cause.changes = springs;
      std::vector<SuspectedCause::Change> closures;
      bool                                touches = true;
      for (unsigned int p = 0; p < evidence.pairs.size(); ++p)
      {
        const auto &pair = parameters.contact_pairs[p];
        if (evidence.pairs[p].closed == 0 && history.increment == 1 && evidence.left_free.empty() &&
            pair.start.status != ContactPairParameters::InitialStatus::closed)
        {
          touches = touches && evidence.pairs[p].gap < touching;
          closures.push_back({in_pair(p, "Initial status"),
                              pair.start.status == ContactPairParameters::InitialStatus::open ? "open" : "by gap",
                              "closed",
                              "the contact holds the body from the start"});
        }
      }
      if (touches)
        cause.changes.insert(cause.changes.end(), closures.begin(), closures.end());
      add_stabilisation(parameters.load_stepping, history, cause);
      if (!touches) // closing a gap in one step may open all of it in the next
        cause.changes.insert(cause.changes.end(), closures.begin(), closures.end());
      if (open) // where a load closes the gap a soft spring is no match for it
        cause.changes.insert(cause.changes.end(), springs.begin(), springs.end());
      for (unsigned int p = 0; p < evidence.pairs.size(); ++p)
      {
        const auto &pair = parameters.contact_pairs[p];
        if (evidence.pairs[p].closed > 0 && pair.friction_law == ContactPairParameters::FrictionLaw::coulomb &&
            pair.friction_coefficient == 0. && pair.contact_law != ContactPairParameters::ContactLaw::tied)
          cause.changes.push_back({in_pair(p, "Friction coefficient"),
                                   "0",
                                   "0.1",
                                   history.increment == 1
                                       ? "friction holds what the normals leave free, but only once there is pressure: "
                                         "besides a spring or stabilisation"
                                       : "friction holds what the normals leave free"});
      }
      causes.push_back(cause);
    }

    void add_over_constraint(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes)
    {
      const auto    &constraint = evidence.constraint;
      SuspectedCause cause{"a contact constraint repeats another constraint", {}, {}};
      if (constraint.pair < parameters.contact_pairs.size())
      {
        std::string held;
        for (unsigned int c = 0; c < dim; ++c)
          if (constraint.prescribed[c])
            held += (held.empty() ? "" : ", ") + std::string(1, "xyz"[c]);
        cause.evidence.push_back(text("null pivot of the ",
                                      constraint.friction ? "friction" : "contact",
                                      " multiplier of the slave node at (",
                                      constraint.X,
                                      ") of ",
                                      pair_name(parameters, constraint.pair),
                                      ", normal (",
                                      constraint.normal,
                                      ')'));
        cause.evidence.push_back("components of its displacement that are prescribed: " +
                                 (held.empty() ? "none" : held));
        const auto &pair = parameters.contact_pairs[constraint.pair];
        for (unsigned int q = 0; q < parameters.contact_pairs.size(); ++q)
          if (const auto &other = parameters.contact_pairs[q]; q != constraint.pair &&
                                                               other.slave.bodies == pair.master.bodies &&
                                                               other.master.bodies == pair.slave.bodies)
          {
            cause.evidence.push_back(pair_name(parameters, q) + " has the same bodies with slave and master exchanged");
            cause.changes.push_back({text("Contact pair ", q + 1), "exists", "nothing", "leave this pair out"});
          }
        const std::string hole = text("(x - ",
                                      constraint.X[0],
                                      ")^2 + (y - ",
                                      constraint.X[1],
                                      ")^2 + (z - ",
                                      constraint.X[2],
                                      ")^2 > ",
                                      std::pow(evidence.pairs[constraint.pair].face_size, 2));
        cause.changes.push_back({in_pair(constraint.pair, "Slave where"),
                                 pair.slave.where.empty() ? "empty" : pair.slave.where,
                                 hole,
                                 "leaves the faces around this node out"});
        if (!pair.has_rigid_master())
          cause.changes.push_back({in_pair(constraint.pair, "Slave body"),
                                   pair.slave.body_numbers(),
                                   pair.master.body_numbers(),
                                   "slave and master change places, with their boundary ids",
                                   {{"Slave boundary ids", pair.master.ids_text()},
                                    {"Slave where", pair.master.where},
                                    {"Master body", pair.slave.body_numbers()},
                                    {"Master boundary ids", pair.slave.ids_text()},
                                    {"Master where", pair.slave.where}}});
      }
      causes.push_back(cause);
    }
  } // namespace Suspects
} // namespace Nodus
