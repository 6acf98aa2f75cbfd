#ifndef nodus_bulk_mean_dilatation_kernel_h
#define nodus_bulk_mean_dilatation_kernel_h

#include "bulk/element_kernel.h"

namespace Nodus
{
  /// Displacement, pressure p and dilatation theta with discontinuous p and theta, which are eliminated in the cell:
  /// constant for degree 1 (Q1P0: Simo, Taylor & Pister, Comput. Methods Appl. Mech. Eng. 51, 1985), linear in the unit
  /// coordinates for degree 2. The law sees Fbar = (theta/J)^1/3 F; the functional (eqs. B10 and B11)
  ///   int W(Fbar) + p (J - theta) dV
  /// makes theta the L2 projection of J, and p that of dW/dtheta = tr(tau)/(3 theta), in each cell. What is left is a
  /// function of the displacement alone: the stiffness is its second derivative, symmetric for every law. In the course
  /// of Newton's method, that is with a previous iterate, the stiffness has the pressure that the method would have for
  /// all three fields, which then converges from much further: the pressure at the dilatation linearised about that
  /// iterate. Laws of the linearised strain see e + (theta - tr e)/3 I with theta the projection of tr e (B-bar:
  /// Hughes, 1980).
  std::unique_ptr<ElementKernel> make_mean_dilatation_kernel(const dealii::FiniteElement<dim> &fe);
} // namespace Nodus

#endif
