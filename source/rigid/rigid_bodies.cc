#include "rigid/rigid_bodies.h"
#include "parameters/expression.h"

#include <deal.II/base/numbers.h>
#include <deal.II/fe/fe.h>
#include <deal.II/lac/trilinos_vector.h>

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <sstream>

namespace Nodus
{
  namespace
  {
    Vector3 part(const RigidBodies::Components &components, const unsigned int first)
    {
      Vector3 v;
      for (unsigned int c = 0; c < dim; ++c)
        v[c] = components[first + c];
      return v;
    }
  } // namespace

  RigidBodies::RigidBodies(const std::vector<BodyParameters> &parameters, const Bodies &bodies)
  {
    for (unsigned int b = 0; b < parameters.size(); ++b)
    {
      if (!parameters[b].rigid || parameters[b].rigid_free.empty())
        continue;
      Body body;
      body.number = b;
      body.name   = bodies.name(b);
      for (const unsigned int c : parameters[b].rigid_free)
        body.free[c] = true;
      const auto ends = bodies.bounding_box(b).get_boundary_points();
      body.extent     = 0.5 * ends.first.distance(ends.second);
      body.motion     = std::make_unique<PrescribedMotion>(parameters[b].motion, Point(), Vector3(), label(body));
      body.centre     = body.motion->centre();

      std::vector<std::string> expressions = parameters[b].rigid_force;
      expressions.insert(expressions.end(), parameters[b].rigid_moment.begin(), parameters[b].rigid_moment.end());
      for (const std::string &expression : expressions)
        if (const std::string complaint = expression_complaint(expression, "t"); !complaint.empty())
          throw InputError(label(body) + ": '" + expression + "' cannot be evaluated (" + complaint +
                           "); write an expression of t");
      auto loads = std::make_unique<dealii::FunctionParser<1>>(n_components);
      loads->initialize("t", expressions, {{"pi", dealii::numbers::PI}});
      body.loads = std::move(loads);
      bodies_.push_back(std::move(body));
    }
  }

  std::string RigidBodies::label(const Body &body) const
  {
    return "Rigid body " + std::to_string(body.number + 1) + " ('" + body.name + "')";
  }

  void RigidBodies::find_nodes(const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping)
  {
    const auto             &fe    = dof_handler.get_fe();
    const dealii::IndexSet &owned = dof_handler.locally_owned_dofs();
    std::vector<DoFIndex>   dofs(fe.n_dofs_per_cell());
    for (Body &body : bodies_)
    {
      std::map<DoFIndex, Point> found;
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial() && cell->material_id() == body.number)
        {
          cell->get_dof_indices(dofs);
          for (unsigned int i = 0; i < dofs.size(); ++i)
            if (const auto [component, node] = fe.system_to_component_index(i);
                component == 0 && owned.is_element(dofs[i]) && found.count(dofs[i]) == 0)
              found[dofs[i]] = mapping.transform_unit_to_real_cell(cell, fe.base_element(0).unit_support_point(node));
        }
      body.nodes.clear();
      for (const auto &[dof, X] : found)
        body.nodes.push_back({dof, X});
    }
  }

  void RigidBodies::set_time(const double t)
  {
    for (Body &body : bodies_)
    {
      for (unsigned int c = 0; c < n_components; ++c)
      {
        body.load[c] = body.free[c] ? body.loads->value(dealii::Point<1>(t), c) : 0.;
        if (!std::isfinite(body.load[c]))
        {
          std::ostringstream message;
          message << label(body) << ": " << (c < dim ? "force " : "moment ") << "xyz"[c % dim] << " at t = " << t
                  << " is not a number; correct the expression";
          throw InputError(message.str());
        }
      }
      body.prescribed_rotation    = body.motion->rotation(t);
      body.prescribed.translation = body.motion->translation(t);
      body.prescribed.rotation    = body.prescribed_rotation - body.committed.prescribed_rotation;
    }
  }

  RigidBodies::Components RigidBodies::missing(const unsigned int i) const
  {
    const Body &body = bodies_[i];
    Components  missing{};
    for (unsigned int c = 0; c < dim; ++c)
    {
      if (!body.free[c])
        missing[c] = body.prescribed.translation[c] - body.now.translation[c];
      if (!body.free[dim + c])
        missing[dim + c] = body.prescribed.rotation[c] - body.now.rotation[c];
    }
    return missing;
  }

  dealii::Tensor<2, dim> RigidBodies::spin(const unsigned int i) const
  {
    const Vector3         &theta = bodies_[i].now.rotation;
    const double           angle = theta.norm();
    dealii::Tensor<2, dim> cross;
    for (unsigned int c = 0; c < dim; ++c)
    {
      const unsigned int j = (c + 1) % dim, k = (c + 2) % dim;
      cross[k][j] += theta[c];
      cross[j][k] -= theta[c];
    }
    // (1 - cos)/angle^2 and (angle - sin)/angle^3, by series where they would cancel
    const double half = angle > 0. ? std::sin(0.5 * angle) / angle : 0.5, square = angle * angle;
    const double third =
        angle > 1e-2 ? (angle - std::sin(angle)) / (square * angle) : (1. - square / 20. * (1. - square / 42.)) / 6.;
    dealii::Tensor<2, dim> spin = 2. * half * half * cross + third * (cross * cross);
    for (unsigned int c = 0; c < dim; ++c)
      spin[c][c] += 1.;
    return spin;
  }

  void RigidBodies::advance(const double factor, const std::vector<double> &correction)
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      for (unsigned int c = 0; c < dim; ++c)
      {
        bodies_[i].now.translation[c] += factor * correction[n_components * i + c];
        bodies_[i].now.rotation[c] += factor * correction[n_components * i + dim + c];
      }
      if (!(bodies_[i].now.rotation.norm() < dealii::numbers::PI))
        throw SolverFailure(label(bodies_[i]) + " turns by more than half a turn in one increment",
                            SolverFailure::Kind::free_body);
    }
  }

  void RigidBodies::move(Vector &u) const
  {
    for (const Body &body : bodies_)
    {
      const dealii::Tensor<2, dim> R = rotation_by(body.now.rotation) * body.committed.rotation;
      for (const Node &node : body.nodes)
      {
        const Vector3 r     = node.X - body.centre;
        const Vector3 moved = body.now.translation + (R * r - r);
        for (unsigned int c = 0; c < dim; ++c)
          u(node.dof + c) = moved[c];
      }
    }
    if (!bodies_.empty())
      u.compress(dealii::VectorOperation::insert);
  }

  std::vector<RigidBodies::Unknowns> RigidBodies::unknowns() const
  {
    std::vector<Unknowns> all;
    for (const Body &body : bodies_)
      all.push_back(body.now);
    return all;
  }

  void RigidBodies::set_unknowns(const std::vector<Unknowns> &unknowns)
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
      bodies_[i].now = unknowns[i];
  }

  void RigidBodies::commit(const std::vector<Components> &applied)
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      Body &body        = bodies_[i];
      body.committed    = {body.now.translation,
                           rotation_by(body.now.rotation) * body.committed.rotation,
                           body.prescribed_rotation,
                           applied[i]};
      body.now.rotation = Vector3();
    }
  }

  void RigidBodies::roll_back()
  {
    for (Body &body : bodies_)
      body.now = {body.committed.translation, Vector3()};
  }

  std::vector<RigidBodies::State> RigidBodies::committed() const
  {
    std::vector<State> states;
    for (const Body &body : bodies_)
      states.push_back(body.committed);
    return states;
  }

  void RigidBodies::restore(const std::vector<State> &states)
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
      bodies_[i].committed = states.at(i);
    roll_back();
  }

  double RigidBodies::work(const std::vector<Components> &applied) const
  {
    double work = 0.;
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      const Body   &body  = bodies_[i];
      const Vector3 moved = body.now.translation - body.committed.translation;
      work += 0.5 * (part(body.committed.applied, 0) + part(applied[i], 0)) * moved +
              0.5 * (part(body.committed.applied, dim) + part(applied[i], dim)) * body.now.rotation;
    }
    return work;
  }

  Vector3 RigidBodies::rotation(const unsigned int i) const
  {
    const dealii::Tensor<2, dim> R = rotation_by(bodies_[i].now.rotation) * bodies_[i].committed.rotation;
    Eigen::Matrix3d              matrix;
    for (unsigned int r = 0; r < dim; ++r)
      for (unsigned int c = 0; c < dim; ++c)
        matrix(r, c) = R[r][c];
    const Eigen::AngleAxisd turn(matrix);
    Vector3                 vector;
    for (unsigned int c = 0; c < dim; ++c)
      vector[c] = turn.angle() * turn.axis()[c];
    return vector;
  }
} // namespace Nodus
