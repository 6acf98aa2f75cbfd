#ifndef nodus_contact_initial_ties_h
#define nodus_contact_initial_ties_h

#include <nodus/parameters/parameters.h>

#include <string>
#include <vector>

namespace Nodus
{
  class ContactSurfaces;
  class Pairing;
  class Status;

  /// Sites of tied pairs that begin to act at time @p t open, and stay open: a sentence on each pair that has such,
  /// with their number, the first of them and how far it is from the master. @p distance of each site, positive inside
  /// the master [length]. Collective. @throws InputError on every rank where a tied pair has no tied site.
  std::vector<std::string> describe_untied(const std::vector<ContactPairParameters> &pairs,
                                           const ContactSurfaces                    &surfaces,
                                           const Pairing                            &pairing,
                                           const Status                             &status,
                                           const std::vector<double>                &distance,
                                           double                                    t);
} // namespace Nodus

#endif
