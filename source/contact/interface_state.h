#ifndef nodus_contact_interface_state_h
#define nodus_contact_interface_state_h

#include "contact/status.h"
#include <nodus/base/types.h>

#include <array>
#include <vector>

namespace Nodus
{
  /// What the history of contact is made of, besides the displacements and multipliers: of the sites and slave nodes of
  /// this rank, in the order of ContactSurfaces, ghosts included.
  struct InterfaceState
  {
    Status::State                       statuses;
    std::vector<std::array<Vector3, 2>> tangents; ///< per slave node: the frame that its Lambda refers to
    /// Per slave node, in space and in the scale of the slip (eq. F4), as the increment begins [length].
    std::vector<Vector3> elastic_slip;
    /// Per slave node: m_j that its lambda refers to; 0: no partner, or lambda is a pressure [area].
    std::vector<double> area;
    /// As the increment begins, per site and right at owned ones: force on the slave and jump of the displacement.
    std::vector<Vector3> force, jump;

    /// The state has been taken over from another mesh, and no equilibrium has been found on this one.
    bool on_new_mesh = false;
    /// Then, per site: it was closed, and so was all that its state has been interpolated between.
    std::vector<char> stuck;

    /// Per slave node: it had a constraint of its own in the last pairing.
    std::vector<char> constrained() const
    {
      std::vector<char> own(area.size());
      for (unsigned int k = 0; k < own.size(); ++k)
        own[k] = area[k] > 0. || statuses.contact[k];
      return own;
    }
  };
} // namespace Nodus

#endif
