#ifndef nodus_run_contact_problem_implementation_h
#define nodus_run_contact_problem_implementation_h

#include "base/profile.h"
#include "bulk/boundary_conditions.h"
#include "bulk/material.h"
#include "bulk/solid_assembler.h"
#include "bulk/viscous_stabilisation.h"
#include "contact/contact_assembler.h"
#include "contact/unconstrained_modes.h"
#include "mesh/bodies.h"
#include "mesh/refinement.h"
#include "output/console.h"
#include "output/diagnosis/diagnosis.h"
#include "output/energies.h"
#include "output/tables.h"
#include "output/vtu.h"
#include "rigid/rigid_bodies.h"
#include "run/checkpoint.h"
#include "run/fixed_point_loop.h"
#include "run/load_stepping.h"
#include "solve/anderson_mixing.h"
#include "solve/linear_solver.h"
#include "solve/newton.h"
#include "solve/secant_acceleration.h"
#include <nodus/run/contact_problem.h>

#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping.h>

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
    /// "geometry, status" and the like, empty for none.
    std::string names() const;
  };

  /// State of a contact site in a checkpoint and on its way to a new mesh: its Status::Record, the force on the
  /// slave and the jump of the displacement.
  using SiteState = std::array<double, std::tuple_size<Status::Record>::value + 2 * dim>;

  /// Everything a run owns. contact_problem.cc builds it and reports, load_path.cc goes from increment to increment,
  /// load_increment.cc holds the three nested loops, approach_friction.cc a way to a first iterate, pair_surfaces.cc
  /// the geometry passes, newton_iterate.cc what Newton sees, restart.cc the checkpoints, failed_state.cc what is kept
  /// of an increment that fails, free_motion.cc knows what nothing holds, adapt.cc changes the mesh, rigid_motion.cc
  /// lets forces drive rigid bodies.
  struct ContactProblem::Implementation : public NewtonProblem
  {
    Implementation(const Parameters &parameters, MPI_Comm communicator, std::ostream &log);

    // The algorithm, outermost first.
    void                 run();
    void                 follow_load_path();
    void                 impose(double t);
    void                 solve_increment();
    void                 approach_friction();
    void                 solve_loops();
    void                 pair_surfaces();
    void                 freeze_geometry();
    void                 carry_over_sticking();
    std::vector<Vector3> surface_displacement() const;
    void                 weigh_surfaces();
    void                 pass_to_regularised_law();
    void                 check_frozen_statuses();
    void                 note_pass(const FixedPointLoop &loop, double value, const std::string &worst);
    bool                 geometry_converged(FixedPointLoop &loop, AndersonMixing &mixing);
    bool                 threshold_converged(FixedPointLoop &loop, SecantAcceleration &secant);
    bool                 statuses_converged(FixedPointLoop &loop);
    Status::Update       update_statuses(bool closing_only = false);

    LinearSolver::Report solve_system(const std::vector<const BlockVector *> &rhs,
                                      std::vector<BlockVector>               &corrections,
                                      double                                  relative_tolerance);
    LinearSolver::Report solve_with_rigid_bodies(BlockVector &correction, double relative_tolerance);

    // Newton's view of it.
    Norms        assemble() override;
    unsigned int solve(BlockVector &correction, double relative_tolerance) override;
    void         advance(double factor, const BlockVector &correction) override;

    Norms                    assemble_contact(const dealii::AffineConstraints<double> &constraints);
    void                     add_rigid_nodes();
    void                     drag_rigid_bodies(const Vector &moved);
    void                     add_rigid_norms(double length, Norms &norms);
    bool                     may_wait_for_friction(double force) const;
    std::string              describe_rigid_motion(const std::vector<double> &motion) const;
    void                     follow_pressure();
    void                     freeze_threshold();
    void                     update_slip_rates();
    void                     start_contact();
    void                     gather_state();
    std::string              site_locus(unsigned int site) const;
    std::vector<std::string> site_loci(const std::vector<unsigned int> &sites, unsigned int n) const;
    double                   largest_difference(const Vector &a, const Vector &b, std::string *worst = nullptr) const;
    std::string              unknown_locus(DoFIndex flat_index) const;
    void                     commit();
    Vector                   applied_forces() const;
    void                     audit_energies();
    double                   negligible_dissipation() const;
    void                     warn_of_energies(const Energies &increment, const std::vector<unsigned int> &creating);
    double                   release_fraction(double t) const;
    void                     roll_back();
    void                     warn_of_lost_partners();
    void                     warn_of_free_motions();
    void                     report_stabilisation();
    void                     check_stabilised_motion();
    std::string              diagnose(const SolverFailure &failure, bool may_shrink);
    FailureEvidence          evidence_of(const SolverFailure &failure, bool may_shrink);
    std::vector<UnconstrainedModes::Motion> free_motions(const OwnedNodes &nodes, bool as_closed = false) const;
    unsigned int                            n_closed() const;
    bool                                    begins_singular() const;
    std::string                             ways_to_hold(const std::string &first) const;
    void                                    propose_springs(FailureEvidence &evidence) const;
    void                                    find_worst_nodes(const OwnedNodes &nodes, FailureEvidence &evidence) const;
    void                                    find_changing_sites(FailureEvidence &evidence) const;
    void                                    find_partners(FailureEvidence &evidence) const;
    std::vector<float>                      find_distorted_cells(FailureEvidence &evidence);
    void                                    find_repeated_constraint(FailureEvidence &evidence) const;
    void write_failed_state(const std::string &name, const std::vector<float> &det_F);
    [[noreturn]] void
         give_up(const std::string &reason, const std::string &hint, bool converged_before, bool may_shrink);
    void set_up_mesh();
    void begin_on_mesh();
    RefinementIndicator    estimate_error();
    bool                   refine(const RefinementIndicator &indicator, bool keep_state);
    void                   refine_near_contact();
    bool                   adapt_mesh();
    void                   restore_equilibrium();
    std::vector<SiteState> node_states() const;
    std::vector<SiteState> interpolated_sites(const std::vector<Vector> &vectors) const;
    std::vector<Vector>    nodal_state(bool in_space) const;
    void                   write_checkpoint();
    void                   read_checkpoint();
    void                   match_mesh(const std::vector<std::filesystem::path> &pieces);
    void                   read_pieces(const std::vector<std::filesystem::path> &pieces);
    void                   heed_signals();
    void                   write(unsigned int increment, bool last);
    void                   write_initial_state();
    void                   update_results();
    void                   summary();
    std::string            report_profile(bool converged);
    void set_nodal_state(const std::vector<Vector> &vectors, bool in_space, std::vector<SiteState> sites);

    std::vector<double> pair_stiffness() const;

    const Parameters parameters;
    MPI_Comm         communicator;
    Console          console;
    Profile          profile;
    bool             detailed_profile = false; ///< asked for: table with memory, profile.json

    Bodies                                      bodies;
    std::unique_ptr<const dealii::Mapping<dim>> mapping;
    dealii::FESystem<dim>                       fe;
    dealii::DoFHandler<dim>                     dof_handler;
    dealii::IndexSet                            relevant;
    std::vector<std::unique_ptr<Material>>      materials;
    std::unique_ptr<RigidBodies>                rigid_bodies; ///< those that forces drive
    std::unique_ptr<BoundaryConditions>         boundary_conditions;
    std::unique_ptr<SolidAssembler>             solid;

    std::unique_ptr<ContactSurfaces>  surfaces;
    std::vector<Point>                paired_at; ///< positions of the surface nodes at the last pairing
    std::unique_ptr<ContactGeometry>  geometry;  ///< of that
    AveragedJump                      averaged;
    Pairing                           pairing;
    JumpOperator                      jump;
    SurfaceWeights                    weights;
    std::unique_ptr<Status>           status;
    std::unique_ptr<ContactAssembler> contact;

    LinearSolverParameters        linear_solver_parameters; ///< on the mesh at hand, never automatic
    std::unique_ptr<LinearSolver> linear_solver;
    std::unique_ptr<LinearSolver> direct_solver; ///< where an iterative one has failed
    LinearSystem                  system;
    BlockVector                   solution, committed; ///< (u, lambda, Lambda), now and at the start of the load step
    Vector                        relevant_u, internal, external, contact_force;
    double                        stiffness_scale = 0.; ///< largest diagonal entry of the first bulk tangent
    double                        length_scale; ///< displacements are measured against this when the step moves nothing

    std::vector<double>                  rigid_correction; ///< of driven rigid bodies, the last one
    unsigned int                         rigid_waits = 0;  ///< corrections in which some wait for friction
    std::vector<RigidBodies::Components> rigid_applied;    ///< what these resist with, all ranks
    std::vector<RigidBodies::Unknowns>   rigid_geometry;   ///< at the last pairing

    double committed_stiffness_scale = 0.;
    Vector reaction; ///< of what was prescribed when the last interval ended; what is released sheds it
    std::unique_ptr<ViscousStabilisation> stabilisation;
    Vector                                drag;     ///< of it, part of the external forces
    Vector                                released; ///< what is left of it now where nothing is prescribed any more
    Energies                              energies; ///< up to the last converged increment
    Vector                                committed_applied;    ///< applied_forces() at its end
    std::vector<Vector3>                  committed_site_force; ///< on the slave there, right at owned sites
    std::vector<Vector3>                  committed_site_jump;  ///< of the displacement there, likewise
    bool                                  mesh_is_new = false;  ///< until the next commit
    std::vector<char>                     jump_known;           ///< then: sites that stick between others that do
    std::vector<Vector3>                  kept_jump;            ///< and their jumps of the displacement
    Pairing                               committed_pairing;    ///< at the start of the load step
    std::vector<double> nodal_area, committed_area; ///< that the multipliers of solution and committed refer to

    ContactState    state;
    ContactResidual residual;
    Vector          out_of_balance;   ///< nodal forces of the last iterate that has any, zero where prescribed
    double          force_scale = 0.; ///< that they are relative to in the norms
    DoFIndex        null_pivot  = dealii::numbers::invalid_dof_index; ///< flat index, of a singular system
    bool            singular    = false;                              ///< a system of this attempt leaves bodies free
    Vector          u_geometry, u_before_geometry; ///< displacements of this and the previous pairing
    std::string     first_changed, cycling;        ///< sites of the last change of statuses, and of the last cycle
    unsigned int    mesh_repetitions = 0;          ///< of the increment at hand on a finer mesh
    unsigned int    geometry_cycles  = 0;          ///< with period 2, in the geometry loop at hand
    bool            paired_before = false, newton_starts = true;
    bool            motions_unknown   = false; ///< of the bodies, as the first increment of an interval begins
    double          prescribed_before = 0.;    ///< still to be met at the last assembly, relative
    MergedLoops     merged;                    ///< in this attempt at the increment
    bool            approaches = false;        ///< a first iterate in it: the friction limits are not all in force

    LoadStepping    path;
    bool            restart = false; ///< asked for: continue from a checkpoint
    double          time    = 0.;    ///< that the increment at hand goes to
    IterationCounts pass, counts;    ///< where the loops stand, and totals of the increment

    std::vector<ContactFields>                   fields;       ///< of this rank's part of the surfaces
    std::vector<ContactFields>                   whole_fields; ///< of all ranks, once somebody asked for them
    std::vector<ContactResultants>               resultants;
    std::vector<std::pair<std::string, Vector3>> reactions;
    std::vector<RigidBodyMotion>                 rigid_motions;
    std::function<void(unsigned int, double)>    callback;
    std::unique_ptr<VtuOutput>                   vtu;
    std::unique_ptr<Tables>                      tables;
    Checkpoints                                  checkpoints;
    Diagnosis                                    diagnosis;
  };

  /// "(x y z)", for messages.
  std::string coordinates(const Point &X);
  /// " (name)", or nothing without a name.
  std::string in_brackets(const std::string &name);
} // namespace Nodus

#endif
