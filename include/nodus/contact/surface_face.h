#ifndef nodus_contact_surface_face_h
#define nodus_contact_surface_face_h

#include <nodus/types.h>

#include <array>
#include <vector>

namespace Nodus
{
  /// A face with (degree+1)^2 nodes, lexicographic in its local coordinates (xi, eta) in [0, 1]^2.
  struct SurfaceFace
  {
    std::vector<unsigned int> nodes;       ///< indices into ContactSurfaces::nodes()
    double                    orientation; ///< +1 when x_xi x x_eta points out of the body, -1 otherwise
    unsigned int              owner;       ///< rank of the cell
    unsigned int              number = 0;  ///< in its pair and side on all ranks
  };

  /// Values and derivatives of the face shape functions at one point.
  struct FaceShape
  {
    unsigned int          n; ///< (degree+1)^2
    std::array<double, 9> value, d_xi, d_eta;
    FaceShape(unsigned int degree, double xi, double eta);
  };

  /// Position and tangents of a face at a shape point.
  struct FaceGeometry
  {
    Point   x;
    Vector3 d_xi, d_eta;
    FaceGeometry(const SurfaceFace &face, const FaceShape &shape, const std::vector<Point> &positions);
    /// @p points: as many positions as the shape has functions.
    FaceGeometry(const FaceShape &shape, const Point *points);
    /// x_xi x x_eta, length = surface element.
    Vector3 area_vector() const;
  };
} // namespace Nodus

#endif
