#include "contact/clipping.h"

namespace Nodus
{
  namespace
  {
    /// Where the edge of @p polygon from corner @p i leaves the half plane of edge @p e of the @p window, or enters it.
    SegmentTrace::Corner crossing(const Polygon     &polygon,
                                  const unsigned int i,
                                  const Polygon     &shadow,
                                  const Polygon     &window,
                                  const unsigned int e)
    {
      SegmentTrace::Corner corner;
      const auto of = [](const Polygon &cell, const unsigned int at) { return cell.origin[at % 4].master[0]; };
      if (polygon.line[i] >= slave_line) // edges of the window meet in its corners
      {
        const unsigned int before = polygon.line[i] - slave_line;
        const auto         at     = of(window, before == (e + 1) % 4 ? before : e);
        corner.kind               = SegmentTrace::Corner::of_slave;
        corner.slave              = {{at, at}};
        return corner;
      }
      corner.kind   = SegmentTrace::Corner::crossing;
      corner.master = {{of(shadow, polygon.line[i]), of(shadow, polygon.line[i] + 1u)}};
      corner.slave  = {{of(window, e), of(window, e + 1)}};
      return corner;
    }
  } // namespace

  Polygon clip(const Polygon &shadow, const Polygon &window)
  {
    Polygon polygon = shadow;
    for (unsigned int e = 0; e < window.n && polygon.n > 0; ++e)
    {
      const Point2 &a = window.corner[e], &b = window.corner[(e + 1) % window.n];
      const auto    inside = [&](const Point2 &p) { return cross(b - a, p - a); };
      Polygon       rest;
      for (unsigned int i = 0; i < polygon.n && rest.n + 2 < rest.corner.size(); ++i)
      {
        const Point2       &p = polygon.corner[i], &q = polygon.corner[(i + 1) % polygon.n];
        const double        s = inside(p), t = inside(q);
        const unsigned char along = t < 0. ? slave_line + e : polygon.line[i];
        if (s >= 0.)
          rest.add(p, polygon.origin[i], s > 0. ? polygon.line[i] : along);
        if ((s > 0. && t < 0.) || (s < 0. && t > 0.))
          rest.add(p + s / (s - t) * (q - p), crossing(polygon, i, shadow, window, e), along);
      }
      polygon = rest;
    }
    polygon.begin_at_extreme();
    return polygon;
  }
} // namespace Nodus
