#ifndef nodus_contact_master_normal_h
#define nodus_contact_master_normal_h

#include "contact/variation_sources.h"

#include <array>
#include <vector>

namespace Nodus
{
  /// The normal of a meshed master, averaged or of its facets, as sites take it, and how it varies (eqs. P5, G6).
  class MasterNormal
  {
  public:
    /// @p kind: averaged or master_facet. All outlive it.
    MasterNormal(const ContactGeometry        &geometry,
                 const VariationSources       &sources,
                 unsigned int                  pair,
                 ContactPairParameters::Normal kind);

    /// Unit, from slave to master.
    Vector3 at(unsigned int face, double xi, double eta) const;
    /// Derivatives with respect to the local coordinates.
    std::array<Vector3, 2> slopes(const Projection &point) const;
    /// Derivatives with respect to the sources, at fixed local coordinates.
    std::vector<NodeDerivative> derivative(const Projection &point) const;

  private:
    void add_facet(const Projection &point, double averaged_part, std::vector<NodeDerivative> &derivative) const;

    const SurfaceGeometry  &surface_;
    const MasterSearch     &search_;
    const VariationSources &sources_;
    const unsigned int      pair_;
    const bool              averaged_;
  };
} // namespace Nodus

#endif
