#ifndef nodus_bulk_stress_error_h
#define nodus_bulk_stress_error_h

#include "bulk/material.h"
#include "bulk/nodal_stress.h"
#include "mesh/refinement.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// Adds to @p indicator @p weight times the squared difference between the stress and the one recovered at the nodes,
  /// int |sigma - sigma*|^2/E dV of each owned cell, and sets the squared norm int |sigma|^2/E dV of all (eq. A1;
  /// Zienkiewicz & Zhu 1987). @p u has ghost entries. Collective.
  void add_stress_error(double                                        weight,
                        const dealii::DoFHandler<dim>                &dof_handler,
                        const SolidAssembler                         &solid,
                        const std::vector<std::unique_ptr<Material>> &materials,
                        const Vector                                 &u,
                        const NodalStress                            &stress,
                        RefinementIndicator                          &indicator);
} // namespace Nodus

#endif
