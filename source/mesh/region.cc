#include <nodus/mesh/region.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/numbers.h>

#include <cmath>
#include <iostream>
#include <set>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// deal.II prints five lines to std::cerr on each rank before it throws; the exception says all of it.
    class SilentErrors
    {
    public:
      SilentErrors()
          : before_(std::cerr.rdbuf(sink_.rdbuf()))
      {
      }
      ~SilentErrors()
      {
        std::cerr.rdbuf(before_);
      }
      SilentErrors(const SilentErrors &)            = delete;
      SilentErrors &operator=(const SilentErrors &) = delete;

    private:
      std::ostringstream sink_;
      std::streambuf    *before_;
    };

    std::string reason(const std::exception &error)
    {
      const auto *from_deal = dynamic_cast<const dealii::ExceptionBase *>(&error);
      if (from_deal == nullptr)
        return error.what();
      std::ostringstream text;
      from_deal->print_info(text);
      std::string result = text.str();
      for (char &c : result)
        if (c == '\n')
          c = ' ';
      result.erase(0, result.find_first_not_of(' '));
      result.erase(result.find_last_not_of(' ') + 1);
      return result;
    }

    std::unique_ptr<dealii::FunctionParser<dim>>
    parse_predicate(const std::string &expression, const Point &probe, const std::string &context)
    {
      const SilentErrors silent;
      try
      {
        auto predicate = std::make_unique<dealii::FunctionParser<dim>>(1);
        predicate->initialize("x,y,z", expression, {{"pi", dealii::numbers::PI}});
        // muParser reads the expression at its first evaluation.
        predicate->value(probe);
        return predicate;
      }
      catch (const std::exception &error)
      {
        throw InputError(context + ": 'Where' = " + expression + " cannot be evaluated (" + reason(error) +
                         "); write a condition on x, y, z such as abs(x) < 1e-9 && z > 0.5");
      }
    }
  } // namespace

  Region::Region(const RegionParameters &parameters, const Bodies &bodies, const std::string &context)
      : body_(parameters.body)
      , ids_(parameters.boundary_ids)
  {
    if (body_ > bodies.size())
      throw InputError(context + ": there is no body " + std::to_string(body_) + "; the bodies are numbered 1 to " +
                       std::to_string(bodies.size()) + (body_ == 0 ? "" : ", and 0 stands for all of them"));

    std::set<dealii::types::boundary_id> present;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      if (body_ == 0 || b + 1 == body_)
        present.insert(bodies.boundary_ids(b).begin(), bodies.boundary_ids(b).end());
    for (const auto id : ids_)
      if (present.count(id) == 0)
      {
        std::ostringstream list;
        for (const auto i : present)
          list << (list.tellp() > 0 ? ", " : "") << i;
        throw InputError(
            context + ": no face of " +
            (body_ == 0 ? "any body" : "body " + std::to_string(body_) + " (" + bodies.name(body_ - 1) + ")") +
            " has the boundary id " + std::to_string(id) + "; ids present: " + list.str());
      }

    if (parameters.where.find_first_not_of(" \t") != std::string::npos)
      predicate_ = parse_predicate(parameters.where, bodies.bounding_box(body_ == 0 ? 0 : body_ - 1).center(), context);
  }

  Region::~Region()                  = default;
  Region::Region(Region &&) noexcept = default;

  bool Region::contains_point(const Point &X) const
  {
    return !predicate_ || predicate_->value(X) != 0.;
  }
} // namespace Nodus
