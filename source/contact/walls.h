#ifndef nodus_contact_walls_h
#define nodus_contact_walls_h

#include <nodus/base/types.h>

namespace Nodus
{
  class ContactSurfaces;

  /// How many cells as thick as the one behind a node there are from there to the other side of the wall, at the start:
  /// of the nodes of pairs that touch themselves, in the first component of a displacement-like vector; no less than 1,
  /// and no more than it takes to reach @p faces mean faces of the pair. Collective.
  Vector cells_through_walls(const ContactSurfaces &surfaces, double faces);
} // namespace Nodus

#endif
