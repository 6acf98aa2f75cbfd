#ifndef nodus_parameters_physical_names_h
#define nodus_parameters_physical_names_h

#include <map>
#include <string>

namespace Nodus
{
  /// Names that a gmsh file has for its physical groups, by id.
  struct PhysicalNames
  {
    std::map<unsigned int, std::string> surfaces, volumes;
  };

  /// Of an ASCII or binary @p file; none where it has no $PhysicalNames, which a file of another kind does not either.
  /// @throws InputError: the file cannot be opened, or that section is damaged.
  PhysicalNames read_physical_names(const std::string &file);

  /// "3 (seal_outer)", or "3" without a name.
  std::string named_id(unsigned int id, const std::map<unsigned int, std::string> &names);
} // namespace Nodus

#endif
