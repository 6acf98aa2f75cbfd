#ifndef nodus_bulk_check_material_h
#define nodus_bulk_check_material_h

#include "base/law_check.h"
#include "bulk/material.h"

#include <vector>

namespace Nodus
{
  /// Compares, at a fixed set of deformation gradients and for laws with history in a second step, the stress with the
  /// derivative of the stored energy at the state that was reached, relative to the stress (or to a hundredth of
  /// Young's modulus); the tangent with differences of the stress, relative to it; the stress with that of the rotated
  /// deformation, which is the same; and stress and energy at rest with zero. Deformations that the law has no finite
  /// answer for are left out.
  std::vector<LawCheck> check_material(Material &material);
} // namespace Nodus

#endif
