#ifndef nodus_contact_initial_overlap_h
#define nodus_contact_initial_overlap_h

#include <nodus/parameters/parameters.h>

#include <vector>

namespace Nodus
{
  class ContactSurfaces;
  class Pairing;

  /// Refuses bodies that overlap at the start by more than the pair's limit: half a slave face where none is given.
  /// @p distance of each site, positive inside the master [length]. Collective. @throws InputError on every rank
  void refuse_overlap(const std::vector<ContactPairParameters> &pairs,
                      const ContactSurfaces                    &surfaces,
                      const Pairing                            &pairing,
                      const std::vector<double>                &distance);
} // namespace Nodus

#endif
