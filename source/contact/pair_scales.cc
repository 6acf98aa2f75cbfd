#include "contact/pair_scales.h"
#include "mesh/bodies.h"

#include <algorithm>
#include <limits>

namespace Nodus
{
  std::vector<double> softer_sides(const std::vector<ContactPairParameters> &pairs,
                                   const std::vector<double>                &stiffness)
  {
    std::vector<double> softer;
    for (const auto &pair : pairs)
    {
      softer.push_back(std::numeric_limits<double>::max());
      for (const RegionParameters *const side : {&pair.slave, &pair.master})
        for (const unsigned int body : side->bodies)
          if (side == &pair.slave || !pair.has_rigid_master())
            softer.back() = std::min(softer.back(), stiffness[body - 1]);
    }
    return softer;
  }

  std::vector<double> slave_diagonals(const std::vector<ContactPairParameters> &pairs, const Bodies &bodies)
  {
    std::vector<double> diagonals;
    for (const auto &pair : pairs)
    {
      diagonals.push_back(0.);
      for (const unsigned int body : pair.slave.bodies)
      {
        const auto ends  = bodies.bounding_box(body - 1).get_boundary_points();
        diagonals.back() = std::max(diagonals.back(), ends.first.distance(ends.second));
      }
    }
    return diagonals;
  }
} // namespace Nodus
