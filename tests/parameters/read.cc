// Every key of the parameter file reaches its member, "--set" wins over the file, every_key.prm forgets no key, JSON
// says the same, and every key has a unit.

#include "parameters/parameter_file.h"
#include <nodus/base/remedy.h>
#include <nodus/parameters/parameters.h>

#include <fstream>
#include <iostream>
#include <regex>
#include <set>
#include <sstream>

using namespace Nodus;

namespace
{
  template <typename Value>
  void print(const std::string &name, const Value &value)
  {
    std::cout << name << ": " << value << '\n';
  }

  template <typename Value>
  void print(const std::string &name, const std::vector<Value> &values)
  {
    std::cout << name << ':';
    for (const auto &value : values)
      std::cout << " [" << value << ']';
    std::cout << '\n';
  }

  template <typename Enum>
  void print_choice(const std::string &name, const Enum value)
  {
    std::cout << name << ": choice " << static_cast<int>(value) << '\n';
  }

  void print(const std::string &name, const RegionParameters &region)
  {
    print(name + " body", region.first_body());
    print(name + " boundary ids", region.boundary_ids);
    print(name + " where", region.where);
  }

  void print(const std::string &name, const PrescribedMotionParameters &motion)
  {
    print(name + " translation", motion.translation);
    print(name + " rotation", motion.rotation);
    print(name + " rotation axis", motion.rotation_axis);
    print(name + " rotation centre", motion.rotation_centre);
  }

  void print(const BodyParameters &body)
  {
    print("\nbody", body.name);
    print("mesh file is in the folder of the .prm file",
          body.mesh_file.empty() || body.mesh_file == SOURCE_DIR "/one_cell.msh");
    print("volume ids", body.volume_ids);
    print("generator", body.generator);
    print("generator arguments", body.generator_arguments);
    print("scale", body.scale);
    print("rotation axis", body.rotation_axis);
    print("rotation angle", body.rotation_angle);
    print("translation", body.translation);
    print("global refinement", body.global_refinement);
    print("local refinement", body.local_refinement);
    print("refine where", body.refine_where);
    print_choice("volumetric treatment", body.volumetric_treatment);
    print("rigid", body.rigid);
    print("rigid", body.motion);
    print("rigid free", body.rigid_free);
    print("rigid force", body.rigid_force);
    print("rigid moment", body.rigid_moment);
    print_choice("law", body.material.law);
    print("Young's modulus", body.material.youngs_modulus);
    print("Poisson's ratio", body.material.poissons_ratio);
    print("Mooney-Rivlin ratio", body.material.mooney_rivlin_ratio);
    print("Ogden moduli", body.material.ogden_moduli);
    print("Ogden exponents", body.material.ogden_exponents);
    print("yield stress", body.material.yield_stress);
    print("hardening modulus", body.material.hardening_modulus);
    print("saturation stress", body.material.saturation_stress);
    print("saturation rate", body.material.saturation_rate);
    print("hardening strains", body.material.hardening_strains);
    print("hardening stresses", body.material.hardening_stresses);
  }

  void print(const BoundaryConditionParameters &condition)
  {
    print("\nboundary condition", condition.name);
    print_choice("type", condition.type);
    print("region", condition.region);
    print("point", condition.point);
    print("components", condition.components);
    print("direction", condition.direction);
    print("value", condition.value);
    print("table times", condition.table_times);
    print("table values", condition.table_values);
    print("table file is none, or in the folder of the .prm file",
          condition.table_file.empty() || condition.table_file == SOURCE_DIR "/load.csv");
    print("table file", !condition.table_file.empty());
    print("motion", condition.motion);
    print("free", condition.free);
    print("force", condition.force);
    print("moment", condition.moment);
    print("active from", condition.active_from);
    print("active until", condition.active_until);
  }

  void print(const ContactPairParameters &pair)
  {
    print("\ncontact pair", pair.name);
    print("slave", pair.slave);
    print("master", pair.master);
    print_choice("master surface", pair.master_surface.shape);
    print("master point", pair.master_surface.point);
    print("master axis", pair.master_surface.axis);
    print("master radius", pair.master_surface.radius);
    print("master cavity", pair.master_surface.cavity);
    print("master file is none, or in the folder of the .prm file",
          pair.master_surface.file.empty() || pair.master_surface.file == SOURCE_DIR "/press.stl");
    print("master file", !pair.master_surface.file.empty());
    print("master scale", pair.master_surface.scale);
    print("master", pair.master_surface.motion);
    print_choice("contact law", pair.contact_law);
    print_choice("friction law", pair.friction_law);
    print("friction coefficient", pair.friction_coefficient);
    print("second friction coefficient", pair.second_friction_coefficient);
    print("friction direction", pair.friction_direction);
    print("friction factor", pair.friction_factor);
    print("shear limit", pair.shear_limit);
    print("elastic slip", pair.elastic_slip);
    print_choice("pressure-gap law", pair.pressure_gap.law);
    print("contact stiffness", pair.pressure_gap.stiffness);
    print("stiffening length", pair.pressure_gap.stiffening_length);
    print("gap law overclosures", pair.pressure_gap.overclosures);
    print("gap law pressures", pair.pressure_gap.pressures);
    print("normal augmentation factor", pair.normal_augmentation_factor);
    print("tangential augmentation factor", pair.tangential_augmentation_factor);
    print_choice("surface measure", pair.surface_measure);
    print_choice("weights", pair.weights);
    print_choice("scheme", pair.scheme);
    print_choice("integration", pair.integration);
    print_choice("quadrature rule", pair.quadrature_rule);
    print("quadrature points", pair.quadrature_points);
    print_choice("surface", pair.surface);
    print_choice("normal", pair.normal);
    print("search distance", pair.search_distance);
    print("projection tolerance", pair.projection_tolerance);
    print_choice("initial status", pair.start.status);
    print_choice("initial overclosure", pair.start.overclosure);
    print("adjustment distance", pair.start.adjustment_distance);
    print("overclosure limit", pair.start.overclosure_limit);
    print_choice("status test", pair.status_test);
    print("preload", pair.preload.force);
    print("preload until", pair.preload.until);
    print("preload axis", pair.preload.axis);
    print("active from", pair.active_from);
    print("active until", pair.active_until);
  }

  void print(const std::string &name, const LoopParameters &loop)
  {
    print('\n' + name + ", maximum passes", loop.maximum_passes);
    print(name + ", tolerance", loop.tolerance);
    print_choice(name + ", mode", loop.mode);
  }

  /// The reference of the parameters without the table of generators behind it.
  std::string tables_of_keys()
  {
    const std::string reference = Parameters::documentation();
    return reference.substr(0, reference.find("\n## Generators"));
  }

  /// Keys that the reference lists and every_key.prm does not set.
  unsigned int count_forgotten(const std::string &file)
  {
    std::stringstream prm;
    prm << std::ifstream(file).rdbuf();
    std::istringstream reference(tables_of_keys());
    unsigned int       forgotten = 0;
    for (std::string row; std::getline(reference, row);)
      if (row.compare(0, 2, "| ") == 0 && row.compare(0, 5, "| Key") != 0)
      {
        const std::string key = row.substr(2, row.find(" |") - 2);
        if (prm.str().find("set " + key) == std::string::npos)
        {
          ++forgotten;
          std::cout << "forgotten: " << key << '\n';
        }
      }
    return forgotten;
  }
} // namespace

namespace
{
  void print(const Parameters &parameters)
  {
    print("title", parameters.title);
    print("additional shared libraries", parameters.additional_shared_libraries);
    print("degree", parameters.degree);
    for (const auto &body : parameters.bodies)
      print(body);
    for (const auto &condition : parameters.boundary_conditions)
      print(condition);
    for (const auto &pair : parameters.contact_pairs)
      print(pair);
    print("geometry loop", parameters.geometry_loop);
    print("threshold loop", parameters.threshold_loop);
    print("status loop", parameters.status_loop);
    print("\nmaximum iterations", parameters.newton.maximum_iterations);
    print("force tolerance", parameters.newton.force_tolerance);
    print("contact tolerance", parameters.newton.contact_tolerance);
    print("line search", parameters.newton.line_search);
    print("largest forcing term", parameters.newton.largest_forcing_term);
    print_choice("\nlinear solver", parameters.linear_solver.type);
    print("tolerance", parameters.linear_solver.tolerance);
    print("maximum iterations", parameters.linear_solver.maximum_iterations);
    print("augmentation factor", parameters.linear_solver.augmentation_factor);
    print_choice("preconditioner", parameters.linear_solver.preconditioner);
    print("\nwithout", parameters.strategy.without);
    print("uses mixed geometry", parameters.strategy.uses(Remedy::mixed_geometry));
    print("uses three loops", parameters.strategy.uses(Remedy::three_loops));
    print("interval ends", parameters.load_stepping.interval_ends);
    print("increments", parameters.load_stepping.increments);
    print("cut back", parameters.load_stepping.cut_back);
    print("minimum increment", parameters.load_stepping.minimum_increment);
    print("maximum increment", parameters.load_stepping.maximum_increment);
    print("easy iterations", parameters.load_stepping.easy_iterations);
    print("viscous stabilisation", parameters.load_stepping.viscous_stabilisation);
    print("intervals with a control of their own", parameters.load_stepping.control.size());
    print("arc length", parameters.load_stepping.arc_length);
    print("maximum increments", parameters.load_stepping.maximum_increments);
    const auto &adaptivity = parameters.adaptivity;
    print("interval", adaptivity.interval);
    print("initial cycles", adaptivity.initial_cycles);
    print("contact distance", adaptivity.contact_distance);
    print("repetitions", adaptivity.repetitions);
    print_choice("indicator", adaptivity.indicator);
    print("bulk weight", adaptivity.bulk_weight);
    print("contact weight", adaptivity.contact_weight);
    print("marking", static_cast<int>(adaptivity.marking));
    print("refine fraction", adaptivity.refine_fraction);
    print("coarsen fraction", adaptivity.coarsen_fraction);
    print("target error", adaptivity.target_error);
    print("maximum level", adaptivity.maximum_level);
    print("maximum unknowns", adaptivity.maximum_unknowns);
    print("slave at least as fine", adaptivity.slave_at_least_as_fine);
    print("\nresults folder", parameters.output.results_folder);
    print("Write VTU", parameters.output.write_vtu);
    print("VTU interval", parameters.output.vtu_interval);
    print("fields", parameters.output.fields);
    print_choice("configuration", parameters.output.configuration);
    print_choice("nodal values", parameters.output.nodal_values);
    print("checkpoint interval", parameters.output.checkpoint_interval);
    for (const OutputPointParameters &point : parameters.output_points)
    {
      print("\noutput point", point.name);
      print("body", point.body);
      print("position", point.position);
    }
    for (const OutputLineParameters &line : parameters.output_lines)
    {
      print("\noutput line", line.name);
      print("body", line.body);
      print("from", line.from);
      print("to", line.to);
      print("points", line.points);
    }
  }

  std::string everything(const std::string &file)
  {
    std::ostringstream    text;
    std::streambuf *const screen = std::cout.rdbuf(text.rdbuf());
    print(Parameters::read(file, {"Newton/Force tolerance=0.00025", "Body 2/Material/Young's modulus = 3"}));
    std::cout.rdbuf(screen);
    return text.str();
  }

  /// Keys whose description does not name a unit in square brackets.
  unsigned int count_without_unit()
  {
    const std::regex   unit("-|degrees|face sizes|time|as Type says|length where they are coordinates|"
                            "(length|pressure|force|area|volume|mass|stress)([/ ](length|pressure|area|volume|time))?");
    std::istringstream reference(tables_of_keys());
    unsigned int       without = 0;
    std::smatch        found;
    for (std::string row; std::getline(reference, row);)
      if (row.compare(0, 2, "| ") == 0 && row.compare(0, 5, "| Key") != 0)
      {
        const std::string meaning = row.substr(row.rfind('|', row.size() - 2) + 1);
        if (!std::regex_search(meaning, found, std::regex("\\[([^\\]]*)\\]")) ||
            !std::regex_match(found[1].str(), unit))
        {
          ++without;
          std::cout << "without unit: " << row << '\n';
        }
      }
    return without;
  }
} // namespace

int main()
{
  const std::string file = SOURCE_DIR "/every_key.prm";
  const std::string text = everything(file);
  std::cout << text;
  print("\nkeys that every_key.prm forgets", count_forgotten(file));
  const auto without_blanks = [](const std::string &t) { return std::regex_replace(t, std::regex(" "), ""); };
  print("every_key.json says the same",
        without_blanks(text) == without_blanks(everything(SOURCE_DIR "/every_key.json")));
  print("keys without a unit", count_without_unit());
  const LoadSteppingParameters controlled =
      Parameters::read(SOURCE_DIR "/two_blocks.prm", {"Load stepping/Control=time, arc length"}).load_stepping;
  print("second interval alone under arc length", controlled.has_arc_length(1) && !controlled.has_arc_length(0));
}
