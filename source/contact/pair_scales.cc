#include "contact/pair_scales.h"
#include "mesh/bodies.h"

#include <algorithm>
#include <limits>

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

  double slave_over_master(const Parameters &parameters, const unsigned int pair, const std::vector<double> &stiffness)
  {
    const ContactPairParameters &keys = parameters.contact_pairs[pair];
    if (keys.self_contact || keys.has_rigid_master())
      return 0.;
    double slave = std::numeric_limits<double>::max(), master = 0.;
    for (const unsigned int body : keys.slave.bodies)
      slave = std::min(slave, parameters.bodies[body - 1].rigid ? 0. : stiffness[body - 1]);
    for (const unsigned int body : keys.master.bodies)
      master = parameters.bodies[body - 1].rigid ? std::numeric_limits<double>::infinity()
                                                 : std::max(master, stiffness[body - 1]);
    return slave / master;
  }
} // namespace Nodus
