#ifndef nodus_contact_pair_scales_h
#define nodus_contact_pair_scales_h

#include <nodus/parameters/parameters.h>

#include <vector>

namespace Nodus
{
  class Bodies;

  /// Young's modulus of the softer side of each pair [pressure]; @p stiffness: of the bodies.
  std::vector<double> softer_sides(const std::vector<ContactPairParameters> &pairs,
                                   const std::vector<double>                &stiffness);

  /// Diagonal of the box around the body that this is the modulus of [length].
  std::vector<double> softer_diagonals(const std::vector<ContactPairParameters> &pairs,
                                       const std::vector<double>                &stiffness,
                                       const Bodies                             &bodies);
} // namespace Nodus

#endif
