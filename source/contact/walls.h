#ifndef nodus_contact_walls_h
#define nodus_contact_walls_h

#include <nodus/base/types.h>

namespace Nodus
{
  class ContactSurfaces;

  /// How far it is from a node to the other side of the wall behind it, at the start [length]: of the nodes of pairs
  /// that touch themselves, in the first component of a displacement-like vector; no more than @p faces mean faces of
  /// the pair. Collective.
  Vector wall_thickness(const ContactSurfaces &surfaces, double faces);
} // namespace Nodus

#endif
