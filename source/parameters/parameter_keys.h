#ifndef nodus_parameters_parameter_keys_h
#define nodus_parameters_parameter_keys_h

#include <nodus/parameters/parameters.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <limits>

// What the files that declare the keys of a .prm file share.

namespace Nodus
{
  namespace ParameterKeys
  {
    namespace Patterns = dealii::Patterns;
    using dealii::ParameterHandler;

    /// The texts of an enum in the .prm file. This is the only place where they are written.
    template <typename Enum>
    using Names = std::vector<std::pair<Enum, std::string>>;

    template <typename Enum>
    std::string selection(const Names<Enum> &names)
    {
      std::string texts;
      for (const auto &[value, text] : names)
        texts += (texts.empty() ? "" : "|") + text;
      return texts;
    }

    template <typename Enum>
    Enum value_of(const std::string &wanted, const Names<Enum> &names)
    {
      for (const auto &[value, text] : names)
        if (text == wanted)
          return value;
      throw InputError("'" + wanted + "' is none of " + selection(names)); // kept out by the pattern
    }

    template <typename Enum>
    std::string text_of(const Enum value, const Names<Enum> &names)
    {
      for (const auto &[candidate, text] : names)
        if (candidate == value)
          return text;
      return "";
    }

    template <typename Enum>
    void add_choice(ParameterHandler  &prm,
                    const std::string &key,
                    Enum              &value,
                    const Names<Enum> &names,
                    const std::string &documentation)
    {
      prm.declare_entry(key, text_of(value, names), Patterns::Selection(selection(names)), documentation);
      prm.add_action(key, [&value, &names](const std::string &text) { value = value_of(text, names); });
    }

    inline const Patterns::Double  any_number, not_negative(0.), positive(std::numeric_limits<double>::min());
    inline const Patterns::Integer count(0), at_least_one(1);
    inline const Patterns::List    numbers(Patterns::Double(), 0, std::numeric_limits<unsigned int>::max(), ",");

    /// Keys "Body", "Boundary ids", "Where" behind @p prefix, which is "Slave ", "Master " or empty.
    void add_region(ParameterHandler  &prm,
                    const std::string &prefix,
                    RegionParameters  &region,
                    const std::string &every_body,
                    const std::string &where);

    inline Patterns::List anything_separated_by(const std::string &separator)
    {
      return Patterns::List(Patterns::Anything(), 0, std::numeric_limits<unsigned int>::max(), separator);
    }

    /// Expressions separated by ';' because commas belong to the expressions: if(t<1, t, 1).
    void add_expressions(ParameterHandler         &prm,
                         const std::string        &key,
                         std::vector<std::string> &expressions,
                         const std::string        &documentation);

    /// Keys "Active from" and "Active until". @p what acts, and what is so @p after the latter.
    void add_active_time(ParameterHandler &prm, ActiveTime &time, const std::string &what, const std::string &after);

    /// Keys "Translation", "Rotation", "Rotation axis", "Rotation centre" behind @p prefix. @p axis, @p centre: what
    /// counts where none are given.
    void add_motion(ParameterHandler           &prm,
                    const std::string          &prefix,
                    PrescribedMotionParameters &motion,
                    const std::string          &axis,
                    const std::string          &centre);
    /// Keys "Free", "Force", "Moment" behind @p prefix: what of the motion of @p what is free, and what drives it. @p
    /// nodes: a sentence on those.
    void add_drive(ParameterHandler          &prm,
                   const std::string         &prefix,
                   const std::string         &what,
                   const std::string         &nodes,
                   std::vector<unsigned int> &free,
                   std::vector<std::string>  &force,
                   std::vector<std::string>  &moment);

    /// Components by name, axes x, y, z as 0, 1, 2, those of a rigid motion as 0 to 5.
    void add_components(ParameterHandler          &prm,
                        const std::string         &key,
                        std::vector<unsigned int> &components,
                        const std::string         &documentation,
                        bool                       rigid = false);

    void add_material(ParameterHandler &prm, MaterialParameters &material);
    void add_contact_pair(ParameterHandler &prm, ContactPairParameters &pair);
    /// What its surfaces do once closed, how they give way, and how they rub.
    void add_contact_laws(ParameterHandler &prm, ContactPairParameters &pair);
    void add_output(ParameterHandler &prm, OutputParameters &output);
    void add_output_point(ParameterHandler &prm, OutputPointParameters &point);
    void add_output_line(ParameterHandler &prm, OutputLineParameters &line);
    /// The subsections on how the case is solved, from "Geometry loop" to "Adaptivity".
    void add_solution(ParameterHandler &prm, Parameters &parameters);
  } // namespace ParameterKeys
} // namespace Nodus

#endif
