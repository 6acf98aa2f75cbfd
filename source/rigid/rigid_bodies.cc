#include "rigid/rigid_bodies.h"
#include "mesh/hanging_nodes.h"
#include "mesh/region.h"
#include "parameters/expression.h"

#include <deal.II/base/numbers.h>
#include <deal.II/fe/fe.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

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

  RigidBodies::RigidBodies(const std::vector<BodyParameters>              &parameters,
                           const std::vector<BoundaryConditionParameters> &conditions,
                           const std::vector<ContactPairParameters>       &pairs,
                           const Bodies                                   &bodies,
                           std::vector<State>                             &now,
                           std::vector<State>                             &begin)
      : all_(bodies)
      , now_(now)
      , begin_(begin)
      , n_pairs_(pairs.size())
  {
    for (unsigned int b = 0; b < parameters.size(); ++b)
    {
      if (!parameters[b].rigid || parameters[b].rigid_free.empty())
        continue;
      Body body;
      body.number = b;
      body.name   = bodies.name(b);
      body.label  = "Rigid body " + std::to_string(b + 1) + " ('" + body.name + "')";
      add(std::move(body),
          parameters[b].motion,
          parameters[b].rigid_free,
          parameters[b].rigid_force,
          parameters[b].rigid_moment);
    }
    for (unsigned int n = 0; n < conditions.size(); ++n)
    {
      const BoundaryConditionParameters &condition = conditions[n];
      if (!condition.couples())
        continue;
      Body face;
      face.number = condition.region.first_body() - 1;
      face.name   = condition.name.empty() ? "boundary condition " + std::to_string(n + 1) : condition.name;
      face.label =
          "Boundary condition " + std::to_string(n + 1) + (condition.name.empty() ? "" : " ('" + condition.name + "')");
      face.face  = &condition;
      face.moves = {};
      for (const unsigned int c : condition.components)
        face.moves[c] = true;
      add(std::move(face), condition.motion, condition.free, condition.force, condition.moment);
    }
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (!pairs[p].is_section())
        continue;
      const std::string number = std::to_string(p + 1);
      Body              section;
      section.number  = pairs[p].slave.first_body() - 1;
      section.name    = pairs[p].name.empty() ? "pair " + number : pairs[p].name;
      section.label   = "Contact pair " + number + (pairs[p].name.empty() ? "" : " ('" + pairs[p].name + "')");
      section.section = &pairs[p];
      section.pair    = p;
      add(std::move(section), {}, {0}, {pairs[p].preload.force, "0", "0"}, {"0", "0", "0"});
    }
    now_.assign(bodies_.size(), State());
    begin = now_;
  }

  void RigidBodies::add(Body                              body,
                        const PrescribedMotionParameters &motion,
                        const std::vector<unsigned int>  &free,
                        std::vector<std::string>          force,
                        const std::vector<std::string>   &moment)
  {
    for (const unsigned int c : free)
      body.free[c] = true;
    const auto ends = all_.bounding_box(body.number).get_boundary_points();
    body.extent     = 0.5 * ends.first.distance(ends.second);
    body.motion     = std::make_unique<PrescribedMotion>(motion, Point(), Vector3(), body.label);
    body.centre     = body.motion->centre();

    std::vector<std::string> &expressions = force;
    expressions.insert(expressions.end(), moment.begin(), moment.end());
    for (const std::string &expression : expressions)
      if (const std::string complaint = expression_complaint(expression, "t"); !complaint.empty())
        throw InputError(body.label + ": '" + expression + "' cannot be evaluated (" + complaint +
                         "); write an expression of t");
    auto loads = std::make_unique<dealii::FunctionParser<1>>(n_components);
    loads->initialize("t", expressions, {{"pi", dealii::numbers::PI}});
    body.loads = std::move(loads);
    bodies_.push_back(std::move(body));
  }

  bool RigidBodies::has_faces() const
  {
    return std::any_of(bodies_.begin(), bodies_.end(), [](const Body &body) { return body.face != nullptr; });
  }

  std::string RigidBodies::title(const unsigned int i) const
  {
    std::string text = bodies_[i].label;
    text.erase(std::remove(text.begin(), text.end(), '\''), text.end());
    text.front() = static_cast<char>(std::tolower(text.front()));
    return text;
  }

  void RigidBodies::find_nodes(const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping)
  {
    const auto                         &fe     = dof_handler.get_fe();
    const auto                         &scalar = fe.base_element(0);
    const dealii::IndexSet             &owned  = dof_handler.locally_owned_dofs();
    std::vector<DoFIndex>               dofs(fe.n_dofs_per_cell());
    std::unique_ptr<const HangingNodes> hanging;
    if (has_faces())
    {
      hanging = std::make_unique<HangingNodes>(dof_handler);
      hanging_.copy_from(hanging_constraints(dof_handler));
    }
    for (Body &body : bodies_)
    {
      if (body.section)
      {
        find_axis(body, dof_handler, mapping);
        continue;
      }
      const auto region = body.face ? std::make_unique<Region>(body.face->region, all_, body.label) : nullptr;
      std::map<DoFIndex, Point> found;
      const auto                take = [&](const auto &cell, const unsigned int node)
      {
        const DoFIndex dof = dofs[fe.component_to_system_index(0, node)];
        if (!owned.is_element(dof) || found.count(dof) > 0)
          return;
        const Point X = mapping.transform_unit_to_real_cell(cell, scalar.unit_support_point(node));
        if (!region || (region->contains_point(X) && !hanging->masters(dof / dim)))
          found[dof] = X;
      };
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial() && cell->material_id() == body.number)
        {
          cell->get_dof_indices(dofs);
          for (unsigned int node = 0; node < scalar.n_dofs_per_cell() && !region; ++node)
            take(cell, node);
          for (const auto face : cell->face_indices())
            if (region && region->contains_face(cell, face))
              for (unsigned int node = 0; node < scalar.n_dofs_per_cell(); ++node)
                if (scalar.has_support_on_face(node, face))
                  take(cell, node);
        }
      body.nodes.clear();
      for (const auto &[dof, X] : found)
        body.nodes.push_back({dof, X});
    }
  }

  std::vector<DoFIndex> RigidBodies::coupled() const
  {
    std::vector<DoFIndex> dofs;
    for (const Body &body : bodies_)
      for (const Node &node : body.nodes)
        for (unsigned int c = 0; c < dim; ++c)
          if (body.face && body.moves[c])
            dofs.push_back(node.dof + c);
    return dofs;
  }

  dealii::Tensor<2, dim> RigidBodies::turned(const unsigned int i) const
  {
    return rotation_by(now_[i].turn) * now_[i].rotation;
  }

  Vector3 RigidBodies::arm(const unsigned int i, const Node &node) const
  {
    return turned(i) * (node.X - bodies_[i].centre);
  }

  void RigidBodies::add_force(const unsigned int i, const Vector3 &arm, const Vector3 &force, double *const sums) const
  {
    Vector3 on = force;
    for (unsigned int c = 0; c < dim; ++c)
      on[c] = moves(i, c) ? force[c] : 0.;
    const Vector3 moment = dealii::cross_product_3d(arm, on);
    for (unsigned int c = 0; c < dim; ++c)
    {
      sums[c] += on[c];
      sums[dim + c] += moment[c];
    }
  }

  void RigidBodies::set_time(const double t)
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      Body &body = bodies_[i];
      for (unsigned int c = 0; c < n_components; ++c)
      {
        if (body.section)
          body.free[c] = c == 0 && body.section->is_tightened(t);
        body.load[c] = body.free[c] ? body.loads->value(dealii::Point<1>(t), c) : 0.;
        if (!std::isfinite(body.load[c]))
        {
          std::ostringstream message;
          message << body.label << ": ";
          if (body.section)
            message << "the preload";
          else
            message << (c < dim ? "force " : "moment ") << "xyz"[c % dim];
          message << " at t = " << t << " is not a number; correct the expression";
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
    for (unsigned int c = 0; c < dim && !body.section; ++c) // a section that is locked stays where it is
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
        throw SolverFailure(bodies_[i].label + " turns by more than half a turn in one increment",
                            SolverFailure::Kind::free_body);
    }
  }

  void RigidBodies::move(Vector &u) const
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      const Body                  &body = bodies_[i];
      const dealii::Tensor<2, dim> R    = turned(i);
      for (const Node &node : body.nodes)
      {
        const Vector3 r     = node.X - body.centre;
        const Vector3 moved = now_[i].translation + (R * r - r);
        for (unsigned int c = 0; c < dim; ++c)
          if (body.moves[c])
            u(node.dof + c) = moved[c];
      }
    }
    if (!bodies_.empty())
      u.compress(dealii::VectorOperation::insert);
    if (has_faces())
      hanging_.distribute(u);
  }

  void RigidBodies::keep_motion(const std::vector<State> &before)
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
      {
        now_[i].motion[c]       = now_[i].translation[c] - before[i].translation[c];
        now_[i].motion[dim + c] = now_[i].turn[c];
      }
  }

  void RigidBodies::go_on(const double part)
  {
    std::vector<double> step;
    for (unsigned int i = 0; i < bodies_.size(); ++i)
    {
      const Components rest = missing(i);
      for (unsigned int c = 0; c < n_components; ++c)
        step.push_back(bodies_[i].free[c] ? part * now_[i].motion[c] : rest[c]);
    }
    advance(1., step);
  }

  void RigidBodies::end_increment(const std::vector<Components> &applied)
  {
    for (unsigned int i = 0; i < bodies_.size(); ++i)
      now_[i] = {now_[i].translation, Vector3(), turned(i), bodies_[i].prescribed_rotation, applied[i], now_[i].motion};
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
    const dealii::Tensor<2, dim> R = turned(i);
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
