#ifndef nodus_parameters_output_fields_h
#define nodus_parameters_output_fields_h

#include <nodus/parameters/solution_parameters.h>

#include <algorithm>
#include <string>
#include <vector>

namespace Nodus
{
  /// An array of the VTU files that Output/Fields may name.
  struct OutputField
  {
    const char *name;
    bool        by_default;
  };

  /// Those of the bodies, then those of the contact surfaces.
  inline const std::vector<OutputField> &output_fields()
  {
    static const std::vector<OutputField> fields = {{"cauchy_stress", true},
                                                    {"von_mises", true},
                                                    {"PEEQ", true},
                                                    {"green_lagrange_strain", false},
                                                    {"logarithmic_strain", false},
                                                    {"principal_stress_1", false},
                                                    {"principal_stress_2", false},
                                                    {"principal_stress_3", false},
                                                    {"principal_direction_1", false},
                                                    {"principal_direction_2", false},
                                                    {"principal_direction_3", false},
                                                    {"CPRESS", true},
                                                    {"COPEN", true},
                                                    {"CSHEAR1", true},
                                                    {"CSHEAR2", true},
                                                    {"CSLIP1", true},
                                                    {"CSLIP2", true},
                                                    {"CSTATUS", true},
                                                    {"paired", true},
                                                    {"normal", true},
                                                    {"tangent1", true},
                                                    {"friction_traction", true},
                                                    {"contact_traction", true},
                                                    {"area", true},
                                                    {"status_changes", true},
                                                    {"cycle_period", true},
                                                    {"contradiction", true}};
    return fields;
  }

  /// Whether @p fields, a value of Output/Fields, has @p name, by itself or by what "default" and "all" stand for.
  inline bool is_chosen(const std::vector<std::string> &fields, const std::string &name)
  {
    const auto has = [&](const std::string &text)
    { return std::find(fields.begin(), fields.end(), text) != fields.end(); };
    const auto field = std::find_if(
        output_fields().begin(), output_fields().end(), [&](const OutputField &one) { return one.name == name; });
    return has(name) || has("all") || (field != output_fields().end() && field->by_default && has("default"));
  }
} // namespace Nodus

#endif
