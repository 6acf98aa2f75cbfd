#include "bulk/condition_value.h"
#include "bulk/rigid_displacement.h"
#include "parameters/expression.h"

#include <deal.II/base/function_parser.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <sstream>
#include <vector>

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

    /// Expressions of x, y, z, t and `table`, the value of a table at time t. Between two of its times that is linear
    /// in t, which takes its place in the expressions.
    class TableFunction : public Function<dim>
    {
    public:
      explicit TableFunction(const BoundaryConditionParameters &parameters)
          : Function<dim>(parameters.value.size())
          , expressions_(parameters.value)
          , times_(parameters.table_times)
          , values_(parameters.table_values)
      {
        set_time(0.);
      }
      void set_time(const double t) override
      {
        Function<dim>::set_time(t);
        const unsigned int part   = std::upper_bound(times_.begin(), times_.end(), t) - times_.begin();
        auto              &parser = parsers_[part];
        if (!parser)
          parser = make_parser(part);
        now_ = parser.get();
        now_->set_time(t);
      }
      double value(const Point &X, const unsigned int component) const override
      {
        return now_->value(X, component);
      }

    private:
      /// For times between number @p part - 1 and number @p part of the table; before and after it the value is
      /// constant.
      std::unique_ptr<FunctionParser<dim>> make_parser(const unsigned int part) const
      {
        std::ostringstream line;
        line.precision(17);
        if (part == 0 || part == times_.size())
          line << '(' << (part == 0 ? values_.front() : values_.back()) << ')';
        else
          line << '(' << values_[part - 1] << "+("
               << (values_[part] - values_[part - 1]) / (times_[part] - times_[part - 1]) << ")*(t-("
               << times_[part - 1] << ")))";
        std::vector<std::string> expressions;
        for (const std::string &expression : expressions_)
          expressions.push_back(std::regex_replace(expression, std::regex("\\btable\\b"), line.str()));
        auto parser = std::make_unique<FunctionParser<dim>>(n_components);
        parser->initialize("x,y,z,t", expressions, {{"pi", numbers::PI}}, true);
        return parser;
      }

      std::vector<std::string>                                     expressions_;
      std::vector<double>                                          times_, values_;
      std::map<unsigned int, std::unique_ptr<FunctionParser<dim>>> parsers_; ///< by part of the table, as they are met
      FunctionParser<dim>                                         *now_ = nullptr;
    };
  } // namespace

  std::unique_ptr<Function<dim>> make_condition_value(const BoundaryConditionParameters &parameters,
                                                      const std::string                 &label)
  {
    if (parameters.type == BoundaryConditionParameters::Type::rigid_motion)
      return std::make_unique<RigidDisplacement>(parameters.motion, parameters.components, label);
    if (parameters.at_point() && parameters.point.size() != dim)
      throw InputError(label + ": 'Point' has " + std::to_string(parameters.point.size()) +
                       " numbers; give three, the reference position x, y, z");
    if (!parameters.direction.empty() && (parameters.direction.size() != dim || !parameters.components.empty()))
      throw InputError(label + ": 'Direction' has to be three numbers, instead of 'Components'");
    const std::size_t expected = parameters.n_values();
    if (parameters.value.size() != expected || expected == 0)
      throw InputError(label + ": " + std::to_string(parameters.value.size()) + " expressions in 'Value' for " +
                       (parameters.type == BoundaryConditionParameters::Type::pressure
                            ? "a pressure, which takes exactly one"
                        : !parameters.direction.empty()
                            ? "a 'Direction', which takes exactly one"
                            : std::to_string(expected) + " 'Components'; write one expression for each component"));

    if (parameters.function)
      return std::make_unique<ProgramFunction>(parameters.function, expected);
    const bool has_table = !parameters.table_times.empty();
    for (const auto &expression : parameters.value)
    {
      const std::string complaint = expression_complaint(expression, has_table ? "x,y,z,t,table" : "x,y,z,t");
      if (!complaint.empty())
        throw InputError(label + ": 'Value' = '" + expression + "' cannot be evaluated (" + complaint +
                         "); write an expression of x, y, z, t" + (has_table ? " and table" : ""));
    }
    if (has_table)
      return std::make_unique<TableFunction>(parameters);
    auto function = std::make_unique<FunctionParser<dim>>(expected);
    function->initialize("x,y,z,t", parameters.value, {{"pi", numbers::PI}}, true);
    return function;
  }
} // namespace Nodus
