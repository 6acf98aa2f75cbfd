#ifndef nodus_contact_intrusion_h
#define nodus_contact_intrusion_h

#include "contact/surface.h"

#include <deal.II/base/bounding_box.h>

#include <array>
#include <functional>
#include <vector>

namespace Nodus
{
  /// How far nodes of the two sides of a pair are behind the surface of the other side.
  struct Intrusion
  {
    struct Node
    {
      Point       X; ///< reference position
      SurfaceSide side = slave_side;
    };
    /// Largest of slave and of master nodes that were not as deep before; 0: none is behind [length].
    std::array<double, 2> depth{{0., 0.}};
    std::array<Point, 2>  deepest; ///< reference positions
    unsigned int passed = 0; ///< nodes that have gone through the other surface, those of several ranks more than once
    Node         first_passed;

    /// For messages between ranks.
    template <typename Archive>
    void serialize(Archive &archive, unsigned int)
    {
      archive &depth &deepest &passed &first_passed.X &first_passed.side;
    }
  };

  /// A node that is behind the other surface of its pair.
  struct DeepNode
  {
    Point        x;     ///< position
    Point        ahead; ///< a point a little before the node, outside of its body
    double       depth; ///< [length]
    unsigned int pair;
    SurfaceSide  side; ///< that it is on
  };
  /// Those of this rank that are deeper than @p tolerated of their pair at the positions @p x of
  /// ContactSurfaces::nodes(), without a limit from above. Of nodes that are not in the box @p around of the other side
  /// nothing is said; not of rigid masters without faces either. Collective.
  std::vector<DeepNode>
  find_deep_nodes(const ContactSurfaces                                                    &surfaces,
                  const std::vector<Point>                                                 &x,
                  const std::vector<double>                                                &tolerated,
                  const std::function<dealii::BoundingBox<dim>(unsigned int, SurfaceSide)> &around);

  /// The intrusion of every pair that acts, from the faces alone: no pairing, no statuses, no multipliers. Every node
  /// of the surfaces counts, those that hang and those that carry no multipliers as well.
  ///
  /// A node is behind a surface where the nearest point of the surface is none of its rim, has the node on its inner
  /// side and does not look the way of the node's own surface. It has passed where its way from @p before to @p now, a
  /// straight line, has for the last time crossed the other surface, which moves likewise, from its front, and ends
  /// farther than the tolerated depth from it; or where it begins and ends outside of a rigid master without faces,
  /// and was deeper in it than that on the way.
  ///
  /// @p before, @p now: positions of ContactSurfaces::nodes(); @p begin, @p end: times of the increment, for rigid
  /// masters, which are left where they are at its end; @p tolerated: depth of each pair, > 0 [length]. The same on
  /// every rank. Collective.
  std::vector<Intrusion> find_intrusions(ContactSurfaces           &surfaces,
                                         const std::vector<Point>  &before,
                                         const std::vector<Point>  &now,
                                         double                     begin,
                                         double                     end,
                                         const std::vector<double> &tolerated);

  /// The part, 0 to 1, of the way from @p before to @p now on which no node goes farther behind the other surface than
  /// pairing looks (search_reach()). Where one would, the way ends a quarter of a face behind the surface; 1 where none
  /// does. Of rigid masters without faces nothing is said. Collective.
  double visible_part(const std::vector<ContactPairParameters> &pairs,
                      const ContactSurfaces                    &surfaces,
                      const std::vector<Point>                 &before,
                      const std::vector<Point>                 &now);
} // namespace Nodus

#endif
