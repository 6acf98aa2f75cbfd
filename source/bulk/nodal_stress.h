#ifndef nodus_bulk_nodal_stress_h
#define nodus_bulk_nodal_stress_h

#include "bulk/solid_assembler.h"
#include <nodus/base/types.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <vector>

namespace Nodus
{
  /// What a body has at a place besides its displacement. Strains are those of the deformation that the law sees.
  struct StressAndStrain
  {
    dealii::SymmetricTensor<2, dim> cauchy_stress;         ///< [pressure]
    dealii::SymmetricTensor<2, dim> green_lagrange_strain; ///< [-]
    dealii::SymmetricTensor<2, dim> logarithmic_strain;    ///< ln V [-]
    double                          equivalent_plastic_strain = 0.;
  };

  /// Cauchy stress [pressure], strains if wanted, and equivalent plastic strain at the displacement nodes: lumped-mass
  /// L2 projection, that is the average of the integration points weighted with the shape functions. The bodies share
  /// no nodes, so nothing is smeared from one body into the other.
  class NodalStress
  {
  public:
    /// @p u has ghost entries. Collective.
    NodalStress(const dealii::DoFHandler<dim> &dof_handler,
                const SolidAssembler          &solid,
                const Vector                  &u,
                bool                           with_strains = false);

    /// At the node of a locally relevant degree of freedom, the first of its three.
    dealii::SymmetricTensor<2, dim> stress(const DoFIndex first_dof) const
    {
      return tensor(0, first_dof);
    }
    /// Likewise; zero what was not wanted.
    StressAndStrain at(DoFIndex first_dof) const;

  private:
    dealii::SymmetricTensor<2, dim> tensor(unsigned int number, DoFIndex first_dof) const;

    unsigned int        n_tensors_;
    std::vector<Vector> values_; ///< with ghost entries; three numbers of a node in the places of its displacement
  };

  /// The same of each cell alone, where cells differ in what they have at a node that they share: the polynomial
  /// through the integration points of the cell.
  class CellStress
  {
  public:
    /// @p u has ghost entries.
    CellStress(const dealii::DoFHandler<dim> &dof_handler, const SolidAssembler &solid, const Vector &u);

    /// At node @p j, lexicographic, of a locally owned cell.
    const StressAndStrain &at(const unsigned int active_cell_index, const unsigned int j) const
    {
      return values_[active_cell_index * n_nodes_ + j];
    }

  private:
    unsigned int                 n_nodes_;
    std::vector<StressAndStrain> values_;
  };
} // namespace Nodus

#endif
