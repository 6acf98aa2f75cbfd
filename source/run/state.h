#ifndef nodus_run_state_h
#define nodus_run_state_h

#include "bulk/solid_assembler.h"
#include "contact/interface_state.h"
#include "output/energies.h"
#include "rigid/rigid_bodies.h"
#include <nodus/base/types.h>

#include <deal.II/lac/la_parallel_block_vector.h>

#include <vector>

namespace Nodus
{
  /// Every number that history is made of, on the mesh at hand. Assignment is commit and roll-back;
  /// visit_members() is what checkpoints and new meshes take over.
  struct State
  {
    BlockVector                     unknowns; ///< (u, lambda, Lambda)
    InterfaceState                  contact;
    std::vector<RigidBodies::State> rigid;   ///< of the driven bodies
    SolidAssembler::History         history; ///< of the materials, as the increment begins
    Vector   reaction; ///< of what was prescribed when the last interval ended; what is released sheds it [force]
    Vector   applied;  ///< loads and reactions as the increment begins [force]
    Energies energies; ///< up to then
    Vector   motion;   ///< of the last increment, which the next one goes on along [length]
    double   motion_time     = 0.; ///< that it took; 0: none that another one could go on along
    double   stiffness_scale = 0.; ///< largest diagonal entry of the first bulk tangent
  };

  /// The state at hand, and the one that the increment began with.
  struct States
  {
    State now, committed;
  };

  /// Calls the visitor for every member of a State, once, as what it is: nodes(v) for vectors like the displacement,
  /// multipliers(v, n) with n components per slave node, slaves(v) and sites(v) for a value per slave node or contact
  /// site, cells(h) for the history of the materials, and common(x) for what all ranks share.
  ///
  /// The members are bound by position, so that one which is added and not visited does not compile.
  template <typename AnyState, typename Visitor>
  void visit_members(AnyState &state, Visitor &visitor)
  {
    auto &[unknowns, contact, rigid, history, reaction, applied, energies, motion, motion_time, stiffness_scale] =
        state;
    visitor.nodes(unknowns.block(0));
    visitor.nodes(reaction);
    visitor.nodes(applied);
    visitor.nodes(motion);
    visitor.multipliers(unknowns.block(1), 1u);
    visitor.multipliers(unknowns.block(2), 2u);
    visitor.cells(history);
    visitor.common(rigid);
    visitor.common(energies);
    visitor.common(motion_time);
    visitor.common(stiffness_scale);

    auto &[statuses, tangents, elastic_slip, area, force, jump, on_new_mesh, stuck] = contact;
    visitor.slaves(tangents);
    visitor.slaves(elastic_slip);
    visitor.slaves(area);
    visitor.sites(force);
    visitor.sites(jump);
    visitor.common(on_new_mesh);
    visitor.sites(stuck);

    auto &[closed, stick, threshold, slip, adjustment, friction_factor, slip_rate, friction_state] = statuses;
    visitor.sites(closed);
    visitor.sites(stick);
    visitor.sites(threshold);
    visitor.sites(slip);
    visitor.sites(adjustment);
    visitor.sites(friction_factor);
    visitor.sites(slip_rate);
    visitor.sites(friction_state);
  }
} // namespace Nodus

#endif
