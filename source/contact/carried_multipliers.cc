#include "contact/carried_multipliers.h"

#include <cmath>
#include <vector>

namespace Nodus
{
  void hand_on(
      const ContactSurfaces &surfaces, const Pairing &pairing, Status &status, InterfaceState &now, ContactState &state)
  {
    const std::vector<char> closed = now.statuses.contact;
    std::vector<double>     taken(surfaces.n_owned_slave_nodes(), 0.);
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
      for (const SurfaceFace &face : surfaces.slave_faces(p))
        for (const unsigned int giver : face.slaves)
        {
          if (!closed[giver] || pairing[giver].found)
            continue;
          for (const unsigned int k : face.slaves)
          {
            if (!surfaces.is_owned(k) || closed[k] || !pairing[k].found || state.lambda[giver] >= taken[k])
              continue;
            status.take_over(k, giver);
            taken[k] = state.lambda[k] = state.lambda[giver];
            state.Lambda[k]            = state.Lambda[giver];
            now.tangents[k]            = now.tangents[giver];
            now.area[k]                = 0.; // a pressure
          }
        }
  }

  void carry_over(const ContactSurfaces &surfaces,
                  const Pairing         &pairing,
                  const SurfaceWeights  &weights,
                  const InterfaceState  &now,
                  const ContactState    &state,
                  BlockVector           &unknowns)
  {
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
    {
      const DoFIndex multiplier = surfaces.multiplier(k);
      Vector3        Lambda;
      for (unsigned int i = 0; i < 2; ++i)
        Lambda += state.Lambda[k][i] * now.tangents[k][i];
      double component[2] = {0., 0.};
      for (unsigned int i = 0; i < 2; ++i)
        if (pairing[k].found && pairing[k].tangent_free[i])
          component[i] = Lambda * pairing[k].tangent[i];
      const double norm = std::hypot(component[0], component[1]);
      for (unsigned int i = 0; i < 2; ++i)
        unknowns.block(2)(2 * multiplier + i) = norm > 0. ? component[i] * Lambda.norm() / norm : 0.;
      const double ratio            = now.area[k] > 0. ? now.area[k] / weights.area()[k] : 1.;
      unknowns.block(1)(multiplier) = pairing[k].found ? state.lambda[k] * ratio : 0.;
    }
  }
} // namespace Nodus
