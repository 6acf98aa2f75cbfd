#ifndef nodus_bulk_element_kernel_h
#define nodus_bulk_element_kernel_h

#include "bulk/lanes.h"
#include "bulk/material.h"

#include <deal.II/fe/fe.h>

#include <memory>

namespace Nodus
{
  /// Force and stiffness of hexahedra, total Lagrangian, (degree+1)^3 Gauss points; n_lanes cells at once.
  class ElementKernel
  {
  public:
    /// Reference geometry at a quadrature point.
    struct QuadraturePoint
    {
      Lanes inverse_jacobian[dim][dim]; ///< d(unit coordinate e)/d(X_J) in [e][J]
      Lanes JxW;
    };

    /// States of a law with history, [quadrature point][number]: at the last equilibrium, and where those at hand go.
    struct History
    {
      const Lanes *before;
      Lanes       *after;
    };

    virtual ~ElementKernel() = default;

    /// One entry for each point of the (degree+1)^3 Gauss formula, until the next call. Computed each time: storing
    /// them takes 640 bytes for a cell of degree 1, and reading these about as long. @param X of the nodes, as u below
    virtual const QuadraturePoint *points(const Lanes *X) = 0;

    /// @param points what points() returned
    /// @param u_before that of the previous iterate of Newton's method, for kernels that have unknowns of their own;
    /// null: there is none
    /// @param history not looked at for hyperelastic laws
    /// @param u displacement, @param force int P : Grad phi, both [node][component]
    /// @param stiffness d(force)/du, [node a][node b >= a][component of a][component of b]; not computed when null
    /// @param det_F the smallest of each cell; 1 for small strain. Nothing else is defined when one is not positive.
    /// @param energy stored in each cell; not computed when null, never together with @p stiffness
    virtual void integrate(const QuadraturePoint *points,
                           const Material        &material,
                           const Lanes           *u,
                           const Lanes           *u_before,
                           const History         &history,
                           Lanes                 *force,
                           Lanes                 *stiffness,
                           Lanes                 &det_F,
                           Lanes                 *energy) = 0;

    /// Whether integrate() looks at the previous iterate.
    virtual bool has_own_unknowns() const
    {
      return false;
    }

    struct DeformationGradient
    {
      Lanes F[dim][dim];
    };
    /// The deformation gradients that the law sees at the points.
    virtual void
    deformation(const QuadraturePoint *points, bool small_strain, const Lanes *u, DeformationGradient *F) = 0;

    /// For a displacement element FESystem(FE_Q(degree), 3) with the components of a node next to each other.
    static std::unique_ptr<ElementKernel> make(const dealii::FiniteElement<dim>   &fe,
                                               BodyParameters::VolumetricTreatment treatment);
  };
} // namespace Nodus

#endif
