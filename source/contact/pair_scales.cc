#include "contact/pair_scales.h"
#include "mesh/bodies.h"

#include <algorithm>

namespace Nodus
{
  namespace
  {
    /// Number of the softer body of a pair, of which there is one at least.
    unsigned int softer_body(const ContactPairParameters &pair, const std::vector<double> &stiffness)
    {
      std::vector<unsigned int> bodies = pair.slave.bodies;
      if (!pair.has_rigid_master())
        bodies.insert(bodies.end(), pair.master.bodies.begin(), pair.master.bodies.end());
      return *std::min_element(bodies.begin(),
                               bodies.end(),
                               [&](const unsigned int a, const unsigned int b)
                               { return stiffness[a - 1] < stiffness[b - 1]; });
    }
  } // namespace

  std::vector<double> softer_sides(const std::vector<ContactPairParameters> &pairs,
                                   const std::vector<double>                &stiffness)
  {
    std::vector<double> moduli;
    for (const auto &pair : pairs)
      moduli.push_back(stiffness[softer_body(pair, stiffness) - 1]);
    return moduli;
  }

  std::vector<double> softer_diagonals(const std::vector<ContactPairParameters> &pairs,
                                       const std::vector<double>                &stiffness,
                                       const Bodies                             &bodies)
  {
    std::vector<double> diagonals;
    for (const auto &pair : pairs)
    {
      const auto ends = bodies.bounding_box(softer_body(pair, stiffness) - 1).get_boundary_points();
      diagonals.push_back(ends.first.distance(ends.second));
    }
    return diagonals;
  }
} // namespace Nodus
