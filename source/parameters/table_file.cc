#include "parameters/table_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace Nodus
{
  std::string read_table(BoundaryConditionParameters &condition)
  {
    std::ifstream file(condition.table_file);
    if (!file)
      return "is no file that can be read: " + condition.table_file +
             "; names are relative to the folder of the .prm file";
    std::string  line;
    bool         names  = true; // the first line may be of those
    unsigned int number = 0;
    while (std::getline(file, line))
    {
      ++number;
      std::replace_if(
          line.begin(), line.end(), [](const char c) { return c == ',' || c == ';' || c == '\r'; }, ' ');
      std::istringstream words(line);
      std::string        first, rest;
      if (!(words >> first) || first[0] == '#')
        continue;
      std::istringstream numbers(line);
      double             time, value;
      if (numbers >> time >> value && !(numbers >> rest))
      {
        condition.table_times.push_back(time);
        condition.table_values.push_back(value);
      }
      else if (!names)
        return "has no time and value alone in line " + std::to_string(number) + " of " + condition.table_file +
               "; write two numbers, for example 0.5, 12";
      names = false;
    }
    return condition.table_times.empty() ? "has no times and values: " + condition.table_file : "";
  }
} // namespace Nodus
