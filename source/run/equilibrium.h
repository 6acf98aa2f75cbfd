#ifndef nodus_run_equilibrium_h
#define nodus_run_equilibrium_h

#include "contact/status.h"
#include "run/arc_length.h"
#include "run/driven_rigid_bodies.h"
#include "run/journal.h"
#include "run/load_stepping.h"
#include "run/model.h"
#include "run/norm_scales.h"
#include "solve/chosen_solver.h"
#include "solve/newton.h"

#include <memory>
#include <string>

namespace Nodus
{
  /// Which of the three nested loops are part of Newton's iteration.
  struct MergedLoops
  {
    bool geometry = false, threshold = false, status = false;
    bool any() const
    {
      return geometry || threshold || status;
    }
    /// Thresholds are those of friction.
    bool all(const bool with_friction) const
    {
      return geometry && status && (threshold || !with_friction);
    }
    /// "geometry, status" and the like, empty for none.
    std::string names() const;
  };

  /// Nodal forces at the trial that was evaluated last, fully distributed.
  struct NodalForces
  {
    Vector internal;
    Vector external; ///< loads, what is being released, and drag
    Vector contact;
    Vector drag;           ///< of viscous stabilisation
    Vector released;       ///< what is left of reactions where nothing is prescribed any more
    Vector out_of_balance; ///< the sum, zero where prescribed
    double scale   = 0.;   ///< that they are relative to in the norms
    double largest = 0.;   ///< of all nodes and kinds
    double noise   = 0.;   ///< NormScales::noise over the largest one: beyond 1, round-off limits what is known
  };

  /// Equilibrium of all bodies at the end of an increment, as Newton sees it: residual, tangent and correction.
  /// evaluate() and accept() follow the state at hand; pairing, thresholds and statuses move in accept() alone, where
  /// their loops are merged.
  class Equilibrium : public NewtonProblem
  {
  public:
    /// All outlive it.
    Equilibrium(Model &model, Journal &journal, States &states);

    /// What the solution on the mesh as it is needs: sparsity, solver, vectors.
    void begin_on_mesh();
    /// The conditions of @p increment: prescribed displacements, loads, rigid motions, what is released.
    void begin_increment(const Increment &increment);
    /// An attempt at it that starts from the state at hand.
    void begin_attempt(const MergedLoops &merged);
    /// The loops around Newton begin (anew).
    void begin_loops();

    Norms        evaluate(bool measure, bool last) override;
    Norms        accept(unsigned int iteration) override;
    unsigned int solve(BlockVector &correction, double relative_tolerance, bool again) override;
    void         move(double factor, const BlockVector &correction) override;
    bool         is_guess() const override
    {
      return start_.guess;
    }

    /// The attempt starts where the motion of the last increment leads in the time of this one, prescribed
    /// displacements where they are to be. Nothing changes where there is no such motion in this interval, or where it
    /// leads through another surface. Collective.
    void predict();
    /// Whether the attempt at hand started so.
    bool predicted() const
    {
      return start_.predicted;
    }
    /// The motion of the increment, which has been found, is what the next one goes on along, if it @p guides that.
    void keep_motion(bool guides);

    /// Dashpots of @p rate hold all nodes where @p anchor, displacements, says, besides those of viscous stabilisation
    /// (eq. Y3); 0: none. They last until the next increment begins.
    void hold(double rate, const Vector &anchor);
    /// The system at the state at hand without variation, symmetric, with dashpots of @p rate. Collective.
    const LinearSystem &symmetric_system(double rate);
    /// LinearSolver::solve_again() for the last correction.
    bool solve_again(const BlockVector &rhs, BlockVector &solution);
    /// Of dashpots in a relaxation, in the increment at hand [energy].
    void add_relaxed_work(const double work)
    {
      relaxed_work_ += work;
    }
    double relaxed_work() const
    {
      return relaxed_work_;
    }

    /// Pairs the surfaces at the state at hand: what a geometry pass begins with.
    void pair();
    /// Tests and changes statuses, and says so. @throws SolverFailure where they cycle.
    struct StatusChanges
    {
      unsigned int changes = 0, frozen = 0; ///< on all ranks
      std::string  first;                   ///< where the first one is
    };
    StatusChanges update_statuses(bool closing_only = false);
    /// Sites that took part in the last cycle.
    const std::string &cycling() const
    {
      return cycling_;
    }

    /// Its end is the time of the trial, where that is an unknown.
    const Increment &increment() const
    {
      return increment_;
    }
    const ArcLength &arc_length() const
    {
      return arc_length_;
    }
    const MergedLoops &merged() const
    {
      return merged_;
    }
    const NodalForces &forces() const
    {
      return forces_;
    }
    const DrivenRigidBodies &driven() const
    {
      return driven_;
    }
    LinearSolverParameters::Type solver_type() const
    {
      return solver_->type();
    }
    /// A system of this attempt leaves bodies free; the flat index of the last null pivot.
    bool singular() const
    {
      return singular_;
    }
    /// A symmetric system of this increment has had more negative eigenvalues than multipliers.
    bool unstable() const
    {
      return unstable_;
    }
    DoFIndex null_pivot() const
    {
      return null_pivot_;
    }

    /// Loads, released reactions and reactions: all forces on the bodies but those of contact.
    Vector applied_forces() const;
    /// Forces that hold what is prescribed, zero elsewhere.
    Vector reactions() const;

  private:
    void        impose();
    Norms       assemble_contact();
    bool        complete_tangent(bool again);
    void        limit_step(const BlockVector &correction);
    void        warn_of_free_motions();
    std::string ways_to_hold(const std::string &first) const;

    Model                        &model_;
    Journal                      &journal_;
    States                       &states_;
    std::unique_ptr<ChosenSolver> solver_;
    DrivenRigidBodies             driven_;
    ArcLength                     arc_length_;
    LinearSystem                  system_;
    NodalForces                   forces_;
    Vector                        u_;      ///< displacements with ghosts, of the trial
    Vector                        anchor_; ///< of the dashpots that hold() sets
    double                        relaxed_work_ = 0.;
    Vector                        bulk_rhs_; ///< right-hand side before contact
    struct
    {
      TripletMatrix entries;
      bool          symmetric = true;  ///< there are none, on any rank
      bool          complete  = false; ///< with what the geometry adds, where that is merged
    } variation_;                      ///< of the last system
    const dealii::AffineConstraints<double> *constraints_ = nullptr; ///< of the trial
    struct
    {
      BlockVector                     unknowns;
      std::vector<RigidBodies::State> rigid;
    } iterate_; ///< that the correction starts from
    struct
    {
      bool predicted = false; ///< along the motion of the last increment
      bool guess     = false; ///< likewise, and nothing is corrected yet
    } start_;                 ///< of the attempt
    Increment   increment_;
    MergedLoops merged_;
    std::string cycling_;
    DoFIndex    null_pivot_        = dealii::numbers::invalid_dof_index;
    bool        singular_          = false;
    bool        unstable_          = false;
    bool        scattered_         = false; ///< an iterate is far from balance
    bool        has_tangent_       = false; ///< system_ is that of the trial
    bool        motions_unknown_   = false; ///< an interval begins
    double      step_limit_        = 1.;    ///< part of the correction that may be taken
    double      prescribed_before_ = 0.;    ///< still to be met at the last iterate, relative
  };
} // namespace Nodus

#endif
