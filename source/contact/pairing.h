#ifndef nodus_contact_pairing_h
#define nodus_contact_pairing_h

#include "contact/averaged_jump.h"
#include "contact/contact_geometry.h"
#include "contact/surface.h"
#include <nodus/parameters/parameters.h>

#include <array>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Where a contact site meets the master surface, frozen within a geometry pass.
  struct SitePairing
  {
    bool       found = false; ///< a master partner within reach, and a normal motion that the constraints leave free
    bool       held = false; ///< a master partner, but no normal motion that the constraints leave free: no contact law
    Projection master;       ///< of the site itself; an averaged jump may have a partner without it
    Vector3    normal;       ///< unit, from slave to master
    std::array<Vector3, 2> tangent;                      ///< unit, with the normal a right-handed frame
    std::array<bool, 2>    tangent_free{{false, false}}; ///< void directions carry no friction multiplier
    std::array<double, 2>  friction_scale{{1., 1.}};     ///< limit of friction along the tangents over the first one
  };

  /// Projections of this rank's contact sites, and frames of these and of the ghosts.
  class Pairing
  {
  public:
    /// Projects all sites; frames are restricted to the relative motion that the constraints leave free. Nodes of the
    /// averaged scheme have a partner where @p averaged covers them, sites of pairs that do not act have none. Each
    /// rank projects the sites it owns and passes their frames on; a ghost has its master point where the face is here.
    /// Collective.
    ///
    /// A site that has a partner keeps it up to twice the projection tolerance: where contact itself moves a node
    /// across the limit, there would be no solution otherwise. One that has none gets none where it is beside the
    /// master's end, beyond the rim and below the surface.
    void project(const std::vector<ContactPairParameters> &pairs,
                 const ContactSurfaces                    &surfaces,
                 const ContactGeometry                    &geometry,
                 const AveragedJump                       &averaged);

    /// Which sites have a partner before the next projection; without this, those that the last one found one for.
    void set_partnered(std::vector<char> partnered)
    {
      partnered_ = std::move(partnered);
    }
    const std::vector<char> &partnered() const
    {
      return partnered_;
    }

    const SitePairing &operator[](const unsigned int site) const
    {
      return sites_[site];
    }
    unsigned int size() const
    {
      return sites_.size();
    }

  private:
    void share(const ContactSurfaces &surfaces);

    std::vector<SitePairing> sites_;
    std::vector<char>        partnered_; ///< of the owned sites
  };
} // namespace Nodus

#endif
