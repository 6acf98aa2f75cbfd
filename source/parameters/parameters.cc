#include "parameters/general_contact.h"
#include "parameters/generators.h"
#include "parameters/named_ids.h"
#include "parameters/parameter_file.h"
#include "parameters/parameter_keys.h"
#include "parameters/parameter_reference.h"
#include "parameters/plugin_keys.h"
#include "parameters/table_file.h"
#include <nodus/parameters/parameters.h>
#include <nodus/plugins/error_indicator.h>
#include <nodus/plugins/friction_law.h>
#include <nodus/plugins/pressure_gap_law.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <filesystem>
#include <limits>

// One line per key: its text, the member it sets, the pattern of its values and what it means.

namespace Nodus
{
  namespace
  {
    using namespace ParameterKeys;

    const Names<BodyParameters::VolumetricTreatment> treatment_names = {
        {BodyParameters::VolumetricTreatment::standard, "standard"},
        {BodyParameters::VolumetricTreatment::mean_dilatation, "mean dilatation"}};

    const Names<BoundaryConditionParameters::Type> type_names = {
        {BoundaryConditionParameters::Type::displacement, "displacement"},
        {BoundaryConditionParameters::Type::rigid_motion, "rigid motion"},
        {BoundaryConditionParameters::Type::traction, "traction"},
        {BoundaryConditionParameters::Type::pressure, "pressure"},
        {BoundaryConditionParameters::Type::body_force, "body force"},
        {BoundaryConditionParameters::Type::spring, "spring"},
        {BoundaryConditionParameters::Type::point_load, "point load"},
        {BoundaryConditionParameters::Type::point_spring, "point spring"}};

    void add(ParameterHandler &prm, BodyParameters &body)
    {
      prm.add_parameter("Name", body.name, "Name in tables and messages [-].", Patterns::Anything());
      prm.add_parameter(
          "Mesh file",
          body.mesh_file,
          "Gmsh file of hexahedra of first or second order (8, 20 or 27 nodes) [-], relative to the folder of "
          "the .prm file. The curved cells of a second-order file are kept under refinement; with Degree "
          "= 1 only the corners of the refined cells count. A body has either a mesh file or a generator.",
          Patterns::FileName());
      add_ids(prm,
              "Volume ids",
              body.volume_ids,
              body.volume_names,
              "Physical volumes taken from the mesh file [-], by id or name, e.g. 2 or upper ring; empty: all.");
      prm.add_parameter("Generator",
                        body.generator,
                        "Function of deal.II's GridGenerator that makes the mesh [-], e.g. "
                        "subdivided_hyper_rectangle; the table of generators at the end of this reference has them "
                        "all, --explain finds them by name.",
                        Patterns::Anything());
      prm.add_parameter(
          "Generator arguments",
          body.generator_arguments,
          "All arguments of the generator but the mesh, separated by ':' [length where they are "
          "coordinates], e.g. 3,3,2 : 0,0,0 : 1,1,1 : true for subdivided_hyper_rectangle: cells, two "
          "corners, colorize. With colorize the sides x-, x+, y-, y+, z-, z+ of a box have the boundary "
          "ids 0 to 5, without it all have 0. cylinder: radius : half of the length along x (ids 0 hull, 1 "
          "x-, 2 x+); hyper_ball: centre : radius. --validate prints the ids that there are.",
          anything_separated_by(":"));
      prm.add_parameter("Scale", body.scale, "Factor on all coordinates, before the rotation [-].", positive);
      prm.add_parameter("Rotation axis", body.rotation_axis, "Axis of the rotation about the origin [-].");
      prm.add_parameter("Rotation angle", body.rotation_angle, "Angle of the rotation [degrees].", any_number);
      prm.add_parameter("Translation", body.translation, "Shift after scaling and rotation [length].");
      prm.add_parameter(
          "Global refinement", body.global_refinement, "Times every cell of the body is split into eight [-].", count);
      prm.add_parameter("Local refinement",
                        body.local_refinement,
                        "Times that cells are split after that where Refine where holds at their centres [-].",
                        count);
      prm.add_parameter(
          "Refine where",
          body.refine_where,
          "Expression of x, y, z [length], in place, that is not zero where cells are refined locally, e.g. "
          "x*x + y*y < 4 [-]; asked at the centres of the cells before each time that they are split.",
          Patterns::Anything());
      add_choice(
          prm,
          "Volumetric treatment",
          body.volumetric_treatment,
          treatment_names,
          "How the change of volume is integrated [-]: standard, at each point; mean dilatation, as the constant "
          "(Degree = 1) or linear (Degree = 2) mean in each cell, which does not lock where the material is "
          "nearly incompressible: rubber, metal that yields.");
      prm.add_parameter(
          "Rigid",
          body.rigid,
          "Whether the body is rigid and moves as the following keys say [-]; it has no material. One that "
          "carries surfaces in closed form alone (Master surface of contact pairs) needs no mesh either.");
      add_motion(prm, "Rigid ", body.motion, "", "the origin");
      add_drive(prm, "Rigid ", "the rigid body", "", body.rigid_free, body.rigid_force, body.rigid_moment);
      prm.enter_subsection("Material");
      add_material(prm, body.material);
      prm.leave_subsection();
    }

    void add(ParameterHandler &prm, BoundaryConditionParameters &condition)
    {
      prm.add_parameter("Name", condition.name, "Name in tables and messages [-].", Patterns::Anything());
      add_choice(
          prm,
          "Type",
          condition.type,
          type_names,
          "What is prescribed [-]: displacement [length], that of points which move as one rigid body, in part found "
          "from force and moment where components are Free, traction per "
          "reference area [pressure], pressure that "
          "follows the surface and pushes on the body where positive [pressure], body force per reference volume "
          "[force/volume], spring to the ground per reference area [pressure/length], force at one Point of a body "
          "[force], spring to the ground at one Point [force/length].");
      add_region(
          prm,
          "",
          condition.region,
          "; 0: every body",
          "For displacements it is asked at the nodes, for loads at the centres of the faces (body force: cells).");
      prm.add_parameter("Point",
                        condition.point,
                        "Where a point load or point spring acts, in the reference configuration [length]: x, y, z of "
                        "any point in or on a body, which need not be a node; the shape functions of the cell there "
                        "share the force out to its nodes. Where bodies touch, Body says on which of them it acts.",
                        numbers);
      add_components(prm,
                     "Components",
                     condition.components,
                     "Directions the condition acts in [-], e.g. x, z; none for a pressure.");
      prm.add_parameter("Direction",
                        condition.direction,
                        "Of a traction, body force, spring, point load or point spring [-]: the one direction that it "
                        "acts along, instead of Components; three numbers in global axes, of any length.",
                        numbers);
      add_expressions(
          prm,
          "Value",
          condition.value,
          "Prescribed value [as Type says]: expressions of x, y, z [length], the time t [-] and, where there is a "
          "table, its value at time t, e.g. 0.5*x*table, separated by ';', one for each component, or one that holds "
          "for all of them. Displacements count from the reference position. A total force F is a traction F/A, A the "
          "area that --validate prints.");
      prm.add_parameter("Table times",
                        condition.table_times,
                        "Times of a table [-], increasing, two at least, separated by ','. Its value, table in the "
                        "expressions of Value, is linear between them, and that of the first or last time before and "
                        "after them.",
                        numbers);
      prm.add_parameter("Table values",
                        condition.table_values,
                        "Values of the table at these times [as Type says], as many, separated by ','.",
                        numbers);
      prm.add_parameter("Table file",
                        condition.table_file,
                        "File that has the table instead [-], relative to the folder of the .prm file: in each line a "
                        "time and a value, separated by ',', ';' or blanks; lines that begin with #, and a first line "
                        "of names, are passed over.",
                        Patterns::FileName());
      add_motion(prm, "", condition.motion, "; of a rigid motion", "the origin");
      add_drive(prm,
                "",
                "the face of a rigid motion",
                " The nodes follow in the directions of Components.",
                condition.free,
                condition.force,
                condition.moment);
      add_active_time(prm,
                      condition,
                      "condition",
                      "a load is zero and a displacement free; what held it, its reaction, goes to zero");
    }

    void add(ParameterHandler &prm, ContactPairParameters &pair)
    {
      add_contact_pair(prm, pair);
    }

    void add(ParameterHandler &prm, OutputParameters &output)
    {
      add_output(prm, output);
    }

    void add(ParameterHandler &prm, OutputPointParameters &point)
    {
      add_output_point(prm, point);
    }

    void add(ParameterHandler &prm, OutputLineParameters &line)
    {
      add_output_line(prm, line);
    }

    template <typename Struct>
    void add_subsection(ParameterHandler &prm, const std::string &name, Struct &parameters)
    {
      prm.enter_subsection(name);
      add(prm, parameters);
      prm.leave_subsection();
    }

    template <typename Struct>
    void add_numbered(ParameterHandler &prm, const std::string &name, std::vector<Struct> &all)
    {
      for (unsigned int i = 0; i < all.size(); ++i)
        add_subsection(prm, name + ' ' + std::to_string(i + 1), all[i]);
    }
  } // namespace

  void Parameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Title", title, "Title of the case, for the log [-].", Patterns::Anything());
    prm.add_parameter(libraries_key,
                      additional_shared_libraries,
                      "Plug-ins [-], separated by ',', relative to the folder of the .prm file: shared libraries that "
                      "bring laws and indicators of one's own, whose names and keys nodus knows from then on (see "
                      "plugins.md).",
                      Patterns::List(Patterns::FileName(), 0, Patterns::List::max_int_value, ","));
    prm.enter_subsection("Discretization");
    prm.add_parameter("Degree", degree, "Polynomial degree of the displacement [-].", Patterns::Integer(1, 2));
    prm.leave_subsection();
    add_numbered(prm, "Body", bodies);
    add_numbered(prm, "Boundary condition", boundary_conditions);
    add_numbered(prm, "Contact pair", contact_pairs);
    add_solution(prm, *this);
    add_subsection(prm, "Output", output);
    add_numbered(prm, "Output point", output_points);
    add_numbered(prm, "Output line", output_lines);
  }

  std::string text_of(const BoundaryConditionParameters::Type type)
  {
    return text_of(type, type_names);
  }

  std::vector<DeclaredKey> Parameters::reference_keys()
  {
    Parameters parameters;
    parameters.bodies.resize(1);
    parameters.boundary_conditions.resize(1);
    parameters.contact_pairs.resize(1);
    parameters.output_points.resize(1);
    parameters.output_lines.resize(1);
    ParameterHandler prm;
    parameters.add_parameters(prm);
    return declared_keys(prm);
  }

  std::string Parameters::documentation()
  {
    return ParameterReference::page(reference_keys());
  }

  std::string Parameters::documentation_json()
  {
    return ParameterReference::json(reference_keys());
  }

  std::string Parameters::explain(const std::string &key)
  {
    return ParameterReference::explain(reference_keys(), key);
  }

  std::map<std::string, std::string> Parameters::model() const
  {
    Parameters copy(*this); // its values become the defaults of prm
    auto      &pairs = copy.contact_pairs;
    pairs.erase(
        std::remove_if(pairs.begin(), pairs.end(), [](const auto &pair) { return pair.second_pass.has_value(); }),
        pairs.end());
    ParameterHandler prm;
    copy.add_parameters(prm);
    std::map<std::string, std::string> values;
    for (const auto &key : without_idle_plugins(declared_keys(prm)))
      for (const std::string room : {"Discretization", "Body", "Boundary condition", "Contact pair"})
        if (key.section.compare(0, room.size(), room) == 0)
          values[key.section + '/' + key.key] = key.default_value;
    return values;
  }

  void Parameters::initialize_plugins(const ParameterFile &file)
  {
    for (unsigned int b = 0; b < bodies.size(); ++b)
      ParameterChecks::initialize({file, "Body " + std::to_string(b + 1) + "/Material"}, bodies[b].material);
    for (unsigned int p = 0; p < contact_pairs.size(); ++p)
    {
      const ContactPairParameters   &pair    = contact_pairs[p];
      const ParameterChecks::Section section = {file, "Contact pair " + std::to_string(p + 1)};
      if (pair.friction_law == ContactPairParameters::FrictionLaw::own)
        ParameterChecks::initialize(section, pair.own_friction_law.name, *pair.own_friction_law.object);
      if (pair.pressure_gap.law == PressureGapParameters::Law::own)
        ParameterChecks::initialize(section, pair.pressure_gap.own_law.name, *pair.pressure_gap.own_law.object);
    }
    if (adaptivity.indicator == AdaptivityParameters::Indicator::own)
      ParameterChecks::initialize(
          {file, "Adaptivity"}, adaptivity.own_indicator.name, *adaptivity.own_indicator.object);
  }

  std::vector<std::string> Parameters::load_libraries(const std::string              &file,
                                                      const std::vector<std::string> &overrides)
  {
    return load_plugins(ParameterFile(file, overrides), file, reference_keys);
  }

  Parameters Parameters::read(const std::string &file, const std::vector<std::string> &overrides)
  {
    const ParameterFile text(file, overrides);
    const auto          libraries = load_plugins(text, file, reference_keys);

    Parameters parameters;
    parameters.file = file;
    parameters.bodies.resize(text.count("Body"));
    parameters.boundary_conditions.resize(text.count("Boundary condition"));
    parameters.contact_pairs.resize(text.count("Contact pair"));
    parameters.output_points.resize(text.count("Output point"));
    parameters.output_lines.resize(text.count("Output line"));

    ParameterHandler prm; // holds references to the members of parameters
    parameters.add_parameters(prm);
    text.apply_to(prm);
    text.refuse_idle_plugins();
    parameters.additional_shared_libraries = libraries;

    const std::filesystem::path path(file);
    for (auto &body : parameters.bodies)
      if (!body.mesh_file.empty())
        body.mesh_file = (path.parent_path() / body.mesh_file).lexically_normal().string();
    for (auto &pair : parameters.contact_pairs)
      if (std::string &name = pair.master_surface.file; !name.empty())
        name = (path.parent_path() / name).lexically_normal().string();
    for (unsigned int n = 0; n < parameters.boundary_conditions.size(); ++n)
      if (auto &condition = parameters.boundary_conditions[n]; !condition.table_file.empty())
      {
        const std::string section = "Boundary condition " + std::to_string(n + 1);
        if (!condition.table_times.empty() || !condition.table_values.empty())
          text.refuse(section, "Table file", "is given besides Table times or values; remove one of them");
        condition.table_file = (path.parent_path() / condition.table_file).lexically_normal().string();
        if (const std::string mistake = read_table(condition); !mistake.empty())
          text.refuse(section, "Table file", mistake);
      }
    for (auto &condition : parameters.boundary_conditions)
      if (condition.value.size() == 1 && condition.components.size() > 1)
        condition.value.resize(condition.components.size(), std::string(condition.value[0]));

    for (unsigned int p = 0; p < parameters.contact_pairs.size(); ++p)
      if (parameters.contact_pairs[p].name.empty())
        parameters.contact_pairs[p].name = "pair " + std::to_string(p + 1);
    for (unsigned int i = 0; i < parameters.output_points.size(); ++i)
      if (parameters.output_points[i].name.empty())
        parameters.output_points[i].name = "point " + std::to_string(i + 1);
    for (unsigned int i = 0; i < parameters.output_lines.size(); ++i)
      if (parameters.output_lines[i].name.empty())
        parameters.output_lines[i].name = "line " + std::to_string(i + 1);
    if (parameters.output.results_folder.empty())
      parameters.output.results_folder = (std::filesystem::path("results") / path.stem()).string();

    for (auto &pair : parameters.contact_pairs)
      if (pair.self_contact)
        complete_general_contact(pair.slave, parameters.bodies);
    resolve_names(parameters, text);
    for (unsigned int p = 0; p < parameters.contact_pairs.size(); ++p)
      resolve_excluded_bodies(
          parameters.contact_pairs[p], parameters.bodies, text, "Contact pair " + std::to_string(p + 1));
    for (auto &pair : parameters.contact_pairs)
      if (pair.self_contact && !pair.has_rigid_master() && pair.master.bodies.empty() && !pair.master.has_ids() &&
          pair.master.where.empty())
        make_both_sides(pair, parameters.bodies);
    parameters.check(text);
    parameters.initialize_plugins(text);
    for (unsigned int b = 0; b < parameters.bodies.size(); ++b)
      if (const BodyParameters &body = parameters.bodies[b]; !body.generator.empty())
      {
        const std::string section = "Body " + std::to_string(b + 1);
        if (const std::string mistake = Generators::mistake_in_name(body.generator); !mistake.empty())
          text.refuse(section, "Generator", mistake);
        if (const std::string mistake = Generators::mistake_in_arguments(body.generator, body.generator_arguments);
            !mistake.empty())
          text.refuse(section, "Generator arguments", mistake);
      }
    return parameters;
  }
} // namespace Nodus
