#include "parameters/general_contact.h"
#include "parameters/parameter_file.h"
#include "parameters/parameter_keys.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>

namespace Nodus
{
  void add_excluded_bodies(dealii::ParameterHandler &prm, ContactPairParameters &pair)
  {
    const std::string key = "Excluded bodies";
    std::string       text;
    for (const auto &[one, other] : pair.excluded_bodies)
      text += (text.empty() ? "" : ", ") + std::to_string(one) + ':' + std::to_string(other);
    prm.declare_entry(
        key,
        text,
        ParameterKeys::anything_separated_by(","),
        "With Self contact: bodies that do not touch each other in this pair [-], by number or Name, e.g. "
        "1:2, lid:groove, or 3:3 for a body that does not touch itself.");
    prm.add_action(key,
                   [&pair](const std::string &given)
                   { pair.excluded_names = dealii::Utilities::split_string_list(given, ','); });
  }

  void complete_general_contact(RegionParameters &region, const std::vector<BodyParameters> &bodies)
  {
    if (region.bodies.empty() && region.body_names.empty())
      for (unsigned int b = 0; b < bodies.size(); ++b)
        if (bodies[b].has_mesh())
          region.bodies.push_back(b + 1);
    if (!region.chooses_faces())
      region.where = "1";
  }

  namespace
  {
    template <typename Predicate>
    void remove_bodies(RegionParameters &region, const Predicate &is_one)
    {
      auto &bodies = region.bodies;
      for (const unsigned int body : bodies)
        if (is_one(body))
          region.ids_of_body.erase(body);
      bodies.erase(std::remove_if(bodies.begin(), bodies.end(), is_one), bodies.end());
    }
  } // namespace

  void make_both_sides(ContactPairParameters &pair, const std::vector<BodyParameters> &bodies)
  {
    pair.master         = pair.slave;
    const auto is_rigid = [&](const unsigned int b) { return b >= 1 && b <= bodies.size() && bodies[b - 1].rigid; };
    if (!std::all_of(pair.slave.bodies.begin(), pair.slave.bodies.end(), is_rigid)) // which is a mistake to speak of
      remove_bodies(pair.slave, is_rigid);
  }

  RegionParameters master_alone(const ContactPairParameters &pair)
  {
    RegionParameters alone = pair.master;
    remove_bodies(alone, [&](const unsigned int body) { return pair.slave.has_body(body); });
    return alone;
  }

  void resolve_excluded_bodies(ContactPairParameters             &pair,
                               const std::vector<BodyParameters> &bodies,
                               const ParameterFile               &file,
                               const std::string                 &section)
  {
    const auto number = [&](const std::string &text) -> unsigned int
    {
      for (unsigned int b = 1; b <= bodies.size(); ++b)
        if (!text.empty() && (text == std::to_string(b) || text == bodies[b - 1].name) && pair.slave.has_body(b))
          return b;
      return 0;
    };
    if (!pair.self_contact)
      return; // which is the mistake to speak of
    for (const std::string &item : pair.excluded_names)
    {
      const auto         colon = item.find(':');
      const unsigned int one   = number(dealii::Utilities::trim(item.substr(0, colon)));
      const unsigned int other =
          colon == std::string::npos ? 0 : number(dealii::Utilities::trim(item.substr(colon + 1)));
      if (one == 0 || other == 0)
        file.refuse(section,
                    "Excluded bodies",
                    "has '" + item + "'; give numbers or names of two bodies of the pair with a colon between them, " +
                        "such as " + std::to_string(pair.slave.first_body()) + ':' +
                        std::to_string(pair.slave.first_body()));
      pair.excluded_bodies.emplace_back(one, other);
    }
    pair.excluded_names.clear();
  }
} // namespace Nodus
