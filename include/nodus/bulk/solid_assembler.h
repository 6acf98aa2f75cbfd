#ifndef nodus_bulk_solid_assembler_h
#define nodus_bulk_solid_assembler_h

#include <nodus/bulk/boundary_conditions.h>
#include <nodus/bulk/material.h>
#include <nodus/solve/node_matrix.h>
#include <nodus/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <memory>
#include <vector>

namespace Nodus
{
  /// Internal and external forces of the bodies and their tangent, total Lagrangian, full integration
  /// ((degree+1)^3 Gauss points), on the reference configuration.
  class SolidAssembler
  {
  public:
    /// @p materials holds one law per body; all arguments outlive the assembler.
    SolidAssembler(const dealii::DoFHandler<dim>                &dof_handler,
                   const dealii::Mapping<dim>                   &mapping,
                   const std::vector<std::unique_ptr<Material>> &materials,
                   std::vector<BoundaryConditions::Load>        &loads);

    /// Nodal forces at displacement @p u (with ghosts) and time @p t, no constraints applied:
    /// @p internal = int P:Grad phi (plus springs), @p external = loads. Both fully distributed.
    /// @throws SolverFailure on every rank when det F <= 0 anywhere, with cell centre and body.
    void forces(const Vector &u, double t, Vector &internal, Vector &external) const;

    /// As forces(), and in the same sweep the tangent K_t = d(internal - external)/du with prescribed displacements
    /// eliminated (a positive diagonal on their rows), and @p rhs = -(internal - external) - K_t b likewise, b the
    /// inhomogeneities of @p constraints. @p tangent has the sparsity of make_sparsity() and is overwritten.
    void tangent(const Vector                            &u,
                 double                                   t,
                 const dealii::AffineConstraints<double> &constraints,
                 NodeMatrix                              &tangent,
                 Vector                                  &rhs,
                 Vector                                  &internal,
                 Vector                                  &external) const;

    /// Gives @p tangent its pattern; the last matrix that got one is that of tangent(). Meshes with hanging nodes are
    /// not supported.
    void make_sparsity(NodeMatrix &tangent) const;

    ~SolidAssembler();

  private:
    struct Scratch;
    std::unique_ptr<Scratch> scratch_;
  };
} // namespace Nodus

#endif
