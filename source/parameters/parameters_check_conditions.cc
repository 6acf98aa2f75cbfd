#include "base/text.h"
#include "parameters/expression.h"
#include "parameters/parameter_checks.h"

#include <algorithm>
#include <array>
#include <set>

// Boundary conditions: what is prescribed where, by expression, table or rigid motion.

namespace Nodus
{
  namespace
  {
    using ParameterChecks::Section;

    void check_table(const Section &section, const BoundaryConditionParameters &condition)
    {
      const std::vector<double> &times = condition.table_times;
      const std::string          key   = condition.table_file.empty() ? "Table times" : "Table file";
      section.require(condition.table_values.size() == times.size(),
                      "Table values",
                      "has " + std::to_string(condition.table_values.size()) + " entries for " +
                          std::to_string(times.size()) + " of Table times; give one for each");
      section.require(times.size() != 1, key, "has one time; give two or more, or write the value into Value");
      for (unsigned int i = 1; i < times.size(); ++i)
        section.require(times[i] > times[i - 1],
                        key,
                        text("goes from ", times[i - 1], " to ", times[i], "; the times must increase"));
      section.require(times.empty() ||
                          std::any_of(condition.value.begin(),
                                      condition.value.end(),
                                      [](const std::string &value) { return value.find("table") != value.npos; }),
                      key,
                      "has no effect, because Value does not ask for it; write for example 'Value = table'");
    }

    /// What has a point has no faces.
    void check_point(const Section &section, const BoundaryConditionParameters &condition)
    {
      const std::string type = text_of(condition.type);
      if (!condition.at_point())
        return section.require(condition.point.empty(),
                               "Point",
                               "has no effect on a " + type +
                                   "; remove it, or set 'Type = point load' or 'Type = point spring'");
      section.require(condition.point.size() == dim,
                      "Point",
                      condition.point.empty()
                          ? "is missing; give the reference position x, y, z where the " + type + " acts"
                          : "has " + std::to_string(condition.point.size()) + " numbers; give three, separated by ','");
      section.require(!condition.region.has_ids(),
                      "Boundary ids",
                      "has no meaning for a " + type + ", which acts at 'Point'; remove it");
      section.require(condition.region.where.empty(),
                      "Where",
                      "has no meaning for a " + type + ", which acts at 'Point'; remove it");
      const BoundaryConditionParameters none;
      section.require(
          condition.force == none.force && condition.moment == none.moment,
          condition.force == none.force ? "Moment" : "Force",
          "has no effect on a " + type + "; " +
              (condition.force == none.force
                   ? "give a moment as two point loads that are opposite to each other, or as the Moment of a "
                     "rigid motion with 'Free' components"
                   : "give its Components and, as Value, an expression for each of them"));
    }

    /// Axes or one direction of its own.
    void check_directions(const Section &section, const BoundaryConditionParameters &condition)
    {
      const bool                 has_direction = !condition.direction.empty();
      const std::vector<double> &d             = condition.direction;
      section.require(!has_direction || !condition.holds(),
                      "Direction",
                      "has no meaning for a " + text_of(condition.type) +
                          ", which holds x, y or z; name these in Components, and hold other directions by a contact "
                          "pair with a plane that is bilateral (steps.md, Supports along other axes)");
      const bool directed = condition.type != BoundaryConditionParameters::Type::pressure;
      section.require(directed || !has_direction,
                      "Direction",
                      "has no meaning for a pressure, which acts along the normal; remove it");
      section.require(!has_direction || condition.components.empty(),
                      "Direction",
                      "is given besides Components; remove one of the two");
      section.require(!has_direction ||
                          (d.size() == dim && std::any_of(d.begin(), d.end(), [](const double x) { return x != 0.; })),
                      "Direction",
                      "must be three numbers, separated by ',', that are not all zero; for example 0, 0.6, 0.8");
      section.require(condition.components.empty() != (directed && !has_direction),
                      "Components",
                      directed ? "is missing; give some of x, y, z"
                               : "has no meaning for a pressure, which acts along the normal; remove it");
      const std::set<unsigned int> distinct(condition.components.begin(), condition.components.end());
      section.require(distinct.size() == condition.components.size(),
                      "Components",
                      "names a direction twice; give each of x, y, z at most once");
    }

    /// A face of one deformable body that acts as long as the run; what is free moves its nodes.
    void check_coupling(const Section &section, const BoundaryConditionParameters &condition)
    {
      ParameterChecks::check_free_motion(
          section, "", condition.motion, condition.free, condition.force, condition.moment);
      if (condition.free.empty())
        return;
      section.require(condition.region.bodies.size() == 1,
                      "Body",
                      "must be one body, for 'Free' couples the nodes of one face; give its number");
      section.require(condition.active_from == 0. && condition.active_until == 0.,
                      condition.active_from > 0. ? "Active from" : "Active until",
                      "has no meaning for a rigid motion with 'Free' components, which acts all the time; remove it, "
                      "and let Force and Moment depend on t");
      const auto moves = [&](const unsigned int c)
      { return std::find(condition.components.begin(), condition.components.end(), c) != condition.components.end(); };
      for (const unsigned int c : condition.free)
      {
        const unsigned int i = c % dim;
        section.require(c < dim ? moves(i) : moves((i + 1) % dim) || moves((i + 2) % dim),
                        "Free",
                        std::string("names ") + (c < dim ? "" : "r") + "xyz"[i] +
                            ", which moves no node in the directions of 'Components'; add them there");
      }
    }
  } // namespace

  void ParameterChecks::check_free_motion(const Section                    &section,
                                          const std::string                &prefix,
                                          const PrescribedMotionParameters &motion,
                                          const std::vector<unsigned int>  &free_components,
                                          const std::vector<std::string>   &force,
                                          const std::vector<std::string>   &moment)
  {
    const auto                key = [&](const std::string &name) { return prefixed(prefix, name); };
    std::array<bool, 2 * dim> free{};
    for (const unsigned int c : free_components)
    {
      section.require(!free[c], key("Free"), "names a component twice; give each one once");
      free[c] = true;
    }
    const auto check_load = [&](const std::string &name, const std::vector<std::string> &load, const unsigned int first)
    {
      section.require(load.size() == dim,
                      name,
                      "has " + std::to_string(load.size()) +
                          " expressions; give three, separated by ';', for example 0; 0; -10*t");
      for (unsigned int c = 0; c < dim; ++c)
      {
        check_expression(section, name, load[c], "t");
        section.require(load[c] == "0" || free[first + c],
                        name,
                        "has '" + load[c] + "' along " + "xyz"[c] +
                            ", where the motion is prescribed and the force has no effect; set it to 0, or add " +
                            (first > 0 ? "r" : "") + "xyz"[c] + " to '" + key("Free") + "'");
      }
    };
    check_load(key("Force"), force, 0);
    check_load(key("Moment"), moment, dim);
    for (unsigned int c = 0; c < dim; ++c)
    {
      section.require(!free[c] || motion.translation[c] == "0",
                      key("Translation"),
                      "prescribes '" + motion.translation[c] + "' along " + "xyz"[c] + ", which is among '" +
                          key("Free") + "'; set it to 0, or take it out there");
      section.require(!free[dim + c] || motion.rotation == "0" || motion.rotation_axis[c] == 0.,
                      key("Rotation"),
                      std::string("turns the body about r") + "xyz"[c] + ", which is among '" + key("Free") +
                          "'; remove it, or take that out there");
    }
  }

  void ParameterChecks::check(const Section                     &section,
                              const BoundaryConditionParameters &condition,
                              const unsigned int                 n_bodies,
                              const std::vector<double>         &interval_ends)
  {
    using Type = BoundaryConditionParameters::Type;
    check(section, condition.region, "", n_bodies, 0);
    check_point(section, condition);
    const bool on_boundary = condition.type != Type::body_force && !condition.at_point();
    section.require(on_boundary ? condition.region.chooses_faces() : !condition.region.has_ids(),
                    "Boundary ids",
                    on_boundary
                        ? "is missing; give the ids or names of the faces the condition acts on, or 'Where' they are"
                        : "has no meaning for a body force; remove it");
    section.require(on_boundary || !has_normal(condition.region.where),
                    "Where",
                    "asks for a normal, which the cells that a body force acts on do not have; use x, y, z");

    check_directions(section, condition);
    check(section, condition.motion, "", Vector3());
    if (condition.type == Type::rigid_motion)
    {
      section.require(condition.value.empty() && condition.table_times.empty(),
                      condition.value.empty() ? "Table times" : "Value",
                      "has no effect on a rigid motion; remove it, and give Translation or Rotation");
      check_coupling(section, condition);
      return check(section, condition, "condition", interval_ends);
    }
    const BoundaryConditionParameters none;
    section.require(condition.free.empty() && condition.force == none.force && condition.moment == none.moment,
                    "Free",
                    "or Force or Moment has no effect on a " + text_of(condition.type) +
                        "; remove them, or set 'Type = rigid motion'");
    section.require(!is_given(condition.motion),
                    "Translation",
                    "or Rotation has no effect on a " + text_of(condition.type) +
                        "; remove them, or set 'Type = rigid motion'");
    check_table(section, condition);
    const std::size_t wanted = condition.n_values();
    section.require(condition.value.size() == wanted,
                    "Value",
                    condition.value.empty()
                        ? "is missing; give an expression of x, y, z, t such as 0 or -0.1*t"
                        : "has " + std::to_string(condition.value.size()) + " expressions for " +
                              std::to_string(wanted) +
                              (wanted == condition.components.size() ? " components" : " direction") +
                              "; separate expressions by ';', one for each component or one for all");
    for (const auto &expression : condition.value)
    {
      section.require(!expression.empty(), "Value", "has an empty expression; write 0 for zero");
      check_expression(section, "Value", expression, condition.table_times.empty() ? "x,y,z,t" : "x,y,z,t,table");
    }

    check(section, condition, "condition", interval_ends);
  }
} // namespace Nodus
