#ifndef nodus_contact_initial_overlap_h
#define nodus_contact_initial_overlap_h

#include <nodus/parameters/parameters.h>

#include <nodus/base/types.h>

#include <deal.II/fe/mapping.h>

#include <vector>

namespace Nodus
{
  class Bodies;
  class ContactSurfaces;
  class Pairing;

  /// Refuses bodies that overlap by more than the pair's limit, half a slave face where none is given, at the time @p t
  /// at which the pair begins to act. @p distance of each site, positive inside the master [length]. Collective.
  /// @throws InputError on every rank
  void refuse_overlap(const std::vector<ContactPairParameters> &pairs,
                      const ContactSurfaces                    &surfaces,
                      const Pairing                            &pairing,
                      const std::vector<double>                &distance,
                      double                                    t);

  /// Refuses bodies that overlap so far that pairing does not see it: nodes of a pair that are behind the other surface
  /// by more than the same limit, and in a cell of the other body. @p u: displacement, which @p mapping has, too.
  /// Collective. @throws InputError on every rank
  void refuse_hidden_overlap(const std::vector<ContactPairParameters> &pairs,
                             const ContactSurfaces                    &surfaces,
                             const Bodies                             &bodies,
                             const dealii::Mapping<dim>               &mapping,
                             const Vector                             &u,
                             double                                    t);
} // namespace Nodus

#endif
