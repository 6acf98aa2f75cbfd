#ifndef nodus_parameters_body_names_h
#define nodus_parameters_body_names_h

#include <string>
#include <vector>

// Bodies by number or by their Name.

namespace dealii
{
  class ParameterHandler;
}

namespace Nodus
{
  class ParameterFile;
  struct BodyParameters;
  struct RegionParameters;

  /// A key "Body": numbers or names of bodies, 0 for every body.
  void add_bodies(dealii::ParameterHandler &prm,
                  const std::string        &key,
                  RegionParameters         &region,
                  const std::string        &documentation);

  /// A key for the number, from 1, of one body, or its name, for which @p number is left as it is.
  void add_body(dealii::ParameterHandler &prm,
                const std::string        &key,
                unsigned int             &number,
                std::string              &name,
                const std::string        &documentation);

  /// The number of the body called @p name, which stands for it in @p key. @throws InputError, by
  /// ParameterFile::refuse(), where there is none.
  unsigned int number_of_body(const std::string                 &name,
                              const std::vector<BodyParameters> &bodies,
                              const ParameterFile               &file,
                              const std::string                 &section,
                              const std::string                 &key);
} // namespace Nodus

#endif
