#ifndef nodus_bulk_solid_assembler_h
#define nodus_bulk_solid_assembler_h

#include "bulk/boundary_conditions.h"
#include "bulk/material.h"
#include "solve/block_csr_matrix.h"
#include <nodus/base/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <functional>
#include <memory>
#include <vector>

namespace Nodus
{
  struct LinearSystem;

  /// Of the bodies' cells on this rank [energy].
  struct InnerEnergy
  {
    double stored     = 0.; ///< at the quadrature points, without springs
    double dissipated = 0.; ///< by plastic flow so far
    double stiffness  = 0.; ///< Young's modulus times volume
  };

  /// Internal and external forces of the bodies and their tangent, total Lagrangian, full integration
  /// ((degree+1)^3 Gauss points), on the reference configuration. Holds the states of laws with history at these
  /// points: those that the increment starts from, and where the last displacement leads to from there.
  class SolidAssembler
  {
  public:
    /// @p materials holds one law per body, @p treatments likewise, empty: all standard. The references outlive the
    /// assembler.
    SolidAssembler(const dealii::DoFHandler<dim>                          &dof_handler,
                   const dealii::Mapping<dim>                             &mapping,
                   const std::vector<std::unique_ptr<Material>>           &materials,
                   std::vector<BoundaryConditions::Load>                  &loads,
                   const std::vector<BodyParameters::VolumetricTreatment> &treatments = {});

    /// Evaluates the loads. Collective. @throws InputError on every rank where one is not a number.
    void set_time(double t);

    /// Nodal forces at displacement @p u (with ghosts) and time @p t, no constraints applied:
    /// @p internal = int P:Grad phi (plus springs), @p external = loads. Both fully distributed; those of hanging nodes
    /// are given to the nodes that they follow. @p energy: of the states that @p u leads to; null: not computed.
    /// @throws SolverFailure on every rank when det F <= 0 anywhere, with cell centre and body.
    void forces(const Vector &u, double t, Vector &internal, Vector &external, InnerEnergy *energy = nullptr) const;

    /// As forces(), and in the same sweep the tangent K_t = d(internal - external)/du with prescribed displacements
    /// eliminated (a positive diagonal on their rows), and @p rhs = -(internal - external) - K_t b likewise, b the
    /// inhomogeneities of @p constraints. From the second call after start_from() on, that of bodies with
    /// mean dilatation is that of Newton's method with pressures (ElementKernel), equal in the limit. @p tangent has
    /// the sparsity of make_sparsity() and is overwritten.
    void tangent(const Vector                            &u,
                 double                                   t,
                 const dealii::AffineConstraints<double> &constraints,
                 BlockCsrMatrix                          &tangent,
                 Vector                                  &rhs,
                 Vector                                  &internal,
                 Vector                                  &external) const;
    /// The matrix that the last tangent() gave has been changed: the next call assembles it anew.
    void forget_tangent();
    /// Adds what of the loads' tangent is not symmetric to @p system: Loads::add_variation().
    void
    add_variation(const Vector &u, const dealii::AffineConstraints<double> &constraints, LinearSystem &system) const;

    /// Gives @p tangent its pattern; the last matrix that got one is that of tangent(). Hanging nodes have a diagonal
    /// alone.
    void make_sparsity(BlockCsrMatrix &tangent) const;

    /// States at all points of the mesh at hand, as a value that can be kept.
    struct PointStates;
    using History = std::shared_ptr<const PointStates>;
    /// Those that the increment starts from, and those that the last call of forces() or tangent() led to.
    History start() const;
    History reached() const;
    /// The increment starts from @p history from here on; what the last displacement led to is forgotten.
    void start_from(const History &history);

    /// start() of the locally owned active cells, in the order of the triangulation: [quadrature point][number], empty
    /// for hyperelastic laws.
    std::vector<std::vector<double>> history() const;
    /// Starts from what history() gave. Collective. @throws InputError on every rank when the sizes are not those of
    /// the laws.
    void set_history(const std::vector<std::vector<double>> &history);

    /// At a quadrature point of start().
    struct PointResult
    {
      dealii::Tensor<2, dim>          deformation_gradient; ///< that the law sees
      dealii::SymmetricTensor<2, dim> cauchy_stress;
      double                          equivalent_plastic_strain;
      double                          stored_energy, dissipation; ///< per reference volume
      double                          JxW;                        ///< reference volume
    };
    /// Visits the locally owned cells with what is at their points at displacement @p u (with ghosts) of start(); the
    /// stress is that of the law at the deformation gradient that it sees.
    void visit(const Vector                                                      &u,
               const std::function<void(const dealii::DoFHandler<dim>::active_cell_iterator &cell,
                                        const std::vector<PointResult>                      &points)> &visitor) const;
    /// Energy in the springs of this rank's cells at displacement @p u (with ghosts) and the time of the last forces.
    double spring_energy(const Vector &u) const;
    /// Whether some law has a plastic strain.
    bool has_history() const;

    ~SolidAssembler();

  private:
    struct Scratch;
    std::unique_ptr<Scratch> scratch_;
  };
} // namespace Nodus

#endif
