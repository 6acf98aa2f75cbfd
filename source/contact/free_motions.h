#ifndef nodus_contact_free_motions_h
#define nodus_contact_free_motions_h

#include "bulk/boundary_conditions.h"
#include "contact/contact_assembler.h"
#include "mesh/bodies.h"
#include "rigid/rigid_bodies.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

namespace Nodus
{
  /// Displacement nodes of this rank, in the order of their degrees of freedom.
  struct OwnedNodes
  {
    OwnedNodes(const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping);

    std::vector<Point>        X;    ///< reference positions
    std::vector<unsigned int> body; ///< indices
  };

  /// Finds the rigid motions of the bodies, alone or together, that nothing resists (eq. U1): the null vectors of the
  /// sum of the squares of all motions that are held. Bodies count as connected.
  class FreeMotions
  {
  public:
    /// At displacement @p u (fully distributed). The references outlive the object.
    FreeMotions(const Bodies                  &bodies,
                const dealii::DoFHandler<dim> &dof_handler,
                const dealii::Mapping<dim>    &mapping,
                const RigidBodies             &rigid_bodies,
                const OwnedNodes              &nodes,
                const Vector                  &u);

    /// By prescribed displacements; driven rigid bodies by the components that are not free.
    void hold_prescribed(const dealii::AffineConstraints<double> &constraints);
    /// By those of the loads that act at @p time. Collective.
    void hold_springs(const std::vector<BoundaryConditions::Load> &loads, double time);
    /// By closed sites. Those that slip hold their normal direction and the tangential one across the friction force.
    /// @p as_closed: open sites with a master point hold their normal direction, too. Collective.
    void hold_contact(const ContactSurfaces &surfaces,
                      const Pairing         &pairing,
                      const JumpOperator    &jump,
                      const Status          &status,
                      const ContactState    &state,
                      const ContactResidual &residual,
                      bool                   as_closed = false);

    struct Motion
    {
      std::string                        text;  ///< e.g. "body 2 (ball) moves along (1 0 0)"
      std::vector<std::array<bool, dim>> moves; ///< by body: components that some point of it moves in
    };
    /// Collective.
    std::vector<Motion> free();

  private:
    /// Adds @p direction, times a weight, at @p x of a body to the motion that is held next.
    void   take(unsigned int body, const Point &x, const Vector3 &direction);
    void   hold();
    void   hold(DoFIndex dof);
    Point  position(const PointInCell &place) const;
    Motion describe(const Eigen::VectorXd &motion) const;

    const Bodies                  &bodies_;
    const dealii::DoFHandler<dim> &dof_handler_;
    const dealii::Mapping<dim>    &mapping_;
    const RigidBodies             &rigid_bodies_;
    const OwnedNodes              &nodes_;
    std::vector<Point>             x_;      ///< current positions of the nodes
    std::vector<Point>             centre_; ///< of the bodies
    std::vector<double>            size_;
    Eigen::VectorXd                row_;  ///< translation and rotation (times the size) of each body
    Eigen::MatrixXd                held_; ///< sum of row row^T
  };
} // namespace Nodus

#endif
