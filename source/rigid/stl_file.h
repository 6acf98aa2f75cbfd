#ifndef nodus_rigid_stl_file_h
#define nodus_rigid_stl_file_h

#include <nodus/base/types.h>

#include <array>
#include <string>
#include <vector>

namespace Nodus
{
  /// Corners of the triangles of an STL file, ASCII or binary, in their order [length]. The normals in the file do not
  /// count. @throws InputError that begins with the name of the file and says where in it something is wrong
  std::vector<std::array<Point, 3>> read_stl(const std::string &file);
} // namespace Nodus

#endif
