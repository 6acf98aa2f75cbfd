#ifndef nodus_parameters_solution_parameters_h
#define nodus_parameters_solution_parameters_h

#include <nodus/base/types.h>
#include <nodus/plugins/plugin.h>

#include <string>
#include <vector>

// How the problem is solved: loops, Newton's method, linear solver, load steps, adaptivity, files. Each struct is one
// subsection of the parameter file, as in parameters.h.

namespace Nodus
{
  class ErrorIndicator;
  enum class Remedy : unsigned int;

  struct LoopParameters
  {
    enum class Mode
    {
      fixed_point,
      newton, ///< part of each Newton iteration, no loop
      once    ///< geometry alone: as the increment begins
    };
    unsigned int maximum_passes = 10;
    double       tolerance      = 0.; ///< relative; the status loop has none: no status may change
    Mode         mode           = Mode::fixed_point;
  };

  struct NewtonParameters
  {
    unsigned int maximum_iterations = 25;
    double       force_tolerance    = 1e-8; ///< relative to the largest nodal force
    double contact_tolerance = 1e-8; ///< gap and slip relative to the displacement of the step; friction law absolute
    bool   line_search       = false;
    double largest_forcing_term = 1e-3; ///< relative accuracy of a correction; 0: that of the linear solver
  };

  struct LinearSolverParameters
  {
    enum class Type
    {
      automatic, ///< see ChosenSolver
      direct,
      block,
      condensed
    };
    /// Multigrid on the displacements; the others are libraries that the program opens when they are asked for.
    enum class Preconditioner
    {
      nodus,
      ml,
      muelu
    };
    Type           type                = Type::direct;
    double         tolerance           = 1e-10; ///< block, condensed: relative residual
    unsigned int   maximum_iterations  = 500;   ///< block, condensed: Krylov iterations
    double         augmentation_factor = 2.;    ///< block: gamma, in units of the diagonal of the stiffness
    Preconditioner preconditioner      = Preconditioner::nodus; ///< block, condensed
  };

  /// What is tried where something fails.
  struct StrategyParameters
  {
    std::vector<std::string> without; ///< remedy_names that are not used

    bool uses(Remedy remedy) const;
  };

  struct LoadSteppingParameters
  {
    enum class Control
    {
      time,
      arc_length ///< time follows from a given motion (run/arc_length.h)
    };
    std::vector<double>       interval_ends = {1.}; ///< increasing times; the first interval starts at 0
    std::vector<unsigned int> increments    = {1};  ///< per interval
    bool                      predictor     = true; ///< start where the motion of the last increment leads
    bool                      cut_back      = true; ///< halve increments that fail
    double       minimum_increment = 0.; ///< of time, that cut-backs stop at; 0 = 1/64 of the interval's increments
    double       maximum_increment = 0.; ///< of time, that increments grow to; 0 = the interval's increments
    unsigned int easy_iterations   = 10; ///< of Newton, up to which the next increment may be twice as large
    /// Of all intervals, or of each [-], see ViscousStabilisation; 0: none.
    std::vector<double>  viscous_stabilisation = {0.};
    std::vector<Control> control               = {Control::time}; ///< of all intervals, or of each
    double               arc_length = 0.; ///< motion of an increment [length]; 0: that of the interval's first one
    unsigned int         maximum_increments = 1000; ///< of an interval under arc length

    /// #viscous_stabilisation of @p interval, from 0; whether any has it.
    double stabilisation(unsigned int interval) const;
    bool   is_stabilised() const;
    /// Whether @p interval, from 0, is under arc length; whether any is.
    bool has_arc_length(unsigned int interval) const;
    bool has_arc_length() const;
  };

  struct AdaptivityParameters
  {
    enum class Indicator
    {
      stress_and_contact, ///< of the error of the stress, with the contact terms
      own                 ///< #own_indicator
    };
    enum class Marking
    {
      fixed_fraction,
      target_error
    };
    unsigned int interval               = 0;  ///< refine after every so many increments; 0: never
    unsigned int initial_cycles         = 0;  ///< before the first increment, near expected contact
    double       contact_distance       = 0.; ///< gaps up to here are expected to close [length]; 0: a slave face
    unsigned int repetitions            = 0;  ///< of an increment, until nothing is to be refined
    Indicator    indicator              = Indicator::stress_and_contact;
    double       bulk_weight            = 1.; ///< of the stress against the recovered one
    double       contact_weight         = 1.; ///< of the contact indicator
    Marking      marking                = Marking::fixed_fraction;
    double       refine_fraction        = 0.3; ///< of the squared error in the cells to be refined (fixed fraction)
    double       coarsen_fraction       = 0.03;
    double       target_error           = 0.05; ///< relative, in energy (target error)
    unsigned int maximum_level          = 2;    ///< refinements beyond those of the body
    double       maximum_unknowns       = 1e6;  ///< displacement degrees of freedom
    bool         slave_at_least_as_fine = true;

    Chosen<ErrorIndicator> own_indicator; ///< one that a plug-in has registered, or that the program makes
  };

  struct OutputParameters
  {
    enum class Configuration
    {
      undeformed, ///< where nodes were; with the displacement to warp by
      deformed
    };
    enum class NodalValues
    {
      averaged, ///< over the cells around a node, which they share
      by_cell   ///< each cell has nodes of its own
    };
    std::string              results_folder; ///< empty = results/<name of the .prm file>, in the working folder
    bool                     write_vtu           = true;
    unsigned int             vtu_interval        = 1;           ///< every so many increments; 0 = only the last one
    std::vector<std::string> fields              = {"default"}; ///< names, see output_fields()
    Configuration            configuration       = Configuration::undeformed; ///< of the points of VTU files
    NodalValues              nodal_values        = NodalValues::averaged;     ///< stresses and strains of VTU files
    unsigned int             checkpoint_interval = 10; ///< every so many increments; 0 = on signals only
  };

  /// A point of a body whose values are written.
  struct OutputPointParameters
  {
    std::string  name;
    unsigned int body = 1;       ///< number, from 1
    Vector3      position;       ///< in the undeformed configuration, as the body stands in the model [length]
    std::string  body_name = {}; ///< which Parameters::read() replaces by the number
  };

  /// Points of a body along a straight line whose values are written.
  struct OutputLineParameters
  {
    std::string  name;
    unsigned int body = 1;        ///< number, from 1
    Vector3      from, to;        ///< ends, as OutputPointParameters::position [length]
    unsigned int points    = 101; ///< at equal distances, with both ends
    std::string  body_name = {};  ///< which Parameters::read() replaces by the number
  };
} // namespace Nodus

#endif
