#include "mesh/region.h"
#include "base/deal_ii_versions.h"
#include "parallel/throw_everywhere.h"
#include "parameters/expression.h"
#include "parameters/physical_names.h"

#include <deal.II/fe/mapping_q1.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

namespace Nodus
{
  namespace
  {
    std::unique_ptr<dealii::FunctionParser<dim>> parse_predicate(const std::string &expression,
                                                                 const std::string &context)
    {
      const std::string complaint = expression_complaint(expression, variables_of_faces);
      if (!complaint.empty())
        throw InputError(context + ": 'Where' = " + expression + " cannot be evaluated (" + complaint +
                         "); write a condition on x, y, z and the normal nx, ny, nz such as abs(x) < 1e-9 && nz > 0.5");
      return parse_expression(expression);
    }
  } // namespace

  Region::Region(const RegionParameters &parameters,
                 const Bodies           &bodies,
                 const std::string      &context,
                 const bool              of_cells)
      : parameters_(parameters)
      , asks_for_normal_(!of_cells && has_normal(parameters.where))
  {
    refuse_absent(bodies, context);
    if (parameters.where.find_first_not_of(" \t") != std::string::npos)
    {
      predicate_ = parse_predicate(parameters.where, context);
      refuse_undefined(bodies, context, of_cells);
    }
  }

  void Region::refuse_absent(const Bodies &bodies, const std::string &context) const
  {
    for (const unsigned int body : parameters_.bodies)
      if (body < 1 || body > bodies.size())
        throw InputError(context + ": there is no body " + std::to_string(body) + "; the bodies are numbered 1 to " +
                         std::to_string(bodies.size()) + ", and 0 stands for all of them");
    const bool single = parameters_.bodies.size() == 1;

    std::map<dealii::types::boundary_id, std::string> present; // with names
    std::set<std::string>                             found;   // names that faces have
    for (unsigned int b = 0; b < bodies.size(); ++b)
      if (parameters_.has_body(b + 1))
        for (const auto id : bodies.boundary_ids(b))
        {
          present.emplace(id, named_id(id, bodies.boundary_names(b)));
          if (const auto name = bodies.boundary_names(b).find(id); name != bodies.boundary_names(b).end())
            found.insert(name->second);
        }
    const auto refuse = [&](const std::string &what)
    {
      std::string list;
      for (const auto &[id, text] : present)
        list += (list.empty() ? "" : ", ") + text;
      throw InputError(
          context + ": no face of " + parameters_.bodies_text() +
          (single ? " (" + bodies.name(parameters_.first_body() - 1) + ")" : "") + " has the " + what +
          "; ids present: " + list +
          (present.size() == 1 ? " (a generator numbers the sides when its last argument, colorize, is true)" : ""));
    };
    for (const auto id : parameters_.boundary_ids)
      if (present.count(id) == 0)
        refuse("boundary id " +
               (single ? named_id(id, bodies.boundary_names(parameters_.first_body() - 1)) : std::to_string(id)));
    for (const std::string &name : parameters_.boundary_names)
      if (found.count(name) == 0)
        refuse("name '" + name + "'");
    for (const unsigned int body : parameters_.bodies)
    {
      const auto &ids = bodies.boundary_ids(body - 1);
      if (parameters_.has_ids() &&
          std::none_of(ids.begin(), ids.end(), [&](const auto id) { return parameters_.takes(body, id); }))
        throw InputError(context + ": body " + std::to_string(body) + " (" + bodies.name(body - 1) +
                         ") has no face with one of the ids " + parameters_.ids_text() +
                         "; leave it out, or add an id of it, such as " + std::to_string(body) + ':' +
                         (ids.empty() ? "1" : std::to_string(*ids.begin())));
    }
  }

  void Region::refuse_undefined(const Bodies &bodies, const std::string &context, const bool of_cells) const
  {
    std::string problem;
    const auto  test = [&](const Point &X, const Vector3 &normal)
    {
      const double value = value_at(X, normal);
      if (std::isfinite(value) || !problem.empty())
        return;
      std::ostringstream text;
      text << context << ": 'Where' = '" << parameters_.where << "' is " << no_number(value) << " at (" << X << ")";
      if (asks_for_normal_)
        text << " with the normal (" << normal << ")";
      text << "; write a condition that is true or false everywhere";
      problem = text.str();
    };
    const auto test_all = [&](const auto &part, const Vector3 &normal)
    {
      for (const auto v : part->vertex_indices())
        test(part->vertex(v), normal);
      test(part->center(), normal);
    };
    const dealii::MappingQ1<dim> straight;
    for (const auto &cell : bodies.triangulation().active_cell_iterators())
      if (cell->is_locally_owned() && of_cells && contains_cell(cell))
        test_all(cell, Vector3());
      else if (cell->is_locally_owned() && !of_cells)
        for (const auto f : cell->face_indices())
          if (contains_face(cell, f))
            test_all(cell->face(f), normal(straight, cell, f));
    throw_everywhere<InputError>(problem, communicator_of(bodies.triangulation()));
  }

  Region::~Region()                  = default;
  Region::Region(Region &&) noexcept = default;

  Vector3 Region::outward_normal(const unsigned int face, const Vector3 &a, const Vector3 &b)
  {
    constexpr double digits = 1e12; // without round-off nz == 1 is what it looks like, and -0 is 0
    Vector3          normal = cross_product_3d(a, b);
    normal *= (face % 2 == 1 ? 1. : -1.) / normal.norm();
    for (unsigned int c = 0; c < dim; ++c)
      normal[c] = std::round(normal[c] * digits) / digits + 0.;
    return normal;
  }

  double Region::value_at(const Point &X, const Vector3 &normal) const
  {
    if (asks_for_normal_ && normal != normal_of_predicate_)
    {
      predicate_           = parse_expression(parameters_.where, normal);
      normal_of_predicate_ = normal;
    }
    return predicate_->value(X);
  }

  bool Region::contains_point(const Point &X, const Vector3 &normal) const
  {
    if (!predicate_)
      return true;
    const double value = value_at(X, normal);
    AssertThrow(std::isfinite(value), dealii::ExcMessage("a 'Where' is not a number at a node"));
    return value != 0.;
  }
} // namespace Nodus
