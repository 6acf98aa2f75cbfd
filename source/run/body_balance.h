#ifndef nodus_run_body_balance_h
#define nodus_run_body_balance_h

#include "mesh/sides.h"
#include "output/verdict.h"
#include "run/model.h"

namespace Nodus
{
  /// Resultant and moment of the forces that are @p missing at the nodes of a deformable body, relative to the sum of
  /// the forces @p acting on it, which count as no less than @p scale [force], and to its size; of the body where that
  /// is largest. @p u: displacement. The tolerance is left to the caller. Collective.
  Verdict::Finding body_imbalance(const Model      &model,
                                  const OwnedNodes &nodes,
                                  const Vector     &u,
                                  const Vector     &missing,
                                  const Vector     &acting,
                                  double            scale);

  /// What the @p forces at the nodes of driven rigid bodies and coupled faces, and the forces of @p contact in the
  /// sections of bolts, leave to their loads at components that are free; relative likewise. Collective.
  double rigid_body_imbalance(const Model &model, const Vector &forces, const ContactResidual &contact, double scale);
} // namespace Nodus

#endif
