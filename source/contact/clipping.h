#ifndef nodus_contact_clipping_h
#define nodus_contact_clipping_h

#include "contact/segments.h"

#include <algorithm>
#include <array>

namespace Nodus
{
  using Point2 = dealii::Point<2>;

  inline double cross(const dealii::Tensor<1, 2> &a, const dealii::Tensor<1, 2> &b)
  {
    return a[0] * b[1] - a[1] * b[0];
  }

  /// A convex polygon; two quadrilaterals overlap in at most eight corners.
  struct Polygon
  {
    using Corner = SegmentTrace::Corner;

    std::array<Point2, 16>        corner;
    std::array<Corner, 16>        origin;
    std::array<unsigned char, 16> line; ///< that the edge to the next corner lies on: of the master, slave_line +
                                        ///< that of the slave
    unsigned int n = 0;

    void add(const Point2 &p, const Corner &what, const unsigned char along)
    {
      corner[n] = p;
      origin[n] = what;
      line[n++] = along;
    }
    double area() const
    {
      double twice = 0.;
      for (unsigned int i = 2; i < n; ++i)
        twice += cross(corner[i - 1] - corner[0], corner[i] - corner[0]);
      return 0.5 * twice;
    }
    Point2 centre() const
    {
      Point2 sum;
      for (unsigned int i = 0; i < n; ++i)
        sum += corner[i] / n;
      return sum;
    }
    bool contains(const Point2 &p) const
    {
      for (unsigned int i = 0, before = n - 1; i < n; before = i++)
        if (cross(corner[i] - corner[before], p - corner[before]) < 0.)
          return false;
      return true;
    }
    /// Triangles fan out from corner 0. What rules of integration leave depends on which it is: it is to stay the
    /// same where a corner splits in two, or the integrals would jump. The farthest one in a direction that edges
    /// hardly ever lie across does.
    void begin_at_extreme()
    {
      const auto   along = [](const Point2 &p) { return 0.854 * p[0] + 0.520 * p[1]; };
      unsigned int first = 0;
      for (unsigned int i = 1; i < n; ++i)
        if (along(corner[i]) > along(corner[first]))
          first = i;
      if (first == 0)
        return;
      const Polygon before = *this;
      for (unsigned int i = 0; i < n; ++i, ++first)
      {
        if (first == n)
          first = 0;
        corner[i] = before.corner[first];
        origin[i] = before.origin[first];
        line[i]   = before.line[first];
      }
    }
    void make_counterclockwise()
    {
      if (area() >= 0.)
        return;
      std::reverse(corner.begin(), corner.begin() + n);
      std::reverse(origin.begin(), origin.begin() + n);
    }
  };
  inline constexpr unsigned char slave_line = 4;

  /// A cell as the plane sees it, counterclockwise, and its bounding box.
  struct Shadow
  {
    Polygon polygon;
    Point2  low, high;

    Shadow(const std::array<Point, 4> &corner, const CellPlane &plane)
        : low(plane(corner[0]))
        , high(low)
    {
      for (unsigned char i = 0; i < corner.size(); ++i)
      {
        const Point2 p = plane(corner[i]);
        polygon.add(p, {Polygon::Corner::of_master, {{i, i}}, {{i, i}}}, i);
        for (unsigned int c = 0; c < 2; ++c)
        {
          low[c]  = std::min(low[c], p[c]);
          high[c] = std::max(high[c], p[c]);
        }
      }
      polygon.make_counterclockwise();
    }
    bool apart(const Shadow &other) const
    {
      return low[0] > other.high[0] || high[0] < other.low[0] || low[1] > other.high[1] || high[1] < other.low[1];
    }
  };

  /// The part of @p shadow inside the convex @p window (Sutherland & Hodgman 1974).
  Polygon clip(const Polygon &shadow, const Polygon &window);
} // namespace Nodus

#endif
