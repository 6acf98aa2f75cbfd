#ifndef nodus_contact_flat_face_h
#define nodus_contact_flat_face_h

#include "contact/clipping.h"
#include "contact/face_powers.h"

#include <cmath>

namespace Nodus
{
  /// A face as the plane sees it.
  class FlatFace
  {
  public:
    /// @param node called as node(n) for the (degree + 1)^2 positions of the face
    template <typename Node>
    FlatFace(const unsigned int degree, const CellPlane &plane, const Node &node)
        : face_(degree,
                [&](const unsigned int n)
                {
                  const Vector3 r = node(n) - plane.origin;
                  return Vector3({r * plane.axis[0], r * plane.axis[1], r * plane.normal});
                })
    {
    }

    /// Finds the local coordinates of @p p by Newton's method from what is given; false where there are none.
    bool invert(const Point2 &p, double &xi, double &eta) const
    {
      return face_.degree() == 1 ? invert<1>(p, xi, eta) : invert<2>(p, xi, eta);
    }
    /// Area in the plane over that in local coordinates.
    double area(const double xi, const double eta) const
    {
      const FacePowers::Tangents t = face_.tangents(xi, eta);
      return std::abs(cross(t.d_xi, t.d_eta));
    }
    struct Place
    {
      Point2 x;      ///< in the plane
      double height; ///< over it
    };
    Place place(const double xi, const double eta) const
    {
      const FacePowers::Tangents t = face_.tangents(xi, eta);
      return {Point2(t.x[0], t.x[1]), t.x[2]};
    }

  private:
    using Values = FacePowers::Values; // coordinates in the plane, height over it

    static double cross(const Values &a, const Values &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }

    template <unsigned int degree>
    bool invert(const Point2 &p, double &xi, double &eta) const
    {
      const Values to{p[0], p[1], 0., 0.};
      for (unsigned int iteration = 0; iteration < 20; ++iteration)
      {
        const FacePowers::Tangents t       = face_.tangents<degree>(xi, eta);
        const Values               r       = to - t.x;
        const double               inverse = 1. / cross(t.d_xi, t.d_eta);
        const double               step_xi = inverse * cross(r, t.d_eta), step_eta = inverse * cross(t.d_xi, r);
        xi += step_xi;
        eta += step_eta;
        if (!(std::abs(xi) + std::abs(eta) < 10.))
          return false;
        if (std::abs(step_xi) + std::abs(step_eta) < 1e-8) // its square is what is left
          return true;
      }
      return false;
    }

    FacePowers face_;
  };
} // namespace Nodus

#endif
