#ifndef nodus_contact_site_values_h
#define nodus_contact_site_values_h

#include "contact/contact_assembler.h"

#include <vector>

namespace Nodus
{
  /// Contact pressure of every site, 0 where open [pressure]: lambda_bar = (M S lambda)_j / m_j at slave nodes, lambda
  /// interpolated at integration points, open ones too. Collective.
  std::vector<double> site_pressure(const ContactSurfaces     &surfaces,
                                    const SurfaceWeights      &weights,
                                    const Status              &status,
                                    const std::vector<double> &lambda);

  /// What the status tests look at. Friction as the pressure: the weighted friction traction over the weighted
  /// threshold at slave nodes, Lambda interpolated in space at integration points. `Status test = raw` takes the nodal
  /// unknowns. Right at owned sites. Collective.
  StatusInput status_input(const std::vector<ContactPairParameters> &pairs,
                           const ContactSurfaces                    &surfaces,
                           const Pairing                            &pairing,
                           const SurfaceWeights                     &weights,
                           const Status                             &status,
                           const ContactAssembler                   &assembler,
                           const ContactState                       &state);
} // namespace Nodus

#endif
