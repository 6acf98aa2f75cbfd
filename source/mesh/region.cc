#include "mesh/region.h"
#include "base/deal_ii_versions.h"
#include "parallel/throw_everywhere.h"
#include "parameters/expression.h"

#include <cmath>
#include <set>
#include <sstream>

namespace Nodus
{
  namespace
  {
    std::unique_ptr<dealii::FunctionParser<dim>> parse_predicate(const std::string &expression,
                                                                 const std::string &context)
    {
      const std::string complaint = expression_complaint(expression, "x,y,z");
      if (!complaint.empty())
        throw InputError(context + ": 'Where' = " + expression + " cannot be evaluated (" + complaint +
                         "); write a condition on x, y, z such as abs(x) < 1e-9 && z > 0.5");
      return parse_expression(expression);
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
            " has the boundary id " + std::to_string(id) + "; ids present: " + list.str() +
            (present.size() == 1 ? " (a generator numbers the sides when its last argument, colorize, is true)" : ""));
      }

    if (parameters.where.find_first_not_of(" \t") != std::string::npos)
    {
      predicate_ = parse_predicate(parameters.where, context);
      refuse_undefined(bodies, context, parameters.where);
    }
  }

  void Region::refuse_undefined(const Bodies &bodies, const std::string &context, const std::string &where) const
  {
    std::string problem;
    const auto  test = [&](const Point &X)
    {
      const double value = predicate_->value(X);
      if (std::isfinite(value) || !problem.empty())
        return;
      std::ostringstream text;
      text << context << ": 'Where' = '" << where << "' is " << no_number(value) << " at (" << X
           << "); write a condition that is true or false everywhere";
      problem = text.str();
    };
    const auto test_all = [&](const auto &part)
    {
      for (const auto v : part->vertex_indices())
        test(part->vertex(v));
      test(part->center());
    };
    for (const auto &cell : bodies.triangulation().active_cell_iterators())
      if (cell->is_locally_owned() && ids_.empty() && contains_cell(cell))
        test_all(cell);
      else if (cell->is_locally_owned())
        for (const auto f : cell->face_indices())
          if (contains_face(cell, f))
            test_all(cell->face(f));
    throw_everywhere<InputError>(problem, communicator_of(bodies.triangulation()));
  }

  Region::~Region()                  = default;
  Region::Region(Region &&) noexcept = default;

  bool Region::contains_point(const Point &X) const
  {
    if (!predicate_)
      return true;
    const double value = predicate_->value(X);
    AssertThrow(std::isfinite(value), dealii::ExcMessage("a 'Where' is not a number at a node"));
    return value != 0.;
  }
} // namespace Nodus
