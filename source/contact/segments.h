#ifndef nodus_contact_segments_h
#define nodus_contact_segments_h

#include "contact/contact_geometry.h"

#include <vector>

namespace Nodus
{
  /// A point of a slave face with its master partner.
  struct MortarPoint
  {
    double     xi, eta; ///< on the slave face
    double     weight;  ///< on [0, 1]^2 of the slave face: area = weight |x_xi x x_eta|
    Projection master;
  };

  /// Integration points of slave face @p f on its overlaps with the master faces, seen along the slave normal: the
  /// faces (of degree 2: their four quarters) are projected on the plane of the slave one, clipped as convex polygons
  /// and triangulated (Puso & Laursen 2004). Polynomials of the product of slave and master shape functions are
  /// integrated exactly where both faces are parallelograms. Returns the covered fraction of the face; @p points is
  /// overwritten.
  double segment_points(const SurfaceGeometry    &slave,
                        unsigned int              f,
                        const SurfaceGeometry    &master,
                        const MasterSearch       &search,
                        double                    reach,
                        std::vector<MortarPoint> &points);
} // namespace Nodus

#endif
