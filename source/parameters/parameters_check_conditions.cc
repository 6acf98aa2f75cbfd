#include "base/text.h"
#include "parameters/expression.h"
#include "parameters/parameter_checks.h"

#include <algorithm>
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
  } // namespace

  void ParameterChecks::check(const Section                     &section,
                              const BoundaryConditionParameters &condition,
                              const unsigned int                 n_bodies,
                              const std::vector<double>         &interval_ends)
  {
    using Type = BoundaryConditionParameters::Type;
    check(section, condition.region, "", n_bodies, 0);
    const bool on_boundary = condition.type != Type::body_force;
    section.require(on_boundary ? condition.region.chooses_faces() : !condition.region.has_ids(),
                    "Boundary ids",
                    on_boundary
                        ? "is missing; give the ids or names of the faces the condition acts on, or 'Where' they are"
                        : "has no meaning for a body force; remove it");
    section.require(on_boundary || !has_normal(condition.region.where),
                    "Where",
                    "asks for a normal, which the cells that a body force acts on do not have; use x, y, z");

    const bool directed = condition.type != Type::pressure;
    section.require(condition.components.empty() != directed,
                    "Components",
                    directed ? "is missing; give some of x, y, z"
                             : "has no meaning for a pressure, which acts along the normal; remove it");
    const std::set<unsigned int> distinct(condition.components.begin(), condition.components.end());
    section.require(distinct.size() == condition.components.size(),
                    "Components",
                    "names a direction twice; give each of x, y, z at most once");

    check(section, condition.motion, "", Vector3());
    if (condition.type == Type::rigid_motion)
    {
      section.require(condition.value.empty() && condition.table_times.empty(),
                      condition.value.empty() ? "Table times" : "Value",
                      "has no effect on a rigid motion; remove it, and give Translation or Rotation");
      return check(section, condition, "condition", interval_ends);
    }
    section.require(!is_given(condition.motion),
                    "Translation",
                    "or Rotation has no effect on a " + text_of(condition.type) +
                        "; remove them, or set 'Type = rigid motion'");
    check_table(section, condition);
    const std::size_t wanted = directed ? condition.components.size() : 1;
    section.require(condition.value.size() == wanted,
                    "Value",
                    condition.value.empty()
                        ? "is missing; give an expression of x, y, z, t such as 0 or -0.1*t"
                        : "has " + std::to_string(condition.value.size()) + " expressions for " +
                              std::to_string(wanted) + (directed ? " components" : " pressure") +
                              "; separate expressions by ';', one for each component or one for all");
    for (const auto &expression : condition.value)
    {
      section.require(!expression.empty(), "Value", "has an empty expression; write 0 for zero");
      check_expression(section, "Value", expression, condition.table_times.empty() ? "x,y,z,t" : "x,y,z,t,table");
    }

    check(section, condition, "condition", interval_ends);
  }
} // namespace Nodus
