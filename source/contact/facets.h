#ifndef nodus_contact_facets_h
#define nodus_contact_facets_h

#include "contact/contact_geometry.h"

#include <deal.II/fe/mapping.h>

#include <string>
#include <vector>

namespace Nodus
{
  class Bodies;

  /// Sides of contact pairs that are curved but stay facets: cells of a first-order mesh file that are refined or carry
  /// shape functions of degree 2 keep the plane faces of the file, so that smooth bodies touch at the edges of these.
  /// @returns one sentence for each such side. @p geometry: of the first pairing. @p mapping: undeformed. Collective.
  std::vector<std::string> sides_that_stay_facets(const Parameters           &parameters,
                                                  const ContactSurfaces      &surfaces,
                                                  const ContactGeometry      &geometry,
                                                  const Bodies               &bodies,
                                                  const dealii::Mapping<dim> &mapping);
} // namespace Nodus

#endif
