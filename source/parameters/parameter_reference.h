#ifndef nodus_parameters_parameter_reference_h
#define nodus_parameters_parameter_reference_h

#include "parameters/parameter_file.h"

#include <string>
#include <vector>

namespace Nodus
{
  /// What a user reads about the keys, here those of one body, one boundary condition and one contact pair.
  namespace ParameterReference
  {
    /// The whole reference in Markdown, as Parameters::documentation() gives it.
    std::string page(const std::vector<DeclaredKey> &keys);

    /// The same for programs, as Parameters::documentation_json() gives it.
    std::string json(const std::vector<DeclaredKey> &keys);

    /// What is to be said about the keys that @p wanted means, as Parameters::explain() gives it.
    /// @throws InputError, with the nearest names, where it means none
    std::string explain(const std::vector<DeclaredKey> &keys, const std::string &wanted);
  } // namespace ParameterReference
} // namespace Nodus

#endif
