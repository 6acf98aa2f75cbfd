#ifndef nodus_run_driven_rigid_bodies_h
#define nodus_run_driven_rigid_bodies_h

#include "run/model.h"
#include "solve/bordered_system.h"
#include "solve/chosen_solver.h"
#include "solve/newton.h"

#include <string>
#include <vector>

namespace Nodus
{
  /// How what the corrections solve for changes with time, all else as it is (eq. Z2).
  struct TimeRates
  {
    BlockVector         rhs;           ///< of the unknowns, zero where displacements are prescribed
    Vector              prescribed;    ///< displacements [length/time]
    std::vector<double> rigid_force;   ///< six of each driven rigid body, all ranks: out of balance, loads included
    std::vector<double> rigid_missing; ///< likewise: prescribed components
  };

  /// Rigid bodies and coupled faces that forces and moments drive: their equilibrium, and their part in the correction.
  class DrivenRigidBodies
  {
  public:
    /// Both outlive it.
    DrivenRigidBodies(const Model &model, const States &states);

    void begin_loops()
    {
      waits_ = 0;
    }
    /// Corrections so far in which motions waited for friction to resist them.
    unsigned int waits() const
    {
      return waits_;
    }

    /// Takes the rows and columns of coupled faces out of bulk and right-hand side of @p system, to stay there until
    /// add_to() adds them to its border. Collective.
    void take_faces(LinearSystem &system);

    /// Viscous forces on the nodes of bodies against @p moved, which the bulk takes for prescribed ones.
    void add_drag(const Vector &moved, Vector &drag) const;

    /// Adds the forces at their nodes, and what take_faces() took, to the border of @p system and to the residual of
    /// contact, and to @p norms how far they are from equilibrium and what their prescribed components still lack. @p
    /// force_scale of the nodes, @p length of the increment. Collective.
    void add_to(LinearSystem         &system,
                const Vector         &internal,
                const Vector         &external,
                double                force_scale,
                double                length,
                NewtonProblem::Norms &norms);

    /// The correction of all unknowns, and with @p rates, which may be null, their change per time; those of the bodies
    /// are kept for correction(). @p free: a motion that nothing resists, then there are none.
    LinearSolver::Report solve(const LinearSystem       &system,
                               const TimeRates          *rates,
                               ChosenSolver             &solver,
                               double                    relative_tolerance,
                               std::vector<BlockVector> &solutions,
                               std::string              &free);
    /// The correction goes on by @p step in time.
    void add_time(double step);
    /// Force and moment of the @p forces at nodes, six of each body, of this rank.
    std::vector<double> resultants(const Vector &forces) const;

    /// Six components of each body.
    const std::vector<double> &correction() const
    {
      return correction_;
    }
    /// Forces and moments that act on them, all ranks.
    const std::vector<RigidBodies::Components> &applied() const
    {
      return applied_;
    }

  private:
    /// The equations of a correction, six per body: the components that are free, and what the others still lack.
    struct Equations
    {
      dealii::FullMatrix<double> components; ///< increments of the unknowns as motions
      dealii::Vector<double>     scale;      ///< for components in units of length
      std::vector<unsigned int>  rows;       ///< free components
    };
    Equations equations() const;
    /// @p a of the nodes, @p force out of balance and what prescribed components are @p missing, six of each body.
    BorderedSystem::RightHandSide right_hand_side(const Equations           &equations,
                                                  const BlockVector         &a,
                                                  const std::vector<double> &force,
                                                  const std::vector<double> &missing) const;
    /// The free components at right-hand side @p k, which is @p rhs; motions whose stiffness is below @p free_fraction
    /// are free.
    dealii::Vector<double>           resolve(const BorderedSystem                &bordered,
                                             unsigned int                         k,
                                             const BorderedSystem::RightHandSide &rhs,
                                             const Equations                     &equations,
                                             double                               free_fraction,
                                             std::string                         &free);
    std::vector<std::vector<double>> face_motions(const LinearSystem &system, std::vector<double> &coupled) const;
    void                             add_nodes(LinearSystem &system, const Vector &internal, const Vector &external);
    bool                             may_wait_for_friction(double force) const;
    std::string                      describe(const std::vector<double> &motion) const;

    const Model                         &model_;
    const States                        &states_;
    std::vector<double>                  correction_, rate_; ///< rate_: its change per time, if that is asked for
    unsigned int                         waits_ = 0;         ///< corrections in which some wait for friction
    std::vector<RigidBodies::Components> applied_;
    TripletMatrix                        face_border_; ///< of take_faces()
    std::vector<double>                  face_rhs_;
  };
} // namespace Nodus

#endif
