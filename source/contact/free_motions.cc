#include "contact/free_motions.h"
#include "base/deal_ii_versions.h"
#include "mesh/sides.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <set>
#include <sstream>

namespace Nodus
{
  OwnedNodes::OwnedNodes(const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping)
  {
    const auto             &fe    = dof_handler.get_fe();
    const dealii::IndexSet &owned = dof_handler.locally_owned_dofs();
    dealii::FEValues<dim>   values(mapping,
                                 fe,
                                 dealii::Quadrature<dim>(fe.base_element(0).get_unit_support_points()),
                                 dealii::update_quadrature_points);
    X.resize(owned.n_elements() / dim);
    body.resize(X.size());
    std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
      {
        values.reinit(cell);
        cell->get_dof_indices(dofs);
        for (unsigned int node = 0; node < values.n_quadrature_points; ++node)
          if (const DoFIndex i = dofs[fe.component_to_system_index(0, node)]; owned.is_element(i))
          {
            X[owned.index_within_set(i) / dim]    = values.quadrature_point(node);
            body[owned.index_within_set(i) / dim] = cell->material_id();
          }
      }
  }

  namespace
  {
    /// A motion is free when what is held resists it by less than this fraction of the most that it resists any.
    constexpr double free_fraction = 1e-9;
    /// Components of a motion below this are round-off.
    constexpr double noise = 1e-5;

    std::string text_of(const Vector3 &v)
    {
      std::ostringstream text;
      text.precision(3);
      text << '(' << without_round_off(Point(v), v.norm()) << ')';
      return text.str();
    }
  } // namespace

  FreeMotions::FreeMotions(const Bodies                  &bodies,
                           const dealii::DoFHandler<dim> &dof_handler,
                           const dealii::Mapping<dim>    &mapping,
                           const RigidBodies             &rigid_bodies,
                           const OwnedNodes              &nodes,
                           const Vector                  &u)
      : bodies_(bodies)
      , dof_handler_(dof_handler)
      , mapping_(mapping)
      , rigid_bodies_(rigid_bodies)
      , nodes_(nodes)
      , x_(nodes.X)
      , row_(Eigen::VectorXd::Zero(2 * dim * bodies.size()))
      , held_(Eigen::MatrixXd::Zero(row_.size(), row_.size()))
  {
    const dealii::IndexSet &owned = dof_handler.locally_owned_dofs();
    for (const DoFIndex dof : owned)
      x_[owned.index_within_set(dof) / dim][owned.index_within_set(dof) % dim] += u(dof);
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      const auto ends = bodies.bounding_box(b).get_boundary_points();
      centre_.push_back(ends.first + 0.5 * (ends.second - ends.first));
      size_.push_back(0.5 * ends.first.distance(ends.second));
    }
    for (unsigned int i = 0; i < rigid_bodies.size() && rigid_bodies.is_body(i); ++i)
      centre_[rigid_bodies.body(i)] = rigid_bodies.centre(i);
  }

  void FreeMotions::take(const unsigned int body, const Point &x, const Vector3 &direction)
  {
    const Vector3 moment = dealii::cross_product_3d(Vector3(x - centre_[body]), direction) / size_[body];
    for (unsigned int c = 0; c < dim; ++c)
    {
      row_[2 * dim * body + c] += direction[c];
      row_[2 * dim * body + dim + c] += moment[c];
    }
  }

  void FreeMotions::hold()
  {
    held_.noalias() += row_ * row_.transpose();
    row_.setZero();
  }

  void FreeMotions::hold(const DoFIndex dof)
  {
    const auto i = dof_handler_.locally_owned_dofs().index_within_set(dof);
    Vector3    direction;
    direction[i % dim] = 1.;
    take(nodes_.body[i / dim], x_[i / dim], direction);
    hold();
  }

  void FreeMotions::hold_prescribed(const dealii::AffineConstraints<double> &constraints)
  {
    const bool        first_rank = dealii::Utilities::MPI::this_mpi_process(communicator_of(dof_handler_)) == 0;
    std::vector<bool> driven(bodies_.size(), false);
    for (unsigned int i = 0; i < rigid_bodies_.size(); ++i)
    {
      if (rigid_bodies_.is_section(i)) // the pair holds
        continue;
      const unsigned int body = rigid_bodies_.body(i);
      driven[body]            = driven[body] || rigid_bodies_.is_body(i);
      for (unsigned int c = 0; c < RigidBodies::n_components && first_rank; ++c)
        if (!rigid_bodies_.is_free(i, c) && (c >= dim || rigid_bodies_.moves(i, c)))
        {
          Vector3 direction;
          direction[c % dim] = 1.;
          if (rigid_bodies_.is_face(i) && c < dim)
            take(body, rigid_bodies_.centre(i), direction);
          else
            row_[2 * dim * body + c] = 1.;
          hold();
        }
    }
    const std::vector<DoFIndex> coupled = rigid_bodies_.coupled();
    const std::set<DoFIndex>    moved(coupled.begin(), coupled.end());
    const dealii::IndexSet     &owned = dof_handler_.locally_owned_dofs();
    for (const DoFIndex dof : owned)
      if (is_prescribed(constraints, dof) && !driven[nodes_.body[owned.index_within_set(dof) / dim]] &&
          moved.count(dof) == 0)
        hold(dof);
  }

  /// Of a point of a body now: that of the nodes around it. Collective.
  Point FreeMotions::position(const PointInCell &place) const
  {
    const auto             &fe    = dof_handler_.get_fe();
    const dealii::IndexSet &owned = dof_handler_.locally_owned_dofs();
    const MPI_Comm          ranks = communicator_of(dof_handler_);
    std::vector<double>     x(dim, 0.);
    std::vector<DoFIndex>   dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler_.active_cell_iterators())
      if (!cell->is_artificial() && cell->id() == place.cell)
      {
        cell->get_dof_indices(dofs);
        for (unsigned int a = 0; a < fe.base_element(0).n_dofs_per_cell(); ++a)
          if (const DoFIndex dof = dofs[fe.component_to_system_index(0, a)]; owned.is_element(dof))
            for (unsigned int c = 0; c < dim; ++c)
              x[c] += fe.base_element(0).shape_value(a, place.unit) * x_[owned.index_within_set(dof) / dim][c];
      }
    dealii::Utilities::MPI::sum(x, ranks, x);
    return {x[0], x[1], x[2]};
  }

  void FreeMotions::hold_springs(const std::vector<BoundaryConditions::Load> &loads, const double time)
  {
    using Type                       = BoundaryConditionParameters::Type;
    const auto           &fe         = dof_handler_.get_fe();
    const auto           &scalar     = fe.base_element(0);
    const bool            first_rank = dealii::Utilities::MPI::this_mpi_process(communicator_of(dof_handler_)) == 0;
    std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
    for (const auto &load : loads)
    {
      const BoundaryConditionParameters &condition = *load.parameters;
      if (!condition.acts(time))
        continue;
      if (condition.type == Type::point_spring)
      {
        const Point x = position(*load.place);
        for (const Vector3 &direction : load.directions)
          if (first_rank)
          {
            take(load.place->body, x, direction);
            hold();
          }
      }
      if (condition.type != Type::spring)
        continue;
      for (const auto &cell : dof_handler_.active_cell_iterators())
        for (const auto face : cell->face_indices())
          if (!cell->is_artificial() && load.region.selects_face(mapping_, cell, face))
          {
            cell->get_dof_indices(dofs);
            for (unsigned int a = 0; a < scalar.n_dofs_per_cell(); ++a)
              if (scalar.has_support_on_face(a, face))
                if (const DoFIndex dof = dofs[fe.component_to_system_index(0, a)];
                    dof_handler_.locally_owned_dofs().is_element(dof))
                  for (const Vector3 &direction : load.directions)
                  {
                    take(cell->material_id(),
                         x_[dof_handler_.locally_owned_dofs().index_within_set(dof) / dim],
                         direction);
                    hold();
                  }
          }
    }
  }

  void FreeMotions::hold_contact(const ContactSurfaces &surfaces,
                                 const Pairing         &pairing,
                                 const JumpOperator    &jump,
                                 const Status          &status,
                                 const ContactState    &state,
                                 const ContactResidual &residual,
                                 const bool             as_closed)
  {
    const dealii::IndexSet &owned = dof_handler_.locally_owned_dofs();
    Vector                  body(owned, surfaces.layout().communicator);
    for (const DoFIndex dof : owned)
      body(dof) = nodes_.body[owned.index_within_set(dof) / dim];
    body.compress(dealii::VectorOperation::insert);
    std::vector<Vector3> body_of;
    surfaces.gather(body, body_of);

    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      if (!surfaces.is_owned(s) || !surfaces.has_status(s) || !pairing[s].found || !(as_closed || status.contact(s)))
        continue;
      const auto hold_towards = [&](const Vector3 &direction)
      {
        for (auto e = jump.begin(s); e != jump.end(s); ++e)
          take(std::lround(body_of[e->node][0]), state.x[e->node], jump.force(s, *e, direction));
        hold();
      };
      hold_towards(pairing[s].normal);
      if (!status.contact(s) || !status.friction(s) || (status.holds_friction(s) && !status.stick(s)))
        continue;
      Vector3 friction;
      if (!status.stick(s))
        for (const Vector3 &t : pairing[s].tangent)
          friction += (residual.jump[s] * t) * t;
      for (const Vector3 &t : pairing[s].tangent)
        hold_towards(friction.norm() > 0. ? t - (t * friction) / friction.norm_square() * friction : t);
    }
  }

  FreeMotions::Motion FreeMotions::describe(const Eigen::VectorXd &motion) const
  {
    Motion result;
    for (unsigned int b = 0; b < bodies_.size(); ++b)
    {
      Vector3 part[2]; // translation and rotation
      for (unsigned int i = 0; i < 2 * dim; ++i)
        if (const double value = motion[2 * dim * b + i]; std::abs(value) > noise)
          part[i / dim][i % dim] = value;
      result.moves.emplace_back();
      for (unsigned int c = 0; c < dim; ++c)
        result.moves[b][c] = part[0][c] != 0. || part[1][(c + 1) % dim] != 0. || part[1][(c + 2) % dim] != 0.;
      if (part[0].norm() + part[1].norm() == 0.)
        continue;
      std::string &text = result.text;
      text += (text.empty() ? "" : ", together with ") + std::string("body ") + std::to_string(b + 1) + " (" +
              bodies_.name(b) + ")";
      if (part[0].norm() > 0.)
        text += " moves along " + text_of(part[0] / part[0].norm());
      if (part[1].norm() > 0.)
        text += std::string(part[0].norm() > 0. ? " and" : "") + " turns about " + text_of(part[1] / part[1].norm()) +
                " through " + text_of(centre_[b]);
    }
    return result;
  }

  std::vector<FreeMotions::Motion> FreeMotions::free()
  {
    std::vector<double> sum(held_.data(), held_.data() + held_.size());
    dealii::Utilities::MPI::sum(sum, communicator_of(dof_handler_), sum);
    std::copy(sum.begin(), sum.end(), held_.data());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(held_);
    const int                                            n       = held_.rows();
    const double                                         largest = std::max(spectrum.eigenvalues()[n - 1], 1e-300);
    int                                                  n_free  = 0;
    while (n_free < n && spectrum.eigenvalues()[n_free] < free_fraction * largest)
      ++n_free;

    // The reduced echelon form of the null vectors: one motion each, of as few components as there can be.
    Eigen::MatrixXd motions = spectrum.eigenvectors().leftCols(n_free).transpose();
    int             done    = 0;
    for (int column = 0; column < n && done < n_free; ++column)
    {
      int pivot;
      if (motions.col(column).tail(n_free - done).cwiseAbs().maxCoeff(&pivot) < 1e-3)
        continue;
      motions.row(done).swap(motions.row(done + pivot));
      motions.row(done) /= motions(done, column);
      for (int i = 0; i < n_free; ++i)
        if (i != done)
          motions.row(i) -= motions(i, column) * motions.row(done);
      ++done;
    }
    std::vector<Motion> descriptions;
    for (int i = 0; i < done; ++i)
      descriptions.push_back(describe(motions.row(i)));
    return descriptions;
  }
} // namespace Nodus
