#include "parameters/expression.h"

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <iostream>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// muParser takes the last of several expressions, without a word.
    bool has_comma_outside_functions(const std::string &expression)
    {
      int depth = 0;
      for (const char c : expression)
      {
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        if (c == ',' && depth == 0)
          return true;
      }
      return false;
    }
  } // namespace

  std::string expression_complaint(const std::string &expression, const std::string &variables)
  {
    if (has_comma_outside_functions(expression))
      return "a ',' outside of a function; several expressions are separated by ';'";
    // deal.II prints its own copy of the complaint to std::cerr.
    std::ostringstream    unwanted;
    std::streambuf *const screen = std::cerr.rdbuf(unwanted.rdbuf());
    std::string           message;
    try
    {
      const std::map<std::string, double> constants = {{"pi", dealii::numbers::PI}};
      if (variables == "t")
      {
        dealii::FunctionParser<1> function(1);
        function.initialize(variables, expression, constants);
        function.value(dealii::Point<1>(0.5)); // parsed at the first evaluation
      }
      else
      {
        dealii::FunctionParser<dim> function(1);
        function.initialize(
            variables, expression, constants, std::count(variables.begin(), variables.end(), ',') == dim);
        function.value(Point(0.5, 0.25, 0.125));
      }
    }
    catch (const dealii::ExceptionBase &error)
    {
      std::ostringstream text;
      error.print_info(text);
      message              = text.str();
      const auto parser    = message.find("said: ");
      message              = parser == std::string::npos ? message : message.substr(parser + 6);
      const auto last_word = message.find_last_not_of(". \n");
      message.resize(last_word + 1);
    }
    std::cerr.rdbuf(screen);
    return message;
  }

  std::unique_ptr<dealii::FunctionParser<dim>> parse_expression(const std::string &expression)
  {
    auto function = std::make_unique<dealii::FunctionParser<dim>>(1);
    function->initialize("x,y,z", expression, {{"pi", dealii::numbers::PI}});
    return function;
  }
} // namespace Nodus
