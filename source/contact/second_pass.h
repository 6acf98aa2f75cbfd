#ifndef nodus_contact_second_pass_h
#define nodus_contact_second_pass_h

#include <nodus/parameters/parameters.h>

#include <vector>

namespace Nodus
{
  class ContactSurfaces;

  /// Whether nodes of the master of a pair could be held as well, by a second pass: both sides have meshes that deform,
  /// what is closed may open, there is no second pass yet, and none of these nodes is slave in any pair. Collective.
  bool may_have_second_pass(const Parameters &parameters, const ContactSurfaces &surfaces, unsigned int pair);

  /// The second pass of a pair: its master nodes, of the nodal scheme, may not be deeper than @p clearance [length]
  /// behind its slave faces (eq. V2). Coulomb's friction, which adds up, acts in it as well; any other
  /// acts in the pair alone.
  ContactPairParameters
  second_pass(const std::vector<ContactPairParameters> &pairs, unsigned int pair, double clearance);

  /// Number of the pair in the parameter file, from 0: of a second pass that of its pair.
  unsigned int given_pair(const std::vector<ContactPairParameters> &pairs, unsigned int pair);
} // namespace Nodus

#endif
