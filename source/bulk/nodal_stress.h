#ifndef nodus_bulk_nodal_stress_h
#define nodus_bulk_nodal_stress_h

#include "bulk/solid_assembler.h"
#include <nodus/base/types.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <vector>

namespace Nodus
{
  /// Cauchy stress [pressure] and equivalent plastic strain at the displacement nodes: lumped-mass L2 projection, that
  /// is the average of the integration points weighted with the shape functions. The bodies share no nodes, so nothing
  /// is smeared from one body into the other.
  class NodalStress
  {
  public:
    /// @p u has ghost entries. Collective.
    NodalStress(const dealii::DoFHandler<dim> &dof_handler,
                const dealii::Mapping<dim>    &mapping,
                const SolidAssembler          &solid,
                const Vector                  &u);

    /// At the node of a locally relevant degree of freedom, the first of its three.
    dealii::SymmetricTensor<2, dim> stress(DoFIndex first_dof) const;
    bool                            has_plastic_strain() const
    {
      return values_.size() > 2;
    }
    double plastic_strain(const DoFIndex first_dof) const
    {
      return values_[2](first_dof);
    }

  private:
    std::vector<Vector> values_; ///< with ghost entries; three numbers of a node in the places of its displacement
  };
} // namespace Nodus

#endif
