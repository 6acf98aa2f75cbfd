#include "bulk/boundary_conditions.h"
#include "base/deal_ii_versions.h"
#include "bulk/condition_value.h"
#include "parallel/throw_everywhere.h"
#include "parameters/expression.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace Nodus
{
  using namespace dealii;

  struct BoundaryConditions::Held
  {
    Point        X;
    unsigned int condition;
    unsigned int entry;
  };

  namespace
  {
    constexpr auto cure_of_rigid_body = "hold it by taking components out of its 'Rigid free'";
    constexpr auto cure_of_face = "give one of the two other 'Components' or nodes, or take them out of its 'Free'";

    using Type         = BoundaryConditionParameters::Type;
    using CellIterator = DoFHandler<dim>::active_cell_iterator;

    std::string describe(const RegionParameters &region)
    {
      return region.bodies_text() + (region.has_ids() ? ", boundary ids " + region.ids_text() : "");
    }

    /// Throws, everywhere, for the first condition of which no rank found a @p what.
    void check_found(const std::vector<unsigned int>                &found,
                     const std::vector<BoundaryConditionParameters> &parameters,
                     const unsigned int                              condition,
                     const std::string                              &label,
                     const std::string                              &what)
    {
      if (found[condition] > 0)
        return;
      const auto &region = parameters[condition].region;
      throw InputError(label + ": no " + what + " of " + describe(region) +
                       (region.where.empty() ? " belongs to it" : " satisfies '" + region.where + "'") + "; check " +
                       (parameters[condition].type == Type::body_force ? "'Body'" : "'Boundary ids'") + " and 'Where'");
    }

    /// Values of one expression at the start, the middle and the end of a part of the load path.
    std::array<double, 3>
    history(Function<dim> &function, const Point &X, const unsigned int entry, const double begin, const double end)
    {
      std::array<double, 3> values;
      for (unsigned int s = 0; s < 3; ++s)
      {
        function.set_time(begin + s * (end - begin) / 2.);
        values[s] = function.value(X, entry);
      }
      return values;
    }

    bool agree(const std::array<double, 3> &a, const std::array<double, 3> &b)
    {
      double scale = 0., difference = 0.;
      for (unsigned int s = 0; s < 3; ++s)
      {
        scale      = std::max({scale, std::abs(a[s]), std::abs(b[s])});
        difference = std::max(difference, std::abs(a[s] - b[s]));
      }
      return difference <= 1e-8 * scale;
    }

    std::string at(const Point &X, const unsigned int component)
    {
      std::ostringstream text;
      text << "the "
           << "xyz"[component] << " displacement of the node at (" << X << ")";
      return text.str();
    }
  } // namespace

  BoundaryConditions::BoundaryConditions(const std::vector<BoundaryConditionParameters> &parameters,
                                         const Bodies                                   &bodies,
                                         const DoFHandler<dim>                          &dof_handler,
                                         const Mapping<dim>                             &mapping,
                                         const std::vector<double>                      &interval_ends,
                                         const std::vector<BodyParameters>              &body_parameters)
      : bodies_(bodies)
      , dof_handler_(dof_handler)
      , mapping_(mapping)
      , n_given_(parameters.size())
      , parameters_(parameters)
      , hanging_(dof_handler)
  {
    driven_.assign(bodies.size(), false);
    for (unsigned int b = 0; b < body_parameters.size(); ++b)
      if (body_parameters[b].rigid)
      {
        driven_[b] = !body_parameters[b].rigid_free.empty();
        BoundaryConditionParameters condition;
        condition.name          = bodies.name(b);
        condition.type          = Type::rigid_motion;
        condition.region.bodies = {b + 1};
        condition.components    = {0, 1, 2};
        condition.motion        = body_parameters[b].motion;
        parameters_.push_back(condition);
      }
    for (unsigned int n = 0; n < parameters_.size(); ++n)
    {
      functions_.push_back(make_condition_value(parameters_[n], label(n)));
      if (parameters_[n].type == Type::rigid_motion) // for messages
        parameters_[n].value.assign(parameters_[n].components.size(), "rigid motion");
    }
    couples_ =
        std::any_of(parameters_.begin(), parameters_.end(), [](const auto &condition) { return condition.couples(); });
    add_loads();
    find_stages(interval_ends);
    for (unsigned int stage = stages_.size(); stage-- > 0;) // all are checked, the first one stays
      enter(stage);
    set_time(0.);
  }

  void BoundaryConditions::find_stages(const std::vector<double> &interval_ends)
  {
    double begin = 0.;
    for (const double end : interval_ends)
    {
      std::vector<bool> acts;
      for (const auto &condition : parameters_)
        acts.push_back(condition.holds() && condition.acts(end));
      if (!stages_.empty() && stages_.back().acts == acts)
        stages_.back().end = end;
      else
        stages_.push_back({begin, end, acts});
      begin = end;
    }
  }

  void BoundaryConditions::enter(const unsigned int stage)
  {
    stage_ = stage;
    reaction_regions_.clear();
    prescribed_.clear();
    collect_prescribed(find_held(stages_[stage]));
    make_constraints();
  }

  std::string BoundaryConditions::label(const unsigned int condition) const
  {
    const std::string &name = parameters_[condition].name;
    if (condition >= n_given_)
      return "Rigid body " + std::to_string(parameters_[condition].region.first_body()) + " ('" + name + "')";
    return "Boundary condition " + std::to_string(condition + 1) + (name.empty() ? "" : " ('" + name + "')");
  }

  /// The condition is the motion of a rigid body with free components, or a coupled face.
  bool BoundaryConditions::is_driven(const unsigned int condition) const
  {
    return condition >= n_given_ ? driven_[parameters_[condition].region.first_body() - 1]
                                 : parameters_[condition].couples();
  }

  void BoundaryConditions::add_loads()
  {
    std::vector<unsigned int> found(parameters_.size(), 0);
    std::string               error;
    const auto                refuse_driven = [&](const unsigned int n, const unsigned int body)
    {
      const Type type = parameters_[n].type;
      if (driven_[body] && type != Type::traction && type != Type::point_load)
        error = label(n) + ": a " + text_of(type) + " acts on body " + std::to_string(body + 1) +
                ", which is rigid with free components; take the body out of the region and use 'Rigid force' and "
                "'Rigid moment', or a traction";
    };
    for (unsigned int n = 0; n < parameters_.size(); ++n)
      if (!parameters_[n].holds())
      {
        const BoundaryConditionParameters &condition = parameters_[n];
        const bool                         on_cells  = condition.type == Type::body_force || condition.at_point();
        const RegionParameters             where =
            on_cells ? RegionParameters{condition.region.bodies, {}, condition.region.where} : condition.region;
        Load load{&condition, label(n), {where, bodies_, label(n), on_cells}, functions_[n].get(), {}, {}};
        load.directions = condition.directions();
        if (condition.at_point())
        {
          load.place = locate(bodies_, mapping_, where, load.point(), label(n));
          found[n]   = 1;
          refuse_driven(n, load.place->body);
        }
        for (const auto &cell : dof_handler_.active_cell_iterators())
          if (cell->is_locally_owned() && !load.place)
          {
            if (on_cells)
              found[n] += load.region.selects_cell(mapping_, cell);
            else
              for (const auto face : cell->face_indices())
                if (load.region.selects_face(mapping_, cell, face))
                {
                  ++found[n];
                  refuse_driven(n, cell->material_id());
                }
          }
        loads_.push_back(std::move(load));
      }
    throw_everywhere<InputError>(error, communicator_of(dof_handler_));
    Utilities::MPI::max(found, communicator_of(dof_handler_), found);
    for (const auto &load : loads_)
    {
      const unsigned int n = load.parameters - parameters_.data();
      check_found(found, parameters_, n, label(n), parameters_[n].type == Type::body_force ? "cell" : "face");
    }
  }

  /// Owned degrees of freedom only: all cells around them are known here, so no face of a region is missed.
  std::map<DoFIndex, BoundaryConditions::Held> BoundaryConditions::find_held(const Stage &stage)
  {
    const auto               &fe        = dof_handler_.get_fe();
    const auto               &scalar_fe = fe.base_element(0);
    const IndexSet           &owned     = dof_handler_.locally_owned_dofs();
    std::map<DoFIndex, Held>  held;
    std::vector<unsigned int> found(parameters_.size(), 0);
    std::vector<DoFIndex>     dofs(fe.n_dofs_per_cell());
    std::string               error;

    const auto hold = [&](const DoFIndex dof, const Point &X, const unsigned int n, const unsigned int e)
    {
      const auto  new_one = held.insert({dof, {X, n, e}});
      const Held &first   = new_one.first->second;
      if (!error.empty() || (!new_one.second && first.condition == n && first.entry == e))
        return;
      if (!new_one.second && (is_driven(n) || is_driven(first.condition)))
      {
        const unsigned int driven = is_driven(n) ? n : first.condition;
        error                     = label(is_driven(n) ? first.condition : n) + " holds nodes of " + label(driven) +
                ", whose motion is in part free; " + (driven >= n_given_ ? cure_of_rigid_body : cure_of_face);
        return;
      }
      const auto values   = history(*functions_[n], X, e, stage.begin, stage.end);
      const auto position = at(X, parameters_[n].components[e]);
      if (!std::isfinite(values[0] + values[1] + values[2]))
        error = label(n) + ": '" + parameters_[n].value[e] + "' is not a number for " + position;
      else if (!new_one.second &&
               !agree(values, history(*functions_[first.condition], X, first.entry, stage.begin, stage.end)))
        error = label(first.condition) + " and " + label(n) + " prescribe different values for " + position + ": '" +
                parameters_[first.condition].value[first.entry] + "' and '" + parameters_[n].value[e] +
                "'; restrict one of them with 'Where' or 'Components'";
    };

    for (unsigned int n = 0; n < parameters_.size(); ++n)
      if (parameters_[n].holds())
      {
        reaction_regions_.push_back(
            {parameters_[n].name.empty() ? "boundary condition " + std::to_string(n + 1) : parameters_[n].name, {}});
        if (!stage.acts[n])
          continue;
        const Region region(parameters_[n].region, bodies_, label(n));
        const auto   take = [&](const CellIterator &cell, const unsigned int a, const Vector3 &normal)
        {
          const Point X = mapping_.transform_unit_to_real_cell(cell, scalar_fe.unit_support_point(a));
          if (!region.contains_point(X, normal))
            return;
          ++found[n];
          for (unsigned int e = 0; e < parameters_[n].components.size(); ++e)
          {
            const auto component = parameters_[n].components[e];
            const auto dof       = dofs[fe.component_to_system_index(component, a)];
            if (owned.is_element(dof))
              hold(dof, X, n, e);
          }
        };
        const bool whole_body = n >= n_given_;
        for (const auto &cell : dof_handler_.active_cell_iterators())
          if (!cell->is_artificial())
          {
            cell->get_dof_indices(dofs);
            for (unsigned int a = 0; a < scalar_fe.n_dofs_per_cell(); ++a)
              if (whole_body && parameters_[n].region.has_body(cell->material_id() + 1))
                take(cell, a, Vector3());
            for (const auto face : cell->face_indices())
              if (!whole_body && region.contains_face(cell, face))
                for (unsigned int a = 0; a < scalar_fe.n_dofs_per_cell(); ++a)
                  if (scalar_fe.has_support_on_face(a, face))
                    take(cell, a, region.normal(mapping_, cell, face));
          }
        for (const auto &[dof, where] : held)
          if (where.condition == n)
            reaction_regions_.back().dofs[parameters_[n].components[where.entry]].push_back(dof);
      }
    throw_everywhere<InputError>(error, communicator_of(dof_handler_));
    Utilities::MPI::max(found, communicator_of(dof_handler_), found);
    for (unsigned int n = 0; n < parameters_.size(); ++n)
      if (stage.acts[n])
        check_found(found, parameters_, n, label(n), "node");
    return held;
  }

  /// Ghosts ask their owner: the face of a region may belong to a cell that this rank does not know.
  void BoundaryConditions::collect_prescribed(const std::map<DoFIndex, Held> &held)
  {
    const IndexSet &owned    = dof_handler_.locally_owned_dofs();
    const IndexSet  relevant = DoFTools::extract_locally_relevant_dofs(dof_handler_);
    Vector          code_of_owned(owned, communicator_of(dof_handler_));
    Vector          code(owned, relevant, communicator_of(dof_handler_));
    for (const auto &[dof, where] : held)
      code_of_owned(dof) = 1 + dim * where.condition + where.entry;
    code_of_owned.compress(VectorOperation::insert);
    code = code_of_owned;

    const auto                    &fe = dof_handler_.get_fe();
    std::vector<DoFIndex>          dofs(fe.n_dofs_per_cell());
    std::map<DoFIndex, Prescribed> all;
    for (const auto &cell : dof_handler_.active_cell_iterators())
      if (!cell->is_artificial())
      {
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < dofs.size(); ++i)
          if (code(dofs[i]) != 0. && all.count(dofs[i]) == 0)
          {
            const unsigned int found = static_cast<unsigned int>(code(dofs[i])) - 1;
            const Point        X     = mapping_.transform_unit_to_real_cell(
                cell, fe.base_element(0).unit_support_point(fe.system_to_component_index(i).second));
            all[dofs[i]] = {dofs[i], X, found / dim, found % dim, 0.};
          }
      }
    for (const auto &[dof, one] : all)
      prescribed_.push_back(one);
  }

  void BoundaryConditions::make_constraints()
  {
    lines_ = no_constraints(dof_handler_);
    hanging_.add_to(lines_);
    // a hanging node of a region follows its masters, which belong to the region as well
    std::vector<Prescribed> not_hanging;
    for (const auto &one : prescribed_)
      if (!lines_.is_constrained(one.dof))
        not_hanging.push_back(one);
    prescribed_ = not_hanging;
    assembly_lines_.copy_from(lines_);
    for (const auto &one : prescribed_)
    {
      lines_.add_line(one.dof);
      if (one.condition >= n_given_ || !is_driven(one.condition))
        assembly_lines_.add_line(one.dof);
    }
    homogeneous_.copy_from(lines_);
    homogeneous_.close();
    increment_.copy_from(homogeneous_);
  }

  bool BoundaryConditions::set_time(const double t)
  {
    const auto now = std::find_if(stages_.begin(), stages_.end(), [&](const Stage &stage) { return t <= stage.end; });
    const unsigned int stage   = now == stages_.end() ? stages_.size() - 1 : now - stages_.begin();
    const bool         changes = stage != stage_;
    if (changes)
      enter(stage);
    for (auto &function : functions_)
      function->set_time(t);
    std::string problem;
    for (auto &one : prescribed_)
    {
      one.value = functions_[one.condition]->value(one.X, one.entry);
      if (!std::isfinite(one.value) && problem.empty())
      {
        const auto &expressions = parameters_[one.condition].value;
        problem                 = label(one.condition) + ": " +
                  value_complaint(one.entry < expressions.size() ? expressions[one.entry] : "", one.value, one.X, t);
      }
    }
    throw_everywhere<InputError>(problem, communicator_of(dof_handler_));
    return changes;
  }

  const AffineConstraints<double> &BoundaryConditions::increment_constraints(const Vector &u)
  {
    // where nodes hang, from the unresolved lines: close() passes the inhomogeneities on to them
    if (lines_.max_constraint_indirections() > 0)
      increment_.copy_from(lines_);
    for (const auto &one : prescribed_)
      increment_.set_inhomogeneity(one.dof, is_driven(one.condition) ? 0. : one.value - u(one.dof));
    if (couples_)
    {
      assembly_.copy_from(assembly_lines_);
      for (const auto &one : prescribed_)
        if (!is_driven(one.condition))
          assembly_.set_inhomogeneity(one.dof, one.value - u(one.dof));
      assembly_.close();
    }
    increment_.close();
    return increment_;
  }
} // namespace Nodus
