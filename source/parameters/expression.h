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

  /// A number of x, y, z that expression_complaint() has found fine.
  std::unique_ptr<dealii::FunctionParser<dim>> parse_expression(const std::string &expression);
} // namespace Nodus

#endif
