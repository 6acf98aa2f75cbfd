#include "run/body_balance.h"
#include "parallel/largest.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace Nodus
{
  namespace
  {
    /// Force and moment about a point, in the order in which they are summed over ranks.
    void add_force(double *const sum, const Vector3 &arm, const Vector3 &force)
    {
      const Vector3 moment = dealii::cross_product_3d(arm, force);
      for (unsigned int c = 0; c < dim; ++c)
      {
        sum[c] += force[c];
        sum[dim + c] += moment[c];
      }
    }
  } // namespace

  Verdict::Finding body_imbalance(const Model      &model,
                                  const OwnedNodes &nodes,
                                  const Vector     &u,
                                  const Vector     &missing,
                                  const Vector     &acting,
                                  const double      scale)
  {
    constexpr unsigned int n = 2 * dim + 1; // force, moment, sum of the lengths of what acts
    std::vector<double>    sums(n * model.bodies.size(), 0.);
    std::vector<Point>     middle;
    for (unsigned int b = 0; b < model.bodies.size(); ++b)
      middle.push_back(model.bodies.bounding_box(b).center());
    const double *const at = u.begin(), *const out = missing.begin(), *const in = acting.begin(); // owned values
    for (unsigned int i = 0; i < nodes.X.size(); ++i)
    {
      Vector3 arm = nodes.X[i] - middle[nodes.body[i]], force, acts;
      for (unsigned int c = 0; c < dim; ++c)
      {
        arm[c] += at[dim * i + c];
        force[c] = out[dim * i + c];
        acts[c]  = in[dim * i + c];
      }
      double *const sum = sums.data() + n * nodes.body[i];
      add_force(sum, arm, force);
      sum[2 * dim] += acts.norm();
    }
    dealii::Utilities::MPI::sum(sums, model.communicator, sums);
    Verdict::Finding worst;
    for (unsigned int b = 0; b < model.bodies.size(); ++b)
    {
      const auto          ends  = model.bodies.bounding_box(b).get_boundary_points();
      const double *const sum   = sums.data() + n * b;
      const double        force = std::max(sum[2 * dim], scale), size = ends.first.distance(ends.second);
      worst.raise(std::max(Vector3({sum[0], sum[1], sum[2]}).norm() / force,
                           Vector3({sum[3], sum[4], sum[5]}).norm() / (force * size)),
                  "body " + std::to_string(b + 1));
    }
    return worst;
  }

  double
  rigid_body_imbalance(const Model &model, const Vector &forces, const ContactResidual &contact, const double scale)
  {
    constexpr unsigned int n      = RigidBodies::n_components;
    const RigidBodies     &bodies = model.rigid_bodies;
    std::vector<double>    sums(n * bodies.size(), 0.);
    for (unsigned int b = 0; b < bodies.size(); ++b)
      if (bodies.is_section(b))
        std::copy_n(contact.rigid.begin() + n * b, n, sums.begin() + n * b);
    for (unsigned int b = 0; b < bodies.size(); ++b)
      for (const RigidBodies::Node &node : bodies.nodes(b))
        bodies.add_force(b,
                         bodies.arm(b, node),
                         Vector3({forces(node.dof), forces(node.dof + 1), forces(node.dof + 2)}),
                         sums.data() + n * b);
    dealii::Utilities::MPI::sum(sums, model.communicator, sums);
    Largest worst;
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      double largest = scale;
      for (unsigned int c = 0; c < n; ++c)
      {
        const double lever = c < dim ? 1. : bodies.extent(b);
        largest = std::max({largest, std::abs(bodies.load(b)[c]) / lever, std::abs(sums[n * b + c]) / lever});
      }
      for (unsigned int c = 0; c < n; ++c)
        if (bodies.is_free(b, c))
          worst.add((sums[n * b + c] - bodies.load(b)[c]) / ((c < dim ? 1. : bodies.extent(b)) * largest));
    }
    return worst.on_all_ranks(model.communicator);
  }
} // namespace Nodus
