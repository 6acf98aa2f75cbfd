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

  /// Largest diagonal of the slave bodies of each pair [length].
  std::vector<double> slave_diagonals(const std::vector<ContactPairParameters> &pairs, const Bodies &bodies);
} // namespace Nodus

#endif
