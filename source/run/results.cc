#include "run/results.h"
#include "contact/tractions.h"
#include "mesh/sides.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace Nodus
{
  Results::Results(const Model &model, Journal &journal, const States &states, const Equilibrium &equilibrium)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , equilibrium_(equilibrium)
  {
  }

  void Results::find_points()
  {
    const Parameters              &parameters = model_.parameters;
    std::vector<BodyPoints::Place> places;
    for (unsigned int i = 0; i < parameters.output_points.size(); ++i)
    {
      const OutputPointParameters &point = parameters.output_points[i];
      places.push_back(
          {"Output point " + std::to_string(i + 1) + " ('" + point.name + "')", point.body, Point(point.position)});
    }
    for (unsigned int i = 0; i < parameters.output_lines.size(); ++i)
    {
      const OutputLineParameters &line = parameters.output_lines[i];
      for (unsigned int k = 0; k < line.points; ++k)
        places.push_back({"Output line " + std::to_string(i + 1) + " ('" + line.name + "')",
                          line.body,
                          Point(line.from + k / (line.points - 1.) * (line.to - line.from))});
    }
    if (!places.empty())
      points_ = std::make_unique<BodyPoints>(model_.bodies, model_.dof_handler, *model_.mapping, places);
  }

  void Results::add_points(const Increment &increment, const bool with_lines)
  {
    if (!points_)
      return;
    const Vector                          u = model_.with_ghosts(states_.committed.unknowns.block(0));
    const NodalStress                     stress(model_.dof_handler, *model_.solid, u);
    const std::vector<BodyPoints::Values> values = points_->values(u, stress);
    auto                                  value  = values.begin();
    std::vector<Tables::PointRow>         points, lines;
    for (const OutputPointParameters &point : model_.parameters.output_points)
    {
      points.push_back({point.name, 0., value->displacement, value->cauchy_stress});
      ++value;
    }
    for (const OutputLineParameters &line : model_.parameters.output_lines)
      for (unsigned int k = 0; k < line.points; ++k, ++value)
        lines.push_back({line.name,
                         k / (line.points - 1.) * (line.to - line.from).norm(),
                         value->displacement,
                         value->cauchy_stress});
    journal_.tables->add_points(increment.number, increment.end, points);
    if (with_lines)
      journal_.tables->add_lines(increment.number, increment.end, lines);
  }

  void Results::begin_on_mesh()
  {
    find_points();
    if (!model_.parameters.output.write_vtu)
      return;
    const VtuOutput::Series series = vtu_ ? vtu_->series() : VtuOutput::Series();
    vtu_                           = std::make_unique<VtuOutput>(model_.parameters.output,
                                       model_.bodies,
                                       model_.dof_handler,
                                       *model_.mapping,
                                       *model_.solid,
                                       model_.parameters.load_stepping.has_arc_length());
    if (!series.empty())
      vtu_->continue_from(series);
  }

  void Results::write_initial_state()
  {
    if (!vtu_ || model_.parameters.output.vtu_interval == 0)
      return;
    const auto timer = journal_.profile.time(Phase::output);
    model_.contact->evaluate();
    vtu_->write(0, 0., model_.with_ghosts(states_.now.unknowns.block(0)), model_.contact->fields());
  }

  void Results::update()
  {
    fields_ = model_.contact->fields();
    whole_fields_.clear();
    resultants_               = model_.contact->resultants();
    const NodalForces &forces = equilibrium_.forces();
    reactions_.clear();
    for (const auto &region : model_.boundary_conditions->reaction_regions())
    {
      Vector3 force;
      for (unsigned int c = 0; c < dim; ++c)
        for (const DoFIndex i : region.dofs[c])
          force[c] += forces.internal(i) - forces.external(i) + forces.contact(i);
      for (unsigned int c = 0; c < dim; ++c)
        force[c] = dealii::Utilities::MPI::sum(force[c], model_.communicator);
      reactions_.emplace_back(region.name, force);
    }
    rigid_motions_.clear();
    preloads_.clear();
    const RigidBodies &rigid_bodies = model_.rigid_bodies;
    for (unsigned int b = 0; b < rigid_bodies.size(); ++b)
    {
      const RigidBodies::Components &applied = states_.now.rigid[b].applied;
      if (rigid_bodies.is_section(b))
      {
        const Vector3 &force = resultants_[rigid_bodies.pair(b)].slave_force, &axis = rigid_bodies.axis(b);
        preloads_.push_back({rigid_bodies.name(b),
                             applied[0],
                             rigid_bodies.translation(b)[0],
                             force - (force * axis) * axis,
                             !rigid_bodies.is_free(b, 0)});
        continue;
      }
      rigid_motions_.push_back({rigid_bodies.name(b),
                                rigid_bodies.translation(b),
                                rigid_bodies.rotation(b),
                                Vector3({applied[0], applied[1], applied[2]}),
                                Vector3({applied[3], applied[4], applied[5]})});
    }
  }

  void Results::write(const Increment &increment, const bool last)
  {
    const unsigned int interval   = model_.parameters.output.vtu_interval;
    const bool         with_files = last || (interval > 0 && increment.number % interval == 0);
    add_points(increment, with_files);
    std::vector<Tables::Reaction> table;
    for (const auto &[name, force] : reactions_)
      table.push_back({name, force});
    journal_.tables->add(increment.number,
                         increment.end,
                         resultants_,
                         table,
                         rigid_motions_,
                         preloads_,
                         states_.committed.energies,
                         journal_.counts,
                         journal_.verdict);
    if (with_files)
      write_state(increment.number, increment.end);
  }

  void Results::write_state(const unsigned int increment, const double time)
  {
    if (vtu_)
      vtu_->write(increment, time, model_.with_ghosts(states_.committed.unknowns.block(0)), fields_);
  }

  const std::vector<ContactFields> &Results::whole_fields()
  {
    if (whole_fields_.empty())
      whole_fields_ = whole_surface(fields_, model_.communicator);
    return whole_fields_;
  }

  const std::vector<ContactResultants> &Results::resultants() const
  {
    return resultants_;
  }

  const std::vector<std::pair<std::string, Vector3>> &Results::reactions() const
  {
    return reactions_;
  }

  const std::vector<RigidBodyMotion> &Results::rigid_motions() const
  {
    return rigid_motions_;
  }

  const std::vector<PreloadSection> &Results::preloads() const
  {
    return preloads_;
  }

  Vector3 Results::displacement(const unsigned int body, const Point &X) const
  {
    const auto             &fe             = model_.fe;
    const auto             &support_points = fe.base_element(0).get_unit_support_points();
    const dealii::IndexSet &owned          = model_.contact->surfaces().layout().owned[0];
    std::vector<DoFIndex>   dofs(fe.n_dofs_per_cell());
    double                  found[dim + 1] = {0., 0., 0., 0.}; // owned components and how often they were met
    dealii::IndexSet        counted(model_.dof_handler.n_dofs());
    for (const auto &cell : model_.dof_handler.active_cell_iterators())
      if (!cell->is_artificial() && cell->material_id() + 1 == body)
      {
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < support_points.size(); ++i)
          if (model_.mapping->transform_unit_to_real_cell(cell, support_points[i]).distance(X) <
              1e-8 * cell->diameter())
            for (unsigned int c = 0; c < dim; ++c)
            {
              const DoFIndex dof = dofs[fe.component_to_system_index(c, i)];
              if (owned.is_element(dof) && !counted.is_element(dof))
              {
                counted.add_index(dof);
                found[c] += states_.committed.unknowns.block(0)(dof);
                found[dim] += 1. / dim;
              }
            }
      }
    Vector3 u;
    for (unsigned int c = 0; c < dim; ++c)
      u[c] = dealii::Utilities::MPI::sum(found[c], model_.communicator);
    const double n = dealii::Utilities::MPI::sum(found[dim], model_.communicator); // two where it hangs on one like it
    if (n < 0.5)
      throw InputError("body " + std::to_string(body) + " has no node at " + coordinates(X));
    return u / std::round(n);
  }
} // namespace Nodus
