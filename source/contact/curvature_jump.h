#ifndef nodus_contact_curvature_jump_h
#define nodus_contact_curvature_jump_h

#include <nodus/base/types.h>

#include <vector>

namespace Nodus
{
  /// What a face of degree 1 has at a node, in the reference configuration.
  struct FaceAtNode
  {
    Vector3 normal; ///< outward unit normal at the node
    double  weight; ///< in the averaged normal (eq. P1)
    /// Normal that the face would have at the node, were it bilinear, from that in the middle of the face and the
    /// averaged ones of its other corners (eq. P7); zero: not known
    Vector3 seen;
    double  turn;   ///< length of the difference between that and the normal in the middle
    bool    inside; ///< whether the corner across is not on the rim of the surface, where averages are one-sided
  };

  /// Unit vector of the average of the normals around a node, as the face with the normal @p own sees it (eq. P1, P6).
  Vector3 averaged_normal(const std::vector<FaceAtNode> &faces, const Vector3 &own);

  /// The share of each face in the averaged normal of a node (eq. P7): 1, and less on the more curved side where the
  /// curvature jumps, as at the edge of a fillet, so that the average is the normal that both sides see there.
  ///
  /// @p rim: zero inside of the surface; on its rim the direction along it, in which alone normals can be compared; of
  /// any length.
  std::vector<double> normal_shares(const std::vector<FaceAtNode> &faces, const Vector3 &rim);
} // namespace Nodus

#endif
