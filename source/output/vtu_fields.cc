#include "output/vtu_fields.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    template <unsigned int i>
    void principal_stress(const BodyNode &node, VtuGrid::Array &out)
    {
      out << node.principal()[i].value;
    }

    template <unsigned int i>
    void principal_direction(const BodyNode &node, VtuGrid::Array &out)
    {
      out << node.principal()[i].direction;
    }

    const std::vector<VtuField<BodyNode>> body_fields = {
        {"cauchy_stress",
         dim *dim,
         [](const BodyNode &node, VtuGrid::Array &out) { out << node.values.cauchy_stress; }},
        {"von_mises",
         1,
         [](const BodyNode &node, VtuGrid::Array &out)
         { out << std::sqrt(1.5) * deviator(node.values.cauchy_stress).norm(); }},
        {"PEEQ", 1, [](const BodyNode &node, VtuGrid::Array &out) { out << node.values.equivalent_plastic_strain; }},
        {"green_lagrange_strain",
         dim *dim,
         [](const BodyNode &node, VtuGrid::Array &out) { out << node.values.green_lagrange_strain; }},
        {"logarithmic_strain",
         dim *dim,
         [](const BodyNode &node, VtuGrid::Array &out) { out << node.values.logarithmic_strain; }},
        {"principal_stress_1", 1, principal_stress<0>},
        {"principal_stress_2", 1, principal_stress<1>},
        {"principal_stress_3", 1, principal_stress<2>},
        {"principal_direction_1", dim, principal_direction<0>},
        {"principal_direction_2", dim, principal_direction<1>},
        {"principal_direction_3", dim, principal_direction<2>}};

    using Contact = const ContactNode &;
    using Out     = VtuGrid::Array &;

    const std::vector<VtuField<ContactNode>> contact_fields = {
        {"CPRESS", 1, [](Contact node, Out out) { out << node.fields.pressure[node.k]; }},
        {"COPEN", 1, [](Contact node, Out out) { out << node.fields.gap[node.k]; }},
        {"CSHEAR1", 1, [](Contact node, Out out) { out << node.fields.shear[0][node.k]; }},
        {"CSHEAR2", 1, [](Contact node, Out out) { out << node.fields.shear[1][node.k]; }},
        {"CSLIP1", 1, [](Contact node, Out out) { out << node.fields.slip[0][node.k]; }},
        {"CSLIP2", 1, [](Contact node, Out out) { out << node.fields.slip[1][node.k]; }},
        {"CSTATUS", 1, [](Contact node, Out out) { out << static_cast<unsigned int>(node.fields.status[node.k]); }},
        {"paired", 1, [](Contact node, Out out) { out << node.fields.paired[node.k]; }},
        {"normal", dim, [](Contact node, Out out) { out << node.fields.normal[node.k]; }},
        {"tangent1", dim, [](Contact node, Out out) { out << node.fields.tangent1[node.k]; }},
        {"friction_traction", dim, [](Contact node, Out out) { out << node.fields.friction[node.k]; }},
        {"contact_traction",
         dim,
         [](Contact node, Out out)
         { out << node.fields.friction[node.k] - node.fields.pressure[node.k] * node.fields.normal[node.k]; }},
        {"area", 1, [](Contact node, Out out) { out << node.fields.area[node.k]; }},
        {"status_changes", 1, [](Contact node, Out out) { out << node.fields.status_changes[node.k]; }},
        {"cycle_period", 1, [](Contact node, Out out) { out << node.fields.cycle_period[node.k]; }},
        {"contradiction", 1, [](Contact node, Out out) { out << int(node.fields.contradiction[node.k]); }}};

    template <typename Node>
    std::vector<VtuField<Node>> chosen(std::vector<VtuField<Node>> there, const std::vector<std::string> &fields)
    {
      there.erase(std::remove_if(there.begin(),
                                 there.end(),
                                 [&](const VtuField<Node> &field) { return !is_chosen(fields, field.name); }),
                  there.end());
      return there;
    }
  } // namespace

  std::vector<VtuField<BodyNode>> chosen_body_fields(const std::vector<std::string> &fields, const bool plastic)
  {
    std::vector<VtuField<BodyNode>> all = chosen(body_fields, fields);
    if (!plastic)
      all.erase(std::remove_if(all.begin(),
                               all.end(),
                               [](const VtuField<BodyNode> &field) { return field.name == std::string("PEEQ"); }),
                all.end());
    return all;
  }

  std::vector<VtuField<ContactNode>> chosen_contact_fields(const std::vector<std::string> &fields)
  {
    return chosen(contact_fields, fields);
  }
} // namespace Nodus
