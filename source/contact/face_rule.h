#ifndef nodus_contact_face_rule_h
#define nodus_contact_face_rule_h

#include <nodus/parameters/parameters.h>

#include <deal.II/base/quadrature.h>

namespace Nodus
{
  /// The fixed rule of a pair on slave faces of @p degree, on [0, 1]^2, for the integration point scheme, for
  /// consistent weights and for the averaged scheme by face. Automatic number of points per direction: degree + 1 for
  /// integration points, one more for consistent weights (products of shape functions exact on faces that are not
  /// parallelograms), for the averaged scheme enough to see the master edges inside a slave face; closed rules 2 degree
  /// + 1.
  dealii::Quadrature<2> face_rule(const ContactPairParameters &pair, unsigned int degree);
} // namespace Nodus

#endif
