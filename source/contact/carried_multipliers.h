#ifndef nodus_contact_carried_multipliers_h
#define nodus_contact_carried_multipliers_h

#include "contact/contact_assembler.h"
#include "contact/interface_state.h"
#include "contact/surface_weights.h"

namespace Nodus
{
  /// What a closed node carries does not vanish where the rim of the master has left it: of the nodes of its faces,
  /// those that are open and have a partner close with its pressure and friction, until their own statuses are tested
  /// (theory section 23). Right at owned nodes; ghosts follow in Status::inherit(). @p pairing is the new one, @p now
  /// and @p state still are those of the last one.
  void hand_on(const ContactSurfaces &surfaces,
               const Pairing         &pairing,
               Status                &status,
               InterfaceState        &now,
               ContactState          &state);

  /// Writes the multipliers @p state of the owned nodes into @p unknowns, in the frames and for the areas of the new
  /// @p pairing and @p weights: forces stay, and friction keeps its size.
  void carry_over(const ContactSurfaces &surfaces,
                  const Pairing         &pairing,
                  const SurfaceWeights  &weights,
                  const InterfaceState  &now,
                  const ContactState    &state,
                  BlockVector           &unknowns);
} // namespace Nodus

#endif
