#ifndef nodus_run_norm_scales_h
#define nodus_run_norm_scales_h

#include "run/model.h"

namespace Nodus
{
  /// What displacements and forces are relative to in the norms, at least (eqs. N3 and N4): the displacement since the
  /// start of the increment, and what round-off leaves to be resolved to the tolerance of Newton (1e-8).
  struct NormScales
  {
    /// Of displacements @p u, which were @p start; @p stiffness: largest diagonal entry of the first bulk tangent
    /// [force/length]. Collective.
    NormScales(const Model &model, const Vector &u, const Vector &start, double stiffness);

    double length; ///< [length]
    double noise;  ///< of forces, from displacements as large as these and from strains [force]
    double force;  ///< [force]
  };
} // namespace Nodus

#endif
