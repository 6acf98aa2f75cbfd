#include <nodus/contact/surface_face.h>

namespace Nodus
{
  namespace
  {
    void lagrange(const unsigned int degree, const double s, double value[3], double derivative[3])
    {
      if (degree == 1)
      {
        value[0]      = 1 - s;
        value[1]      = s;
        derivative[0] = -1;
        derivative[1] = 1;
      }
      else
      {
        value[0]      = (2 * s - 1) * (s - 1);
        value[1]      = 4 * s * (1 - s);
        value[2]      = s * (2 * s - 1);
        derivative[0] = 4 * s - 3;
        derivative[1] = 4 - 8 * s;
        derivative[2] = 4 * s - 1;
      }
    }
  } // namespace

  FaceShape::FaceShape(const unsigned int degree, const double xi, const double eta)
      : n((degree + 1) * (degree + 1))
  {
    double a[3], da[3], b[3], db[3];
    lagrange(degree, xi, a, da);
    lagrange(degree, eta, b, db);
    for (unsigned int j = 0, k = 0; j <= degree; ++j)
      for (unsigned int i = 0; i <= degree; ++i, ++k)
      {
        value[k] = a[i] * b[j];
        d_xi[k]  = da[i] * b[j];
        d_eta[k] = a[i] * db[j];
      }
  }

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
