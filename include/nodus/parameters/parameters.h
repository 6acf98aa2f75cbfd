#ifndef nodus_parameters_parameters_h
#define nodus_parameters_parameters_h

#include <nodus/base/types.h>
#include <nodus/parameters/condition_parameters.h>
#include <nodus/parameters/solution_parameters.h>
#include <nodus/plugins/plugin.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace Nodus
{
  class MaterialLaw;
  class ParameterFile;
  struct DeclaredKey;
  class FrictionLaw;
  class PressureGapLaw;

  /// Every struct below is one subsection of the parameter file; the text of a key is the name of the
  /// member with blanks, "Young's modulus" and the like excepted. Keys are bound to members and checked
  /// in source/parameters/ (parameters*.cc); values here are the defaults that `nodus --document`
  /// prints.

  /// A rigid surface in closed form or of triangles, its body on one side. Convex bodies, or a cavity around the slave.
  struct MasterSurfaceParameters
  {
    enum class Shape
    {
      mesh, ///< no such surface: the master is part of a mesh
      plane,
      sphere,
      cylinder,
      paraboloid, ///< of revolution, with the radius of curvature at its apex
      triangles   ///< of an STL file
    };
    Shape   shape = Shape::mesh;
    Point   point;          ///< of the plane, centre, on the axis of the cylinder, apex, file's origin
    Vector3 axis;           ///< of the cylinder; outward normal of plane and apex
    double  radius = 0.;    ///< > 0 [length]
    bool    cavity = false; ///< the body is outside of sphere, cylinder, paraboloid; triangles: turned
    PrescribedMotionParameters motion;
    std::string                file;       ///< of triangles; resolved against the folder of the .prm file
    double                     scale = 1.; ///< > 0, factor on its coordinates
  };

  struct MaterialParameters
  {
    enum class Law
    {
      linear_elastic,
      st_venant_kirchhoff,
      neo_hookean,
      mooney_rivlin,
      ogden,
      j2_plasticity,
      own ///< #own_law
    };
    Law    law                 = Law::neo_hookean;
    double youngs_modulus      = 0.;  ///< initial E > 0 [pressure], to be given; Ogden: follows from the moduli
    double poissons_ratio      = 0.3; ///< initial nu [-], in (-1, 1/2)
    double mooney_rivlin_ratio = 0.;  ///< c01/c10 >= 0 (Mooney-Rivlin only)

    std::vector<double> ogden_moduli;    ///< mu_i [pressure] of the terms mu_i/alpha_i (...)
    std::vector<double> ogden_exponents; ///< alpha_i [-], as many

    /// J2 plasticity: sigma_y(a) = yield + modulus a + (saturation - yield) (1 - exp(-rate a)), or the table.
    double              yield_stress      = 0.; ///< initial, > 0 [pressure]
    double              hardening_modulus = 0.; ///< [pressure]
    double              saturation_stress = 0.; ///< >= yield stress [pressure]; 0: none
    double              saturation_rate   = 0.; ///< [-]
    std::vector<double> hardening_strains;      ///< equivalent plastic strains from 0, increasing [-]
    std::vector<double> hardening_stresses;     ///< yield stresses at these, not decreasing [pressure]

    Chosen<MaterialLaw> own_law; ///< one that a plug-in has registered, or that the program makes
  };

  struct BodyParameters
  {
    enum class VolumetricTreatment
    {
      standard,
      mean_dilatation
    };
    std::string               name;
    std::string               mesh_file;           ///< resolved against the folder of the .prm file
    std::vector<unsigned int> volume_ids;          ///< physical volumes taken from the file; empty = all
    std::vector<std::string>  volume_names;        ///< those that are named; Parameters::read() makes ids of them
    std::string               generator;           ///< deal.II GridGenerator function, when no mesh file
    std::string               generator_arguments; ///< separated by ':', as deal.II prints them
    double                    scale = 1.;
    Vector3                   rotation_axis; ///< with rotation_angle in degrees; about the origin
    double                    rotation_angle = 0.;
    Vector3                   translation; ///< applied after scale and rotation [length]
    unsigned int              global_refinement = 0;
    unsigned int              local_refinement  = 0; ///< more of it ...
    std::string               refine_where;          ///< ... where this muParser predicate holds at cell centres
    VolumetricTreatment       volumetric_treatment = VolumetricTreatment::standard;
    MaterialParameters        material; ///< of a body that is not rigid
    /// A rigid body may go without: it carries surfaces in closed form.
    bool has_mesh() const
    {
      return !mesh_file.empty() || !generator.empty();
    }

    bool                       rigid = false;
    PrescribedMotionParameters motion;     ///< of a rigid body; keys "Rigid translation", ...
    std::vector<unsigned int>  rigid_free; ///< components that force and moment drive: 0-2 translation, 3-5 rotation
    std::vector<std::string>   rigid_force  = {"0", "0", "0"}; ///< muParser expressions of t [force]
    std::vector<std::string>   rigid_moment = {"0", "0", "0"}; ///< about the centre as it moves [force length]
  };

  /// How surfaces in contact give way under pressure p: the overclosure d, minus the gap.
  struct PressureGapParameters
  {
    enum class Law
    {
      hard,        ///< d = 0
      linear,      ///< p = k d
      exponential, ///< p = k l (exp(d/l) - 1)
      table,
      own ///< #own_law
    };
    Law                 law               = Law::hard;
    double              stiffness         = 0.; ///< k > 0 [pressure/length]
    double              stiffening_length = 0.; ///< l > 0 [length]
    std::vector<double> overclosures;           ///< of the table, not decreasing [length]
    std::vector<double> pressures;              ///< at these, from 0, increasing [pressure]

    Chosen<PressureGapLaw> own_law; ///< one that a plug-in has registered, or that the program makes
  };

  struct ContactPairParameters : ActiveTime
  {
    enum class Scheme
    {
      nodal,
      integration_point,
      averaged
    };
    enum class Integration
    {
      face,
      segment
    };
    enum class QuadratureRule
    {
      gauss,
      simpson,
      newton_cotes
    };
    enum class Surface
    {
      faceted,
      smoothed
    };
    enum class SurfaceMeasure
    {
      current,
      reference
    };
    enum class Weights
    {
      nodal_quadrature,
      dual,
      consistent
    };
    enum class Normal
    {
      master_facet,
      averaged,
      slave
    };
    enum class InitialStatus
    {
      by_gap,
      closed,
      open
    };
    enum class StatusTest
    {
      weighted,
      raw
    };
    enum class ContactLaw
    {
      unilateral,
      bilateral, ///< what has closed never opens
      tied       ///< closed from the start, without slip
    };
    enum class FrictionLaw
    {
      coulomb,
      tresca,
      own ///< #own_friction_law
    };
    enum class InitialOverclosure
    {
      resolve,     ///< pressed out of each other in the first increment
      adjust,      ///< taken as the undeformed state
      interference ///< pressed out in the course of the interval that the pair begins to act in
    };
    /// What holds as a run begins, or where the pair begins to act later.
    struct Start
    {
      InitialStatus      status              = InitialStatus::by_gap;
      InitialOverclosure overclosure         = InitialOverclosure::resolve;
      double             adjustment_distance = 0.; ///< gaps up to here are adjusted, too [length]
      double             overclosure_limit   = 0.; ///< [length]; 0 = automatic
    };
    /// Of a tied pair that cuts a bolt in two: the length of the bolt between the two faces is what a force makes it.
    struct Preload
    {
      std::string force;      ///< of the time t, tension is positive [force]; empty: the pair is no such section
      double      until = 0.; ///< from then on the length is what has been reached; 0: the force acts all the time
      Vector3     axis;       ///< of the bolt; zero: the mean normal of the slave faces
    };
    /// The master nodes of another pair, which the run holds as well (source/contact/second_pass.h).
    struct SecondPass
    {
      unsigned int of;        ///< number of that pair, from 0
      double       clearance; ///< they may be that deep [length]
    };
    std::string      name;
    RegionParameters slave;  ///< keys "Slave body", "Slave boundary ids", "Slave where"
    RegionParameters master; ///< keys "Master body", ...; that of the slave where the surface touches itself
    bool             self_contact = false;
    /// Pairs of bodies by number whose faces do not touch here, of a surface that touches itself, ...
    std::vector<std::pair<unsigned int, unsigned int>> excluded_bodies;
    std::vector<std::string> excluded_names; ///< ... as they are given; Parameters::read() makes numbers of them
    ContactLaw               contact_law                 = ContactLaw::unilateral;
    FrictionLaw              friction_law                = FrictionLaw::coulomb;
    double                   friction_coefficient        = 0.;
    double                   second_friction_coefficient = 0.; ///< across the friction direction; 0: the same
    Vector3                  friction_direction;               ///< of the first coefficient; zero: there is only one
    std::string              friction_factor = "1";            ///< of reference x, y, z, slip rate v and time t
    double                   shear_limit     = 0.;             ///< [pressure]; 0: none
    double                   elastic_slip    = 0.;             ///< at which friction reaches its limit [length]
    PressureGapParameters    pressure_gap;

    Chosen<Nodus::FrictionLaw> own_friction_law; ///< one that a plug-in has registered, or that the program makes
    double                     normal_augmentation_factor     = 1.;  ///< times E/h gives rho_n
    double                     tangential_augmentation_factor = 0.1; ///< times rho_n/|mu lambda_s| gives rho_tau
    Scheme                     scheme                         = Scheme::averaged;
    Integration                integration                    = Integration::segment; ///< averaged scheme
    QuadratureRule             quadrature_rule      = QuadratureRule::gauss; ///< points, consistent, averaged by face
    unsigned int               quadrature_points    = 0; ///< per direction of a slave face; 0 = automatic
    SurfaceMeasure             surface_measure      = SurfaceMeasure::current;
    Weights                    weights              = Weights::nodal_quadrature;
    Surface                    surface              = Surface::smoothed;
    Normal                     normal               = Normal::averaged;
    double                     search_distance      = 0.;   ///< [length]; 0 = automatic
    double                     projection_tolerance = 0.05; ///< overhang accepted, in face sizes
    Start                      start;
    StatusTest                 status_test = StatusTest::weighted;

    MasterSurfaceParameters master_surface; ///< instead of the master faces; keys "Master surface", ...
    Preload                 preload;        ///< keys "Preload", "Preload until", "Preload axis"

    std::optional<SecondPass> second_pass; ///< of a pair that the run has added; no key

    /// One in closed form that moves with a rigid body of the model.
    bool has_carried_master() const
    {
      return has_rigid_master() && !master.bodies.empty();
    }
    /// Of a bolt, which a force tightens.
    bool is_section() const
    {
      return !preload.force.empty();
    }
    /// Whether the preload acts at time @p t, or the section is locked.
    bool is_tightened(const double t) const
    {
      return acts(t) && (preload.until == 0. || t <= preload.until);
    }
    bool has_rigid_master() const
    {
      return master_surface.shape != MasterSurfaceParameters::Shape::mesh;
    }
    /// Of the averaged scheme: there is nothing that segments could end at on a rigid master.
    Integration applied_integration() const
    {
      return has_rigid_master() ? Integration::face : integration;
    }
  };

  struct Parameters
  {
    std::string                              file; ///< the .prm or .json file, for messages
    std::string                              title;
    std::vector<std::string>                 additional_shared_libraries; ///< plug-ins that read() has loaded
    unsigned int                             degree = 1;                  ///< of the displacement, 1 or 2
    std::vector<BodyParameters>              bodies;
    std::vector<BoundaryConditionParameters> boundary_conditions;
    std::vector<ContactPairParameters>       contact_pairs; ///< those given; a run adds second passes behind them
    LoopParameters                           geometry_loop  = {15, 1e-5, LoopParameters::Mode::newton};
    LoopParameters                           threshold_loop = {30, 1e-4, LoopParameters::Mode::newton};
    LoopParameters                           status_loop    = {30, 0., LoopParameters::Mode::newton};
    NewtonParameters                         newton;
    LinearSolverParameters                   linear_solver = {LinearSolverParameters::Type::automatic};
    StrategyParameters                       strategy;
    LoadSteppingParameters                   load_stepping;
    AdaptivityParameters                     adaptivity;
    OutputParameters                         output;
    std::vector<OutputPointParameters>       output_points;
    std::vector<OutputLineParameters>        output_lines;

    /// Loads the plug-ins that @p file or @p overrides name, for explain() and documentation(). @throws InputError
    /// @returns their files
    static std::vector<std::string> load_libraries(const std::string              &file,
                                                   const std::vector<std::string> &overrides = {});

    /// Strict parse of @p file after @p overrides ("Section/Key=value"), with load_libraries(). @throws InputError
    static Parameters read(const std::string &file, const std::vector<std::string> &overrides = {});

    /// Values of the keys that may not change from a checkpoint to the restart, by "Section/Key": discretization,
    /// bodies, boundary conditions and contact pairs, as given.
    std::map<std::string, std::string> model() const;

    /// The reference of all parameters in Markdown (`nodus --document`).
    static std::string documentation();

    /// The same in JSON (`nodus --document-json`): "numbered" sections, "keys" with path ("Body <n>/Name"), default,
    /// type, allowed (in words), unit and meaning, "generators" with arguments and example. A type has a "kind": text,
    /// file, bool, integer, number (with least or above, most), id or name, choice (with choices), list (with
    /// separator, lengths least and most, of: the type of its entries).
    static std::string documentation_json();

    /// Section, default, allowed values, unit and meaning of every key whose path ("Contact pair 1/Scheme") contains
    /// @p key, in upper or lower case (`nodus --explain`). @throws InputError, with the nearest keys, without any.
    static std::string explain(const std::string &key);

  private:
    /// One of everything that is numbered, for the reference.
    static std::vector<DeclaredKey> reference_keys();

    /// Binds every key to its member; the numbers of bodies, conditions and pairs are already set.
    void add_parameters(dealii::ParameterHandler &prm);

    /// Everything that can be seen without a mesh. @throws InputError
    void check(const ParameterFile &file) const;

    /// The classes that are chosen get to work. @throws InputError
    void initialize_plugins(const ParameterFile &file);
  };

  /// Choices as they are written in the parameter file.
  std::string text_of(MaterialParameters::Law law);
  std::string text_of(BoundaryConditionParameters::Type type);
  std::string text_of(MasterSurfaceParameters::Shape shape);
  std::string text_of(ContactPairParameters::Scheme scheme);
  std::string text_of(ContactPairParameters::Integration integration);
  std::string text_of(ContactPairParameters::Surface surface);
  std::string text_of(ContactPairParameters::ContactLaw law);
  std::string text_of(PressureGapParameters::Law law);
  std::string text_of(LoopParameters::Mode mode);
  std::string text_of(LinearSolverParameters::Type type);
  std::string text_of(LinearSolverParameters::Preconditioner preconditioner);
} // namespace Nodus

#endif
