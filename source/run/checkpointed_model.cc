#include "run/checkpointed_model.h"

#include <boost/crc.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

namespace Nodus
{
  namespace
  {
    std::string checksum_of(const std::string &file)
    {
      std::ifstream      stream(file, std::ios::binary);
      boost::crc_32_type crc;
      char               buffer[65536];
      while (stream.read(buffer, sizeof buffer) || stream.gcount() > 0)
        crc.process_bytes(buffer, stream.gcount());
      return std::to_string(crc.checksum());
    }

    /// What a state at time @p t has come from. Of conditions and pairs that begin to act later only the surfaces of
    /// the pairs count, which sites belong to, and not when those that act will cease to.
    std::map<std::string, std::string> past(std::map<std::string, std::string> model, const double t)
    {
      const auto section_of  = [](const std::string &key) { return key.substr(0, key.find('/')); };
      const auto makes_sites = [](const std::string &name)
      {
        return name.compare(0, 5, "Slave") == 0 || name.compare(0, 6, "Master") == 0 || name == "Scheme" ||
               name == "Integration" || name == "Quadrature rule";
      };
      const double          present = (1. - 1e-5) * t; // values have six digits
      std::set<std::string> ahead;
      for (const auto &[key, value] : model)
        if (const std::string section = section_of(key); key == section + "/Active from" && std::stod(value) >= present)
          ahead.insert(section);
      for (auto entry = model.begin(); entry != model.end();)
      {
        const std::string section = section_of(entry->first), name = entry->first.substr(entry->first.rfind('/') + 1);
        const bool        lies_ahead =
            ahead.count(section) > 0 && (section.compare(0, 7, "Contact") != 0 || !makes_sites(name));
        const bool goes_on = (name == "Active until" || name == "Preload until") &&
                             (std::stod(entry->second) == 0. || std::stod(entry->second) >= present);
        if (lies_ahead && name == "Preload" && !entry->second.empty())
          entry++->second = "given"; // the state has its shortening from the start on
        else
          entry = lies_ahead || goes_on ? model.erase(entry) : std::next(entry);
      }
      return model;
    }
  } // namespace

  std::map<std::string, std::string> checkpointed_model(const Parameters &parameters)
  {
    std::map<std::string, std::string> model;
    for (const auto &[key, value] : parameters.model())
      if (const std::string last = key.substr(key.rfind('/') + 1); last != "Name" && last != "Table file")
        model[key] = (last == "Mesh file" || last == "Master file") && !value.empty()
                         ? "a file with checksum " + checksum_of(value)
                         : value;
    return model;
  }

  std::string first_difference(const std::map<std::string, std::string> &then,
                               const std::map<std::string, std::string> &now,
                               const double                              t)
  {
    std::vector<std::pair<std::string, std::string>> differences;
    const auto                                       before = past(then, t), after = past(now, t);
    std::set_symmetric_difference(
        before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(differences));
    if (differences.empty())
      return "";
    const std::string &key = differences.front().first;
    if (then.count(key) == 0)
      return "'" + key + "' did not exist then";
    if (now.count(key) == 0)
      return "'" + key + "' does not exist any more";
    return "'" + key + "' was '" + then.at(key) + "' and is '" + now.at(key) + "' now";
  }
} // namespace Nodus
