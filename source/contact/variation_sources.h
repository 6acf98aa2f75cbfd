#ifndef nodus_contact_variation_sources_h
#define nodus_contact_variation_sources_h

#include "contact/contact_geometry.h"

#include <array>
#include <unordered_map>
#include <vector>

namespace Nodus
{
  /// What variations are expressed in: the positions of the surface nodes and, numbered behind these, the parts of the
  /// offsets of smoothed faces (SurfaceGeometry::offset_functions). The latter stand for many nodes, and are replaced
  /// by these when all that depends on them has been summed.
  class VariationSources
  {
  public:
    static constexpr unsigned int n_parts = 8;

    VariationSources(const ContactSurfaces &surfaces, const ContactGeometry &geometry);

    bool is_node(const unsigned int source) const
    {
      return source < n_nodes_;
    }
    unsigned int size() const
    {
      return size_;
    }
    unsigned int part(unsigned int pair, bool master, unsigned int face, unsigned int part) const
    {
      return first_[2 * pair + master] + n_parts * face + part;
    }
    /// Parts of a face that can move: none where it is not smoothed, those of the corners where some of these hang.
    static unsigned int n_moving(const SurfaceGeometry &surface, const unsigned int face)
    {
      return !surface.smoothed() ? 0 : surface.face(face).hanging.empty() ? n_parts / 2 : n_parts;
    }
    /// Of a part, with respect to the nodes.
    const std::vector<NodeDerivative> &derivative(unsigned int source) const;

  private:
    const ContactGeometry                                                &geometry_;
    unsigned int                                                          n_nodes_, size_;
    std::vector<unsigned int>                                             first_; ///< of each pair, slave and master
    mutable std::unordered_map<unsigned int, std::vector<NodeDerivative>> cache_;
  };

  /// Second derivatives of the face shape functions.
  struct FaceCurvature
  {
    std::array<std::array<double, 9>, 3> value{}; ///< xi xi, xi eta, eta eta
    FaceCurvature(unsigned int degree, double xi, double eta);
    /// Of the position that these points span, by alpha + beta.
    std::array<Vector3, 3> of(const Point *points, unsigned int n) const;
  };

  /// How the local coordinates of a closest point on a smoothed or plain master face follow the point that is projected
  /// and the face; zero where they are held at an edge.
  struct ProjectionGradient
  {
    ProjectionGradient(const SurfaceGeometry &master, const Projection &projection, const Point &p);

    Vector3 point[2]; ///< with respect to p
    Vector3 node[2][9], part[2][VariationSources::n_parts];
  };
} // namespace Nodus

#endif
