#ifndef nodus_parameters_expression_h
#define nodus_parameters_expression_h

#include <nodus/base/types.h>

#include <deal.II/base/function_parser.h>

#include <memory>
#include <string>

namespace Nodus
{
  /// muParser's complaint about @p expression of @p variables ("x,y,z", and perhaps one or two more, or "t"
  /// alone; constant pi), empty when it is fine.
  std::string expression_complaint(const std::string &expression, const std::string &variables);

  /// "not a number" or "infinite", for messages.
  std::string no_number(double value);
  /// Says that the @p value of @p expression at @p X and @p t is not a number.
  std::string value_complaint(const std::string &expression, double value, const Point &X, double t);

  /// The variables of expressions that choose faces: a place, and the outward unit normal of the face there.
  constexpr const char *variables_of_faces = "x,y,z,nx,ny,nz";
  /// Whether @p expression has one of nx, ny, nz.
  bool has_normal(const std::string &expression);

  /// A number of x, y, z, and of nx, ny, nz, which are those of @p normal, that expression_complaint() has found fine.
  std::unique_ptr<dealii::FunctionParser<dim>> parse_expression(const std::string &expression,
                                                                const Vector3     &normal = Vector3());
} // namespace Nodus

#endif
