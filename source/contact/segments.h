#ifndef nodus_contact_segments_h
#define nodus_contact_segments_h

#include "contact/contact_geometry.h"

#include <deal.II/base/quadrature.h>

#include <array>
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

  /// The cells of a face that are clipped are the face itself, or the quarters of one of degree 2: node of the face at
  /// a corner of one, corners going round.
  inline unsigned int cell_node(const unsigned int degree, const unsigned int cell, const unsigned int corner)
  {
    const unsigned int n = degree + 1, first = cell % degree + n * (cell / degree);
    return first + (corner == 1 || corner == 2 ? 1 : 0) + (corner >= 2 ? n : 0);
  }

  /// Plane through a cell of a slave face: its outward normal and two axes.
  struct CellPlane
  {
    CellPlane(const std::array<Point, 4> &corner, double orientation);

    Point   origin;
    Vector3 normal, axis[2];

    dealii::Point<2> operator()(const Point &x) const
    {
      return dealii::Point<2>((x - origin) * axis[0], (x - origin) * axis[1]);
    }
  };

  /// Where integration points come from, for their variation: the polygons that the cells have in common, and what
  /// their corners are.
  struct SegmentTrace
  {
    struct Corner
    {
      enum Kind : unsigned char
      {
        of_master,
        of_slave,
        crossing ///< of an edge of the master cell with one of the slave cell
      };
      Kind                         kind = of_master;
      std::array<unsigned char, 2> master{{0, 0}}, slave{{0, 0}}; ///< corner of the cell, or both ends of its edge
    };
    struct Polygon
    {
      unsigned int                     cell, master, master_cell; ///< master: face
      double                           near_rate; ///< of the logarithm of the part, by cell_height() (eq. O3)
      unsigned int                     n;
      std::array<dealii::Point<2>, 16> x; ///< corners in the plane
      std::array<Corner, 16>           corner;
    };
    /// Of each integration point: polygon, last corner of the triangle that fans out from corner 0, point of the rule.
    struct Place
    {
      double        part; ///< that it counts with (eq. J8)
      unsigned int  polygon;
      unsigned char last, q;
    };
    std::vector<Polygon> polygons;
    std::vector<Place>   places;
  };

  /// The middle of a cell.
  inline Vector3 cell_middle(const std::array<Point, 4> &corner)
  {
    return 0.25 * (Vector3(corner[0]) + corner[1] + corner[2] + corner[3]);
  }

  /// How much a master cell counts that looks at a slave cell with this cosine, 1 being straight at it (eq. J8).
  inline Fading facing(const double cosine)
  {
    return Fading(cosine, 0.70710678, 0.25881905);
  }

  /// What the points of a slave face cover.
  struct Coverage
  {
    double fraction = 0.; ///< of the face
    double counted  = 1.; ///< mean part that points count with there
  };

  /// Rule on the triangles of the overlaps.
  const dealii::Quadrature<2> &segment_rule(unsigned int degree);

  /// Integration points of slave face @p f of a pair on its overlaps with the master faces, seen along the slave
  /// normal: the faces (of degree 2: their four quarters) are projected on the plane of the slave one, clipped as
  /// convex polygons and triangulated (Puso & Laursen 2004). Polynomials of the product of slave and master shape
  /// functions are integrated exactly where both faces are parallelograms. Of several master faces over a place the
  /// nearest one counts and hides the others (eq. J11). Where the surface touches itself, the face has points only
  /// where it is the slave. @p points and @p trace are overwritten.
  Coverage segment_points(const ContactGeometry    &geometry,
                          unsigned int              pair,
                          unsigned int              f,
                          std::vector<MortarPoint> &points,
                          SegmentTrace             &trace);
} // namespace Nodus

#endif
