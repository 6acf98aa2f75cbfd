#ifndef nodus_plugins_error_indicator_h
#define nodus_plugins_error_indicator_h

#include <nodus/base/types.h>
#include <nodus/plugins/plugin.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <vector>

namespace Nodus
{
  /// An indicator of refinement of one's own, in the place of nodus's: where the mesh is to be finer or coarser, from
  /// what a solution has in each cell.
  class ErrorIndicator : public Plugin
  {
  public:
    static constexpr const char *kind = "indicator of refinement";

    /// At a quadrature point of a cell.
    struct QuadraturePoint
    {
      dealii::Tensor<2, dim>          deformation_gradient;      ///< as the law of the material sees it
      dealii::SymmetricTensor<2, dim> cauchy_stress;             ///< [pressure]
      double                          equivalent_plastic_strain; ///< [-]
      double                          stored_energy;             ///< per reference volume
      double                          volume; ///< weight times Jacobian: its part of the reference volume
    };

    /// A cell of a deformable body.
    struct Cell
    {
      Point        centre;           ///< reference position
      double       size;             ///< cubic root of its reference volume [length]
      unsigned int body;             ///< number of the body, from 1
      unsigned int level;            ///< refinements beyond those of its body
      double       youngs_modulus;   ///< of its material [pressure]
      double       contact_pressure; ///< the largest on its slave faces, or opposite its master faces; 0: none
      std::vector<QuadraturePoint> points;
    };

    /// What is wrong in the cell, >= 0, in any unit. With Marking = fixed fraction the cells that hold Refine fraction
    /// of the sum of the squares are refined; with target error they are refined until the root of this sum is below
    /// Target error. Called for cells in any order, and the same on any number of ranks.
    virtual double error(const Cell &cell) const = 0;

    /// Whether the cell is to be refined whatever the errors say, up to Maximum level; no, unless it says otherwise.
    virtual bool refine(const Cell &cell) const;
  };
} // namespace Nodus

/// NODUS_REGISTER_INDICATOR(Neck, "neck", "Plastic strain times the size of the cell.");
#define NODUS_REGISTER_INDICATOR(Class, name, meaning) NODUS_REGISTER(Nodus::ErrorIndicator, Class, name, meaning)

#endif
