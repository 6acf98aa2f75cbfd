#include "parameters/physical_names.h"
#include <nodus/base/types.h>

#include <deal.II/base/utilities.h>

#include <fstream>
#include <limits>
#include <sstream>

namespace Nodus
{
  namespace
  {
    using dealii::Utilities::trim;

    [[noreturn]] void refuse(const std::string &file, const std::string &line)
    {
      throw InputError("mesh file " + file + ": has '" + line +
                       "' among its $PhysicalNames, where a dimension, an id and a name in quotes belong; write it "
                       "again with gmsh");
    }

    /// 2 14 "seal outer"
    void read_name(const std::string &file, const std::string &line, PhysicalNames &names)
    {
      const auto         begin = line.find('"'), end = line.rfind('"');
      std::istringstream numbers(line.substr(0, begin));
      unsigned int       dimension = 0;
      long               id        = 0;
      if (begin == end || !(numbers >> dimension >> id) || id < 0 || id > std::numeric_limits<int>::max())
        refuse(file, line.substr(0, 100));
      const std::string name = trim(line.substr(begin + 1, end - begin - 1));
      if (dimension == 2)
        names.surfaces[id] = name;
      else if (dimension == 3)
        names.volumes[id] = name;
    }
  } // namespace

  PhysicalNames read_physical_names(const std::string &file)
  {
    std::ifstream in(file, std::ios::binary);
    if (!in)
      throw InputError("mesh file " + file + ": cannot be opened; check that it may be read");
    PhysicalNames names;
    std::string   line;
    const auto    next = [&] { return static_cast<bool>(std::getline(in, line)); };
    while (next() && trim(line) != "$PhysicalNames")
      ;
    if (!in)
      return names;
    next(); // how many there are
    while (next() && trim(line) != "$EndPhysicalNames")
      if (!trim(line).empty())
        read_name(file, trim(line), names);
    if (!in)
      refuse(file, "the end of the file");
    return names;
  }

  std::string named_id(const unsigned int id, const std::map<unsigned int, std::string> &names)
  {
    const auto name = names.find(id);
    return std::to_string(id) + (name == names.end() || name->second.empty() ? "" : " (" + name->second + ")");
  }
} // namespace Nodus
