#include "bulk/condition_value.h"
#include "parameters/expression.h"

#include <deal.II/base/function_parser.h>
#include <deal.II/base/numbers.h>

#include <functional>
#include <map>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    /// What a program gives.
    class ProgramFunction : public Function<dim>
    {
    public:
      ProgramFunction(const std::function<double(const Point &, double, unsigned int)> &function, const unsigned int n)
          : Function<dim>(n)
          , function_(function)
      {
      }
      double value(const Point &X, const unsigned int component) const override
      {
        return function_(X, this->get_time(), component);
      }

    private:
      std::function<double(const Point &, double, unsigned int)> function_;
    };
  } // namespace

  std::unique_ptr<Function<dim>> make_condition_value(const BoundaryConditionParameters &parameters,
                                                      const std::string                 &label)
  {
    const std::size_t expected =
        parameters.type == BoundaryConditionParameters::Type::pressure ? 1 : parameters.components.size();
    if (parameters.value.size() != expected || expected == 0)
      throw InputError(label + ": " + std::to_string(parameters.value.size()) + " expressions in 'Value' for " +
                       (parameters.type == BoundaryConditionParameters::Type::pressure
                            ? "a pressure, which takes exactly one"
                            : std::to_string(expected) + " 'Components'; write one expression for each component"));

    if (parameters.function)
      return std::make_unique<ProgramFunction>(parameters.function, expected);
    const std::map<std::string, double> constants = {{"pi", numbers::PI}};
    for (const auto &expression : parameters.value)
    {
      const std::string complaint = expression_complaint(expression, "x,y,z,t");
      if (!complaint.empty())
        throw InputError(label + ": 'Value' = '" + expression + "' cannot be evaluated (" + complaint +
                         "); write an expression of x, y, z, t");
    }
    auto function = std::make_unique<FunctionParser<dim>>(expected);
    function->initialize("x,y,z,t", parameters.value, constants, true);
    return function;
  }
} // namespace Nodus
