// Overlaps of quadrilaterals: areas in closed form, and the corner that their triangles fan out from, which stays where
// it is when edges that lie on each other part by round-off, for what rules of integration leave depends on it.

#include "contact/clipping.h"
#include "../numbers.h"

#include <deal.II/base/numbers.h>

#include <cmath>
#include <iostream>

using namespace Nodus;

namespace
{
  /// Of edge 2, turned and moved, with its first corner at one of four places.
  Polygon square(const double angle, const Point2 &middle, const unsigned int first = 0)
  {
    Polygon result;
    for (unsigned int i = 0; i < 4; ++i)
    {
      const double at = angle + (first + i) * dealii::numbers::PI_2 - 3. * dealii::numbers::PI_4;
      result.add(middle + std::sqrt(2.) * dealii::Tensor<1, 2>({std::cos(at), std::sin(at)}), {}, i);
    }
    return result;
  }

  void area(const std::string &name, const Polygon &shadow, const unsigned int corners, const double exact)
  {
    const Polygon overlap = clip(shadow, square(0., Point2()));
    std::cout << name << ": corners " << overlap.n << " for " << corners << ", area "
              << Numbers::error_below(std::abs(overlap.area() - exact), 1e-14) << std::endl;
  }

  /// Largest way of the corner over all small moves of squares that have edges on lines of the window.
  double way_of_first_corner()
  {
    const Polygon window  = square(0., Point2());
    double        largest = 0.;
    for (const double x : {-1., 0., 1.})
      for (const double y : {-1., 0., 1.})
        for (unsigned int first = 0; first < 4; ++first)
        {
          const Point2 before = clip(square(0., Point2(x, y), first), window).corner[0];
          for (unsigned int direction = 0; direction < 16; ++direction)
            for (const double turn : {-1e-9, 0., 1e-9})
            {
              const double  at = (direction + 0.5) * dealii::numbers::PI / 8.;
              const Point2  moved(x + 1e-9 * std::cos(at), y + 1e-9 * std::sin(at));
              const Polygon overlap = clip(square(turn, moved, first), window);
              largest               = std::max(largest, overlap.corner[0].distance(before));
            }
        }
    return largest;
  }
} // namespace

int main()
{
  area("the same square", square(0., Point2()), 4, 4.);
  area("moved", square(0., Point2(0.5, -0.25)), 4, 1.5 * 1.75);
  area("moved along an edge", square(0., Point2(0.5, 0.)), 4, 3.);
  area("turned by 45 degrees", square(dealii::numbers::PI_4, Point2()), 8, 8. * (std::sqrt(2.) - 1.));
  area("apart", square(0., Point2(2.5, 0.)), 0, 0.);
  std::cout << "first corner of overlaps when edges part by 1e-9: moves by less than 1e-8: "
            << Numbers::error_below(way_of_first_corner(), 1e-8) << std::endl;
}
