#ifndef nodus_contact_contact_interface_h
#define nodus_contact_contact_interface_h

#include "contact/averaged_jump.h"
#include "contact/contact_assembler.h"
#include "contact/contact_geometry.h"
#include "contact/free_motions.h"
#include "contact/interface_state.h"
#include "contact/jump_operator.h"
#include "contact/pairing.h"
#include "contact/status.h"
#include "contact/surface.h"
#include "contact/surface_weights.h"
#include "rigid/rigid_bodies.h"
#include <nodus/contact/contact_fields.h>

#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// All contact pairs on one mesh, as the mechanics talks to them: surfaces, pairing, jump operator, weights, statuses
  /// and assembler of all pairs.
  ///
  /// Positions, multipliers and statuses are those of the last gather(); pairing, jumps and weights those of the last
  /// pair(). What lasts beyond an increment stands in the InterfaceState that it refers to. Most functions are
  /// collective.
  class ContactInterface
  {
  public:
    /// @p stiffness: Young's modulus of each body [pressure]. The references outlive the object; @p now is set to that
    /// before the first pairing.
    ContactInterface(const std::vector<ContactPairParameters> &pairs,
                     const std::vector<double>                &stiffness,
                     const StrategyParameters                 &strategy,
                     const Bodies                             &bodies,
                     const dealii::DoFHandler<dim>            &dof_handler,
                     const dealii::Mapping<dim>               &mapping,
                     const RigidBodies                        &rigid_bodies,
                     InterfaceState                           &now);

    /// Where rigid masters are in the increment from @p begin to @p end, which pairs act in it, and which part of the
    /// interference of each is pressed out by its end.
    void begin_increment(double begin, double end, const std::vector<double> &resolved_interference);
    /// An attempt at it: closed sites have a partner, the laws are not regularised, the ledger is empty.
    void begin_attempt();

    /// Pairs that act until time @p t open: the nodal forces that they have had, as add_forces() has them, are added to
    /// @p ended. Of those that begin to act then, the first pairing at the displacements of @p unknowns, and the
    /// statuses that belong to it. Sentences on what of tied pairs is not tied. @throws InputError on every rank where
    /// the bodies overlap too much, and where nothing of a tied pair is tied.
    std::vector<std::string> begin(BlockVector &unknowns, double t, Vector &ended);
    /// Takes positions and multipliers from @p unknowns; @p start: displacements as the increment began.
    void gather(const BlockVector &unknowns, const Vector &start);
    /// Projects anew at the displacements of @p unknowns and carries its multipliers over (eq. X1): Lambda keeps its
    /// direction in space and its length in the new tangent planes, lambda the nodal force; nodes without partner lose
    /// all.
    void pair(BlockVector &unknowns, const Vector &start);
    /// The part, 0 to 1, of the way from the displacements @p from to @p to on which no node of a pair goes farther
    /// behind the other surface than pairing looks.
    double visible_part(const Vector &from, const Vector &to) const;
    /// The state that this refers to has been set to another one, to which @p unknowns belong.
    void resume(const BlockVector &unknowns, const Vector &start);
    /// What @p other solves now, of the same mesh: its laws (Status::take_laws), and which sites have a partner before
    /// the next projection.
    void take_laws(const ContactInterface &other);

    /// Pairs with friction at all, with thresholds that follow the pressure.
    bool has_friction() const
    {
      return status_.has_friction();
    }
    bool threshold_follows_pressure() const
    {
      return status_.threshold_follows_pressure();
    }

    /// Freezes the thresholds of the present pressures and, where friction depends on them, of the present slip rates.
    /// @p duration of the increment [time]; 0: the rates stay.
    void freeze_threshold(double duration);
    /// The same within Newton's iteration: sticking nodes keep their friction traction mu lambda Lambda, which as
    /// unknown of the iteration is linear (theory section 12), unless elastic slip gives Lambda.
    void follow_pressure(double duration, BlockVector &unknowns, const Vector &start);
    /// Freezes these (Status::freeze).
    void freeze_thresholds(std::vector<double> thresholds);
    void update_slip_rates(double duration);
    /// Contact pressure of every site, as friction follows it: friction_pressure().
    std::vector<double> pressure() const;

    /// Tests and changes the statuses (Status::update).
    Status::Update update_statuses(const bool closing_only)
    {
      return status_.update(status_input(), closing_only);
    }
    /// The laws have just been regularised: multipliers of lumped weights become the nodal means that those of
    /// consistent weights had.
    void pass_to_regularised_law(BlockVector &unknowns, const Vector &start);
    /// By how much the sites violate their statuses: all, and those that were frozen in this loop.
    Status::Violation violation() const;
    Status::Violation frozen_violation() const;
    /// By how much the thresholds differ from those of the present pressures and, where friction depends on them, slip
    /// rates, which it sets (Status::threshold_change).
    Status::Change threshold_change(double duration);

    /// Sets what the next correction must add at prescribed components, zero elsewhere.
    void set_prescribed(const Vector &prescribed);
    /// Keeps the residual of the present values.
    void evaluate()
    {
      residual_ = assembler_.residual(state_);
    }
    /// Writes the contact terms of @p system and keeps the residual (ContactAssembler::assemble).
    void assemble(LinearSystem &system, bool linearise_threshold = false);
    /// Adds what the tangent gains where the geometry follows the iterate (GeometryTangent). assemble() comes first.
    void add_geometry_tangent(LinearSystem &system) const;
    /// Adds the nodal contact forces, at prescribed components too.
    void add_forces(Vector &force) const;
    /// Largest relative violation of the contact and friction laws (eq. N4): lengths over @p length.
    double norm(const double length) const
    {
      return assembler_.norm(residual_, length);
    }

    /// The increment has converged after @p duration [time]: slips, forces, jumps and areas become those that the next
    /// one begins with.
    void end_increment(double duration);

    /// What the user sees, of this rank's part of the surfaces and on all ranks.
    std::vector<ContactFields>     fields() const;
    std::vector<ContactResultants> resultants() const;
    /// Motions that contact holds (FreeMotions::hold_contact).
    void hold(FreeMotions &motions, bool as_closed) const;

    /// d_n without what is adjusted, and the tangential jump of the increment, at an owned site.
    double distance(const unsigned int site) const
    {
      return assembler_.distance(state_, site);
    }
    std::array<double, 2> slip(const unsigned int site) const
    {
      return assembler_.slip(state_, site);
    }
    /// Jump of the displacement at the last gather().
    std::vector<Vector3> displacement_jumps() const;

    /// Closed sites of all ranks.
    unsigned int n_closed() const;
    /// Where the first of the sites is that the ranks name; an invalid number names none.
    std::string locus(unsigned int site) const;
    /// Where the first @p n of the @p sites of all ranks are, owned ones.
    std::vector<std::string> loci(const std::vector<unsigned int> &sites, unsigned int n) const;

    ContactSurfaces &surfaces()
    {
      return surfaces_;
    }
    const ContactSurfaces &surfaces() const
    {
      return surfaces_;
    }
    /// Null before the first pairing.
    const ContactGeometry *geometry() const
    {
      return geometry_.get();
    }
    const Pairing &pairing() const
    {
      return pairing_;
    }
    /// The surface around the site is covered too little for a constraint of its own: its neighbours have it (eq. J9).
    bool is_shared_out(const unsigned int site) const
    {
      return !surfaces_.is_point(site) && averaged_.shared_out(site);
    }
    const JumpOperator &jump() const
    {
      return jump_;
    }
    const SurfaceWeights &weights() const
    {
      return weights_;
    }
    Status &status()
    {
      return status_;
    }
    const Status &status() const
    {
      return status_;
    }
    const ContactState &state() const
    {
      return state_;
    }
    ContactResidual &residual()
    {
      return residual_;
    }
    const ContactResidual &residual() const
    {
      return residual_;
    }

  private:
    void                 let_act(bool (ActiveTime::*acts)(double) const, double t);
    void                 add_ended_forces(double t, BlockVector &unknowns, Vector &ended);
    void                 freeze_geometry();
    void                 keep_frames();
    void                 weigh();
    void                 carry_over_sticking();
    std::vector<Vector3> displacement() const;
    StatusInput          status_input() const;
    void                 begin_friction();

    const std::vector<ContactPairParameters> &pairs_;
    const RigidBodies                        &rigid_bodies_;
    InterfaceState                           &now_;
    ContactSurfaces                           surfaces_;
    std::vector<Point>                        paired_at_; ///< positions of the surface nodes at the last pairing
    std::unique_ptr<ContactGeometry>          geometry_;  ///< of that
    AveragedJump                              averaged_;
    Pairing                                   pairing_;
    JumpOperator                              jump_;
    SurfaceWeights                            weights_;
    Status                                    status_;
    ContactAssembler                          assembler_;
    const std::vector<double>                 depths_; ///< of the softer bodies of the pairs: softer_diagonals()
    ContactState                              state_;
    ContactResidual                           residual_;
  };
} // namespace Nodus

#endif
