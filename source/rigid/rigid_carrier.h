#ifndef nodus_rigid_rigid_carrier_h
#define nodus_rigid_rigid_carrier_h

#include "mesh/bodies.h"
#include "rigid/prescribed_motion.h"

#include <deal.II/dofs/dof_handler.h>

#include <array>
#include <vector>

namespace Nodus
{
  /// Four nodes of a rigid body, not in a plane, that carry a surface in closed form: whatever moves with the body is a
  /// combination of them, of weights with sum 1. So contact with the surface couples to the body like that with a mesh.
  class RigidCarrier
  {
  public:
    static constexpr unsigned int n_nodes = dim + 1;
    using Weights                         = std::array<double, n_nodes>;

    /// Vertices of the coarse mesh of @p body (index), far from each other; the same on all ranks. Collective.
    RigidCarrier(const Bodies &bodies, unsigned int body, const dealii::DoFHandler<dim> &dof_handler);

    /// First degree of freedom and reference position of a node.
    DoFIndex dof(const unsigned int i) const
    {
      return dofs_[i];
    }
    const Point &X(const unsigned int i) const
    {
      return X_[i];
    }
    /// Their places in an array of nodes, once it is made.
    void set_nodes(const std::array<unsigned int, n_nodes> &nodes)
    {
      nodes_ = nodes;
    }
    const std::array<unsigned int, n_nodes> &nodes() const
    {
      return nodes_;
    }

    /// The body is where its nodes are in the array @p x.
    void             place(const std::vector<Point> &x);
    const Placement &placement() const
    {
      return placement_;
    }
    /// Of the point of the body that is at @p x now.
    Weights weights(const Point &x) const;
    /// How they change with @p x [1/length].
    const std::array<Vector3, n_nodes> &gradients() const
    {
      return gradients_;
    }

  private:
    std::array<DoFIndex, n_nodes>     dofs_{};
    std::array<Point, n_nodes>        X_;
    std::array<unsigned int, n_nodes> nodes_{};
    std::array<Vector3, n_nodes>      reference_gradients_, gradients_;
    Placement                         placement_;
  };
} // namespace Nodus

#endif
