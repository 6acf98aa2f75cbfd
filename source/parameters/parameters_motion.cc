#include "parameters/parameter_file.h"
#include "parameters/parameter_keys.h"

#include <deal.II/base/utilities.h>

// Directions, and the keys of motions that are prescribed or driven.

namespace Nodus
{
  namespace
  {
    using namespace ParameterKeys;

    const Names<unsigned int> component_names       = {{0, "x"}, {1, "y"}, {2, "z"}};
    const Names<unsigned int> rigid_component_names = {{0, "x"}, {1, "y"}, {2, "z"}, {3, "rx"}, {4, "ry"}, {5, "rz"}};
  } // namespace

  namespace ParameterKeys
  {
    void add_components(ParameterHandler          &prm,
                        const std::string         &key,
                        std::vector<unsigned int> &components,
                        const std::string         &documentation,
                        const bool                 rigid)
    {
      const Names<unsigned int> &names = rigid ? rigid_component_names : component_names;
      std::string                default_text;
      for (const unsigned int c : components)
        default_text += (default_text.empty() ? "" : ", ") + names[c].second;
      prm.declare_entry(
          key, default_text, Patterns::List(Patterns::Selection(selection(names)), 0, names.size()), documentation);
      prm.add_action(key,
                     [&components, &names](const std::string &text)
                     {
                       components.clear();
                       for (const auto &name : dealii::Utilities::split_string_list(text, ','))
                         components.push_back(value_of(name, names));
                     });
    }

    void add_motion(ParameterHandler           &prm,
                    const std::string          &prefix,
                    PrescribedMotionParameters &motion,
                    const std::string          &axis,
                    const std::string          &centre)
    {
      add_expressions(prm,
                      prefixed(prefix, "Translation"),
                      motion.translation,
                      "Shift at time t [length]: three expressions of t, separated by ';'.");
      prm.add_parameter(prefixed(prefix, "Rotation"),
                        motion.rotation,
                        "Angle turned by at time t, before the translation [degrees]: expression of t, e.g. 90*t.",
                        Patterns::Anything());
      prm.add_parameter(prefixed(prefix, "Rotation axis"),
                        motion.rotation_axis,
                        "Axis of the rotation, right-handed [-]; three numbers" + axis + ".");
      prm.add_parameter(prefixed(prefix, "Rotation centre"),
                        motion.rotation_centre,
                        "Point that the rotation leaves where it is [length]; three numbers, empty: " + centre + ".",
                        numbers);
    }

    void add_drive(ParameterHandler          &prm,
                   const std::string         &prefix,
                   const std::string         &what,
                   const std::string         &nodes,
                   std::vector<unsigned int> &free,
                   std::vector<std::string>  &force,
                   std::vector<std::string>  &moment)
    {
      const auto key = [&](const std::string &name) { return prefixed(prefix, name); };
      add_components(prm,
                     key("Free"),
                     free,
                     "Components of the motion of " + what + " that equilibrium finds, driven by " + key("Force") +
                         " and " + key("Moment") +
                         " [-]: translation x, y, z of the rotation centre, rotation rx, ry, rz about global axes "
                         "through it; the others follow " +
                         key("Translation") + " and " + key("Rotation") + "." + nodes,
                     true);
      add_expressions(prm,
                      key("Force"),
                      force,
                      "Force on " + what +
                          " at time t, in global axes [force]: three expressions of t, separated by ';'.");
      add_expressions(prm,
                      key("Moment"),
                      moment,
                      "Moment on " + what +
                          " at time t about its rotation centre as it moves, in global axes [force length]: three "
                          "expressions of t, separated by ';'.");
    }
  } // namespace ParameterKeys
} // namespace Nodus
