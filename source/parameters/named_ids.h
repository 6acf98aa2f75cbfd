#ifndef nodus_parameters_named_ids_h
#define nodus_parameters_named_ids_h

#include <string>
#include <vector>

// Ids of a mesh, as numbers or by the names that its file has for them.

namespace dealii
{
  class ParameterHandler;
}

namespace Nodus
{
  class ParameterFile;
  struct Parameters;
  struct RegionParameters;

  /// A key whose value is a list of ids and names, separated by commas, which go to @p ids and @p names. Names may
  /// have blanks inside, and are no numbers.
  void add_ids(dealii::ParameterHandler  &prm,
               const std::string         &key,
               std::vector<unsigned int> &ids,
               std::vector<std::string>  &names,
               const std::string         &documentation);

  /// Replaces all names by the ids that they stand for in the mesh files: each body has its own. Every rank reads the
  /// names itself, and only where one is asked for. Names of
  /// bodies become their numbers. What Parameters::check() refuses is left for it.
  /// @throws InputError, by ParameterFile::refuse(), for a name that the mesh file does not have, or of a body that is
  /// generated.
  void resolve_names(Parameters &parameters, const ParameterFile &file);
} // namespace Nodus

#endif
