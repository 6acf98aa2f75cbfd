#include "contact/surface_face.h"

namespace Nodus
{
  FaceGeometry::FaceGeometry(const SurfaceFace &face, const FaceShape &shape, const std::vector<Point> &positions)
  {
    for (unsigned int n = 0; n < face.nodes.size(); ++n)
    {
      const Point &p = positions[face.nodes[n]];
      x += shape.value[n] * p;
      d_xi += shape.d_xi[n] * p;
      d_eta += shape.d_eta[n] * p;
    }
  }

  FaceGeometry::FaceGeometry(const FaceShape &shape, const Point *const points)
  {
    for (unsigned int n = 0; n < shape.n; ++n)
    {
      x += shape.value[n] * points[n];
      d_xi += shape.d_xi[n] * points[n];
      d_eta += shape.d_eta[n] * points[n];
    }
  }

  Vector3 FaceGeometry::area_vector() const
  {
    return dealii::cross_product_3d(d_xi, d_eta);
  }
} // namespace Nodus
