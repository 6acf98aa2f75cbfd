#include "run/driven_rigid_bodies.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int n_components = RigidBodies::n_components;
    /// A motion whose stiffness is below this part of the largest one, or of what a cell resists, is free. Iterative
    /// solvers leave as much of the stiffness of others.
    constexpr double free_fraction_direct = 1e-10, free_fraction_iterative = 1e-6;
    /// Relative residual of iterative solvers for the response to the motion of rigid bodies.
    constexpr double response_tolerance = 1e-8;

    /// Force on a motion that nothing resists, of all forces, which leaves it at rest.
    constexpr double negligible_force = 1e-8;
    /// Components of a motion below this part of the largest one are not named.
    constexpr double round_off = 1e-3;

    std::string text_of(const Vector3 &v)
    {
      std::ostringstream text;
      text.precision(3);
      text << '(' << v << ')';
      return text.str();
    }
    /// Of a vector of all nodes.
    Vector3 at(const RigidBodies::Node &node, const Vector &vector)
    {
      Vector3 value;
      for (unsigned int c = 0; c < dim; ++c)
        value[c] = vector(node.dof + c);
      return value;
    }
  } // namespace

  DrivenRigidBodies::DrivenRigidBodies(const Model &model, const States &states)
      : model_(model)
      , states_(states)
  {
  }

  /// Adds the forces at the nodes of what is driven, viscous ones included, to the border and to the resultants
  /// of the residual. Of this rank.
  void DrivenRigidBodies::add_nodes(LinearSystem &system, const Vector &internal, const Vector &external)
  {
    const RigidBodies     &rigid_bodies = model_.rigid_bodies;
    const ContactSurfaces &surfaces     = model_.contact->surfaces();
    ContactResidual       &residual     = model_.contact->residual();
    const BlockLayout     &layout       = surfaces.layout();
    for (unsigned int b = 0; b < rigid_bodies.size(); ++b)
      for (const RigidBodies::Node &node : rigid_bodies.nodes(b))
      {
        const Vector3 arm   = rigid_bodies.arm(b, node);
        Vector3       force = at(node, internal) - at(node, external);
        rigid_bodies.add_force(b, arm, force, residual.rigid.data() + n_components * b);
        if (rigid_bodies.is_face(b)) // all but the turn of the force stands in what take_faces() took
        {
          for (unsigned int c = 0; c < dim; ++c)
            force[c] = rigid_bodies.moves(b, c) ? force[c] : 0.;
          add_turn(layout, b, arm, force, system.border);
          continue;
        }
        const double k = model_.stabilisation->resistance(layout.owned[0].index_within_set(node.dof));
        if (force == Vector3() && k == 0.)
          continue;
        rigid_bodies.add_force(b, arm, -force, system.border_rhs.data() + n_components * b);
        add_turn(layout, b, arm, force, system.border);
        const auto add_row = [&](const DoFIndex row, const double row_part, const unsigned int c)
        {
          surfaces.for_each_rigid_unknown(b,
                                          c,
                                          1.,
                                          arm,
                                          [&](const DoFIndex column, const double part)
                                          { system.border.add(row, column, k * row_part * part); });
        };
        for (unsigned int c = 0; c < dim && k > 0.; ++c)
          surfaces.for_each_rigid_unknown(
              b, c, 1., arm, [&](const DoFIndex row, const double part) { add_row(row, part, c); });
      }
    for (std::size_t k = 0; k < face_border_.value.size(); ++k)
      system.border.add(face_border_.row[k], face_border_.column[k], face_border_.value[k]);
    for (unsigned int i = 0; i < face_rhs_.size(); ++i)
      system.border_rhs[i] += face_rhs_[i];
  }

  /// Viscous forces on the nodes of driven rigid bodies, which the bulk takes for prescribed ones.
  void DrivenRigidBodies::add_drag(const Vector &moved, Vector &drag) const
  {
    const RigidBodies     &rigid_bodies = model_.rigid_bodies;
    const ContactSurfaces &surfaces     = model_.contact->surfaces();
    for (unsigned int b = 0; b < rigid_bodies.size() && rigid_bodies.is_body(b); ++b)
      for (const RigidBodies::Node &node : rigid_bodies.nodes(b))
      {
        const double k = model_.stabilisation->resistance(surfaces.layout().owned[0].index_within_set(node.dof));
        for (unsigned int c = 0; c < dim; ++c)
          drag(node.dof + c) = -k * moved(node.dof + c);
      }
    drag.compress(dealii::VectorOperation::insert);
  }

  /// Equilibrium of the driven rigid bodies, and what their prescribed components still lack.
  void DrivenRigidBodies::add_to(LinearSystem         &system,
                                 const Vector         &internal,
                                 const Vector         &external,
                                 const double          force_scale,
                                 const double          length,
                                 NewtonProblem::Norms &norms)
  {
    const RigidBodies &rigid_bodies = model_.rigid_bodies;
    add_nodes(system, internal, external);
    const std::vector<double> &rigid = model_.contact->residual().rigid;
    std::vector<double>        sum(rigid.size());
    dealii::Utilities::MPI::sum(rigid, model_.communicator, sum);
    applied_.resize(rigid_bodies.size());
    for (unsigned int b = 0; b < rigid_bodies.size(); ++b)
    {
      std::copy_n(sum.begin() + n_components * b, n_components, applied_[b].begin());
      const RigidBodies::Components &load = rigid_bodies.load(b), missing = rigid_bodies.missing(b);
      double                         scale = force_scale, worst = 0.;
      for (unsigned int c = 0; c < n_components; ++c)
      {
        const double lever = c < dim ? 1. : rigid_bodies.extent(b);
        scale              = std::max({scale, std::abs(load[c]) / lever, std::abs(applied_[b][c]) / lever});
        if (rigid_bodies.is_free(b, c))
          worst = std::max(worst, std::abs(applied_[b][c] - load[c]) / lever);
        norms.prescribed = std::max(norms.prescribed, std::abs(missing[c]) * lever / length);
      }
      norms.force = std::max(norms.force, scale > 0. ? worst / scale : 0.);
    }
  }

  std::vector<double> DrivenRigidBodies::resultants(const Vector &forces) const
  {
    const RigidBodies  &rigid_bodies = model_.rigid_bodies;
    std::vector<double> sums(n_components * rigid_bodies.size(), 0.);
    for (unsigned int b = 0; b < rigid_bodies.size(); ++b)
      for (const RigidBodies::Node &node : rigid_bodies.nodes(b))
        rigid_bodies.add_force(b, rigid_bodies.arm(b, node), at(node, forces), sums.data() + n_components * b);
    return sums;
  }

  DrivenRigidBodies::Equations DrivenRigidBodies::equations() const
  {
    const RigidBodies &rigid_bodies = model_.rigid_bodies;
    const unsigned int n            = n_components * rigid_bodies.size();
    Equations          e{dealii::FullMatrix<double>(n, n), dealii::Vector<double>(n), {}};
    for (unsigned int i = 0; i < rigid_bodies.size(); ++i)
    {
      const auto spin = rigid_bodies.spin(i);
      for (unsigned int c = 0; c < n_components; ++c)
      {
        const unsigned int first = n_components * i;
        e.scale(first + c)       = c < dim ? 1. : 1. / rigid_bodies.extent(i);
        for (unsigned int d = 0; d < n_components; ++d)
          e.components(first + d, first + c) = c < dim || d < dim ? (c == d ? 1. : 0.) : spin[d - dim][c - dim];
        if (rigid_bodies.is_free(i, c))
          e.rows.push_back(first + c);
      }
    }
    return e;
  }

  BorderedSystem::RightHandSide DrivenRigidBodies::right_hand_side(const Equations           &e,
                                                                   const BlockVector         &a,
                                                                   const std::vector<double> &force,
                                                                   const std::vector<double> &missing) const
  {
    BorderedSystem::RightHandSide rhs{
        &a, dealii::Vector<double>(missing.size()), dealii::Vector<double>(force.begin(), force.end())};
    e.components.vmult(rhs.p, dealii::Vector<double>(missing.begin(), missing.end()));
    return rhs;
  }

  LinearSolver::Report DrivenRigidBodies::solve(const LinearSystem       &system,
                                                const TimeRates *const    rates,
                                                ChosenSolver             &solver,
                                                const double              relative_tolerance,
                                                std::vector<BlockVector> &solutions,
                                                std::string              &free)
  {
    const RigidBodies  &rigid_bodies = model_.rigid_bodies;
    const unsigned int  n            = n_components * rigid_bodies.size();
    const Equations     e            = equations();
    std::vector<double> force(n), missing;
    dealii::Utilities::MPI::sum(system.border_rhs, model_.communicator, force);
    for (unsigned int i = 0; i < n; ++i)
    {
      force[i] += rigid_bodies.load(i / n_components)[i % n_components];
      missing.push_back(rigid_bodies.missing(i / n_components)[i % n_components]);
    }
    std::vector<BorderedSystem::RightHandSide> rhs = {right_hand_side(e, system.rhs, force, missing)};
    if (rates)
      rhs.push_back(right_hand_side(e, rates->rhs, rates->rigid_force, rates->rigid_missing));
    dealii::FullMatrix<double> P(n, e.rows.size());
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < e.rows.size(); ++j)
        P(i, j) = e.components(i, e.rows[j]);
    BorderedSystem bordered(system);
    bordered.eliminate([&](const std::vector<const BlockVector *> &rhs, std::vector<BlockVector> &x)
                       { return solver.solve(system, rhs, x, std::min(relative_tolerance, response_tolerance)); },
                       P,
                       e.rows,
                       rhs);
    if (!bordered.report().null_pivots.empty())
      return bordered.report();
    const double least =
        solver.type() == LinearSolverParameters::Type::direct ? free_fraction_direct : free_fraction_iterative;
    solutions.resize(rhs.size());
    for (unsigned int k = 0; k < rhs.size(); ++k)
    {
      const dealii::Vector<double> y = resolve(bordered, k, rhs[k], e, least, free);
      if (!free.empty())
        return bordered.report();
      bordered.expand(k, y, solutions[k]);
      std::vector<double> &components = k == 0 ? correction_ : rate_;
      components                      = k == 0 ? missing : rates->rigid_missing;
      for (unsigned int i = 0; i < e.rows.size(); ++i)
        components[e.rows[i]] = y(i);
    }
    return bordered.report();
  }

  void DrivenRigidBodies::add_time(const double step)
  {
    for (unsigned int i = 0; i < correction_.size(); ++i)
      correction_[i] += step * rate_[i];
  }

  dealii::Vector<double> DrivenRigidBodies::resolve(const BorderedSystem                &bordered,
                                                    const unsigned int                   number,
                                                    const BorderedSystem::RightHandSide &rhs,
                                                    const Equations                     &e,
                                                    const double                         free_fraction,
                                                    std::string                         &free)
  {
    const auto                      &rows  = e.rows;
    const auto                      &scale = e.scale;
    dealii::LAPACKFullMatrix<double> S(rows.size());
    dealii::Vector<double>           y(rows.size());
    for (unsigned int i = 0; i < rows.size(); ++i)
      for (unsigned int j = 0; j < rows.size(); ++j)
        S(i, j) = scale(rows[i]) * bordered.schur_complement()(i, j) * scale(rows[j]);
    S.compute_svd();
    const double largest = std::max(S.singular_value(0), states_.now.stiffness_scale);
    const double least   = largest * free_fraction;
    double       forces  = 0.; // of all motions, as a scale
    bool         waits   = false;
    const auto   u = S.get_svd_u(), vt = S.get_svd_vt();
    for (const unsigned int row : rows)
      forces += std::abs(scale(row) * rhs.b(row));
    for (unsigned int k = 0; k < rows.size(); ++k)
    {
      double force = 0.;
      for (unsigned int i = 0; i < rows.size(); ++i)
        force += u(i, k) * scale(rows[i]) * bordered.rhs(number)(i);
      if (S.singular_value(k) > least)
      {
        for (unsigned int j = 0; j < rows.size(); ++j)
          y(j) += vt(k, j) * scale(rows[j]) * force / S.singular_value(k);
        continue;
      }
      if (!may_wait_for_friction(forces > 0. ? std::abs(force) / forces : 0.))
      {
        std::vector<double> motion(rhs.b.size(), 0.);
        for (unsigned int j = 0; j < rows.size(); ++j)
          motion[rows[j]] = vt(k, j) * scale(rows[j]);
        free = describe(motion);
        return y;
      }
      waits = true;
    }
    waits_ += waits;
    return y;
  }

  /// There is friction, but no pressure yet that it is in proportion to: what only friction resists may rest in the
  /// first correction, and as long as the relative @p force on it is nothing. Collective.
  bool DrivenRigidBodies::may_wait_for_friction(const double force) const
  {
    const ContactSurfaces &surfaces = model_.contact->surfaces();
    const Status          &status   = model_.contact->status();
    if (!status.has_friction())
      return false;
    bool acts = false;
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      acts = acts || (surfaces.is_owned(s) && status.friction(s));
    return dealii::Utilities::MPI::max(acts ? 1 : 0, model_.communicator) == 0 &&
           (waits_ == 0 || force <= negligible_force);
  }

  /// "rigid body 2 (punch) moves along (1 0 0)": six components of each.
  std::string DrivenRigidBodies::describe(const std::vector<double> &motion) const
  {
    const RigidBodies &rigid_bodies = model_.rigid_bodies;
    const auto         lever        = [&](const unsigned int i)
    { return i % n_components < dim ? 1. : rigid_bodies.extent(i / n_components); };
    double largest = 0.;
    for (unsigned int i = 0; i < motion.size(); ++i)
      largest = std::max(largest, std::abs(motion[i]) * lever(i));
    std::string text;
    for (unsigned int b = 0; b < rigid_bodies.size(); ++b)
    {
      Vector3 part[2]; // translation and rotation, without round-off
      for (unsigned int c = 0; c < n_components; ++c)
        if (const unsigned int i = n_components * b + c; std::abs(motion[i]) * lever(i) > round_off * largest)
          part[c / dim][c % dim] = motion[i];
      if (part[0].norm() + part[1].norm() == 0.)
        continue;
      text += (text.empty() ? "" : ", together with ") + rigid_bodies.title(b);
      if (rigid_bodies.is_section(b))
      {
        text += " changes its length";
        continue;
      }
      if (part[0].norm() > 0.)
        text += " moves along " + text_of(part[0] / part[0].norm());
      if (part[1].norm() > 0.)
        text += std::string(part[0].norm() > 0. ? " and" : "") + " turns about " + text_of(part[1] / part[1].norm()) +
                " through " + text_of(rigid_bodies.centre(b));
    }
    return text;
  }
} // namespace Nodus
