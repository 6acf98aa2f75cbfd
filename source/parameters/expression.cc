#include "parameters/expression.h"

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <regex>
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
    /// A '=' that compares nothing assigns, which changes what is evaluated after it.
    bool assigns(const std::string &expression)
    {
      for (std::size_t i = 0; i < expression.size(); ++i)
        if (expression[i] == '=')
        {
          if (i + 1 < expression.size() && expression[i + 1] == '=')
            ++i;
          else if (i == 0 || std::string("<>!").find(expression[i - 1]) == std::string::npos)
            return true;
        }
      return false;
    }

    /// muParser takes '&&' and a name right behind it for one operator.
    bool runs_into_name(const std::string &expression)
    {
      return std::regex_search(expression, std::regex(R"((&&|\|\|)[A-Za-z])"));
    }

    /// deal.II's random numbers differ from one evaluation to the next, and from rank to rank.
    bool is_random(const std::string &expression)
    {
      return std::regex_search(expression, std::regex(R"((^|[^A-Za-z0-9_])rand(_seed)?\s*\()"));
    }
  } // namespace

  std::string expression_complaint(const std::string &expression, const std::string &variables)
  {
    if (has_comma_outside_functions(expression))
      return "a ',' outside of a function; several expressions are separated by ';'";
    if (assigns(expression))
      return "a '=' that is an assignment; '==' compares";
    if (runs_into_name(expression))
      return "'&&' or '||' without a blank behind it; write 'x>1 && y<2'";
    if (is_random(expression))
      return "random numbers, which are others at each evaluation";
    // deal.II prints its own copy of the complaint to std::cerr.
    std::ostringstream    unwanted;
    std::streambuf *const screen = std::cerr.rdbuf(unwanted.rdbuf());
    std::string           message;
    try
    {
      std::map<std::string, double> constants = {{"pi", dealii::numbers::PI}};
      if (variables == "t")
      {
        dealii::FunctionParser<1> function(1);
        function.initialize(variables, expression, constants);
        function.value(dealii::Point<1>(0.5)); // parsed at the first evaluation
      }
      else
      {
        dealii::FunctionParser<dim> function(1);
        std::string                 taken = variables;
        while (std::count(taken.begin(), taken.end(), ',') > dim) // deal.II takes four: the others are constants
        {
          constants[taken.substr(taken.rfind(',') + 1)] = 0.5;
          taken.resize(taken.rfind(','));
        }
        function.initialize(taken, expression, constants, std::count(taken.begin(), taken.end(), ',') == dim);
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
    if (message.find("\"table\"") != std::string::npos)
      message += "; 'table' is known in 'Value' of boundary conditions that have a 'Table file' or 'Table times'";
    return message;
  }

  std::string no_number(const double value)
  {
    return std::isnan(value) ? "not a number" : "infinite";
  }

  std::string value_complaint(const std::string &expression, const double value, const Point &X, const double t)
  {
    std::ostringstream text;
    text << "'Value' = '" << expression << "' is " << no_number(value) << " at (" << X << "), t = " << t
         << "; correct the expression, it must be a number wherever and whenever the condition acts";
    return text.str();
  }

  bool has_normal(const std::string &expression)
  {
    return std::regex_search(expression, std::regex(R"((^|[^A-Za-z0-9_.])n[xyz]($|[^A-Za-z0-9_]))"));
  }

  std::unique_ptr<dealii::FunctionParser<dim>> parse_expression(const std::string &expression, const Vector3 &normal)
  {
    auto function = std::make_unique<dealii::FunctionParser<dim>>(1);
    function->initialize(
        "x,y,z", expression, {{"pi", dealii::numbers::PI}, {"nx", normal[0]}, {"ny", normal[1]}, {"nz", normal[2]}});
    return function;
  }
} // namespace Nodus
