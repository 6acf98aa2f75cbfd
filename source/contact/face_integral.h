#ifndef nodus_contact_face_integral_h
#define nodus_contact_face_integral_h

#include "contact/averaged_jump.h"

#include <boost/serialization/array.hpp>

#include <vector>

namespace Nodus
{
  /// What a slave face adds to the rows of its slave nodes (AveragedJump::Row), before the division by the area.
  struct FaceRows
  {
    static constexpr unsigned int n_vectors = 4 * dim; ///< entries of vectors per slave node

    unsigned int          pair, number; ///< of the face
    std::vector<DoFIndex> slaves;       ///< first degrees of freedom
    std::vector<DoFIndex> nodes;        ///< likewise: nodes of the face, then master nodes
    std::vector<double>   weights;      ///< per slave node: weight of each node, area, full area
    std::vector<double>   vectors;      ///< per slave node: offset, normal, rigid part
    std::array<double, 3> outward = {}; ///< of the face in its middle, unit

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &pair &number &slaves &nodes &weights &vectors &outward;
    }
  };

  /// Slave nodes of a face.
  std::vector<unsigned int> slaves_of(const ContactSurfaces &surfaces, const FaceRows &face);
  /// Whoever owns a node sums over its faces: sends @p mine to all that own a slave node of them. @returns those of
  /// this rank's nodes, in an order that does not depend on the ranks. Collective.
  std::vector<FaceRows> collect(const ContactSurfaces &surfaces, std::vector<FaceRows> mine);

  /// Integrates one slave face of the averaged scheme over its points: what it adds to the rows of its slave nodes.
  /// @p measure: positions that areas are of.
  FaceRows integrate_face(const ContactPairParameters &pair,
                          const ContactSurfaces       &surfaces,
                          const ContactGeometry       &geometry,
                          const AveragedJump::Face    &face,
                          const std::vector<Point>    &measure);
} // namespace Nodus

#endif
