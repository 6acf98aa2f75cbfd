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

  /// A master that is so many times softer than its slave cannot follow each node of it: of thirteen random cases that
  /// stop with such slaves seven finish once the two sides are exchanged (contrib/studies/robustness).
  constexpr double much_stiffer = 10.;

  /// How many times the slave of a pair is as stiff as its master: the softest body of the one over the stiffest of the
  /// other; 0 where one of them is rigid, or bodies may be either (self contact). @p stiffness: of the bodies
  /// [pressure].
  double slave_over_master(const Parameters &parameters, unsigned int pair, const std::vector<double> &stiffness);
} // namespace Nodus

#endif
