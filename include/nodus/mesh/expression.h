#ifndef nodus_mesh_expression_h
#define nodus_mesh_expression_h

#include <string>

namespace Nodus
{
  /// muParser's complaint about @p expression of @p variables ("x,y,z", and perhaps a fourth one, or "t" alone;
  /// constant pi), empty when it is fine.
  std::string expression_complaint(const std::string &expression, const std::string &variables);
} // namespace Nodus

#endif
