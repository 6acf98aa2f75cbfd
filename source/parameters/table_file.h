#ifndef nodus_parameters_table_file_h
#define nodus_parameters_table_file_h

#include <nodus/parameters/parameters.h>

#include <string>

namespace Nodus
{
  /// Reads the times and values of the table of @p condition from its file. @returns what is wrong with the file, empty
  /// for nothing.
  std::string read_table(BoundaryConditionParameters &condition);
} // namespace Nodus

#endif
