#include "rigid/rigid_bodies.h"
#include "parameters/expression.h"

#include <deal.II/base/numbers.h>
#include <deal.II/fe/fe.h>
#include <deal.II/lac/la_parallel_vector.h>

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

  RigidBodies::RigidBodies(const std::vector<BodyParameters> &parameters, const Bodies &bodies, std::vector<State> &now)
      : now_(now)
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
    now_.assign(bodies_.size(), State());
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
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      Body &body = bodies_[i];
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
      body.prescribed_translation = body.motion->translation(t);
    }
  }

  RigidBodies::Components RigidBodies::missing(const unsigned int i) const
  {
    const Body   &body = bodies_[i];
    const Vector3 turn = body.prescribed_rotation - now_[i].prescribed_rotation;
    Components    missing{};
    for (unsigned int c = 0; c < dim; ++c)
    {
      if (!body.free[c])
        missing[c] = body.prescribed_translation[c] - now_[i].translation[c];
      if (!body.free[dim + c])
        missing[dim + c] = turn[c] - now_[i].turn[c];
    }
    return missing;
  }

  dealii::Tensor<2, dim> RigidBodies::spin(const unsigned int i) const
  {
    const Vector3         &theta = now_[i].turn;
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
        now_[i].translation[c] += factor * correction[n_components * i + c];
        now_[i].turn[c] += factor * correction[n_components * i + dim + c];
      }
      if (!(now_[i].turn.norm() < dealii::numbers::PI))
        throw SolverFailure(label(bodies_[i]) + " turns by more than half a turn in one increment",
                            SolverFailure::Kind::free_body);
    }
  }

  void RigidBodies::move(Vector &u) const
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      const Body                  &body = bodies_[i];
      const dealii::Tensor<2, dim> R    = rotation_by(now_[i].turn) * now_[i].rotation;
      for (const Node &node : body.nodes)
      {
        const Vector3 r     = node.X - body.centre;
        const Vector3 moved = now_[i].translation + (R * r - r);
        for (unsigned int c = 0; c < dim; ++c)
          u(node.dof + c) = moved[c];
      }
    }
    if (!bodies_.empty())
      u.compress(dealii::VectorOperation::insert);
  }

  void RigidBodies::end_increment(const std::vector<Components> &applied)
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
      now_[i] = {now_[i].translation,
                 Vector3(),
                 rotation_by(now_[i].turn) * now_[i].rotation,
                 bodies_[i].prescribed_rotation,
                 applied[i]};
  }

  double RigidBodies::work(const std::vector<State> &before, const std::vector<Components> &applied) const
  {
    double work = 0.;
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      const Vector3 moved = now_[i].translation - before[i].translation;
      work += 0.5 * (part(before[i].applied, 0) + part(applied[i], 0)) * moved +
              0.5 * (part(before[i].applied, dim) + part(applied[i], dim)) * now_[i].turn;
    }
    return work;
  }

  Vector3 RigidBodies::rotation(const unsigned int i) const
  {
    const dealii::Tensor<2, dim> R = rotation_by(now_[i].turn) * now_[i].rotation;
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
