#ifndef nodus_contact_loci_h
#define nodus_contact_loci_h

#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <string>
#include <vector>

namespace Nodus
{
  class ContactSurfaces;

  /// Where the first @p n of the @p sites of all ranks are, in words; each rank names sites that it owns. Collective.
  std::vector<std::string> loci(const std::vector<ContactPairParameters> &pairs,
                                const ContactSurfaces                    &surfaces,
                                const std::vector<unsigned int>          &sites,
                                unsigned int                              n);

  /// Largest difference of two displacements at a node of the surfaces [length], and where it is. Collective.
  double
  largest_difference(const ContactSurfaces &surfaces, const Vector &a, const Vector &b, std::string *worst = nullptr);
} // namespace Nodus

#endif
