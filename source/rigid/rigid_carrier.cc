#include "rigid/rigid_carrier.h"
#include "base/deal_ii_versions.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>

namespace Nodus
{
  namespace
  {
    /// Of the points on: the farthest from the first one, from the line of two, from the plane of three.
    double distance(const Point &x, const std::vector<Point> &from)
    {
      Vector3 d = x - from[0];
      if (from.size() == 1)
        return d.norm();
      const Vector3 a = from[1] - from[0];
      if (from.size() == 2)
        return dealii::cross_product_3d(a, d).norm() / a.norm();
      const Vector3 n = dealii::cross_product_3d(a, from[2] - from[0]);
      return std::abs(n * d) / n.norm();
    }
  } // namespace

  RigidCarrier::RigidCarrier(const Bodies &bodies, const unsigned int body, const dealii::DoFHandler<dim> &dof_handler)
      : placement_{dealii::unit_symmetric_tensor<dim>(), Vector3()}
  {
    // Every rank holds the coarse mesh, whose vertices never hang.
    std::map<unsigned int, Point> vertices;
    for (const auto &cell : bodies.triangulation().cell_iterators_on_level(0))
      if (cell->material_id() == body)
        for (const unsigned int v : cell->vertex_indices())
          vertices.emplace(cell->vertex_index(v), cell->vertex(v));
    std::vector<Point>                chosen = {vertices.begin()->second};
    std::array<unsigned int, n_nodes> vertex = {{vertices.begin()->first}};
    while (chosen.size() < n_nodes)
    {
      const auto farthest   = std::max_element(vertices.begin(),
                                             vertices.end(),
                                             [&](const auto &a, const auto &b)
                                             { return distance(a.second, chosen) < distance(b.second, chosen); });
      vertex[chosen.size()] = farthest->first;
      chosen.push_back(farthest->second);
    }
    std::copy(chosen.begin(), chosen.end(), X_.begin());

    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && cell->material_id() == body)
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int i = 0; i < n_nodes; ++i)
            if (cell->vertex_index(v) == vertex[i])
              dofs_[i] = cell->vertex_dof_index(v, 0);
    for (DoFIndex &dof : dofs_)
      dof = dealii::Utilities::MPI::max(dof, communicator_of(dof_handler));

    dealii::Tensor<2, dim> edges; // in its rows
    for (unsigned int i = 1; i < n_nodes; ++i)
      edges[i - 1] = X_[i] - X_[0];
    const dealii::Tensor<2, dim> inverse = dealii::invert(edges);
    for (unsigned int i = 1; i < n_nodes; ++i)
      for (unsigned int c = 0; c < dim; ++c)
      {
        reference_gradients_[i][c] = inverse[c][i - 1];
        reference_gradients_[0][c] -= inverse[c][i - 1];
      }
    gradients_ = reference_gradients_;
  }

  void RigidCarrier::place(const std::vector<Point> &x)
  {
    placement_.R = 0.;
    for (unsigned int i = 0; i < n_nodes; ++i)
      placement_.R += dealii::outer_product(Vector3(x[nodes_[i]]), reference_gradients_[i]);
    placement_.s = x[nodes_[0]] - placement_.R * X_[0];
    for (unsigned int i = 0; i < n_nodes; ++i)
      gradients_[i] = placement_.R * reference_gradients_[i];
  }

  RigidCarrier::Weights RigidCarrier::weights(const Point &x) const
  {
    const Vector3 from_first = placement_.from(x) - X_[0];
    Weights       weights;
    for (unsigned int i = 0; i < n_nodes; ++i)
      weights[i] = (i == 0 ? 1. : 0.) + reference_gradients_[i] * from_first;
    return weights;
  }
} // namespace Nodus
