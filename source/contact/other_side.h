#ifndef nodus_contact_other_side_h
#define nodus_contact_other_side_h

#include "contact/triangles.h"

#include <mpi.h>

#include <array>
#include <utility>
#include <vector>

namespace Nodus
{
  /// A node that asks where it is.
  struct NodeQuestion
  {
    Point   before, now;
    double  reach;    ///< farther faces do not count [length]
    OwnNode own = {}; ///< of the same surface

    dealii::BoundingBox<dim> box() const;

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &before &now &reach &own;
    }
  };

  /// Where it is, and what it has gone through on its way.
  struct NodeAnswer
  {
    /// A surface that looks the way of the node's own one (cosine above this) is the far side of a body.
    static constexpr double far_side_cosine = 0.3;

    double                distance; ///< Height
    bool                  over, behind;
    Vector3               normal;
    std::vector<Crossing> crossings; ///< in no order before passed()

    /// Takes in that of another rank about the same node.
    void merge(const NodeAnswer &other);
    /// How deep a node whose own surface has the normal @p outward is; 0: not behind the surface.
    double depth(const Vector3 &outward) const
    {
      return behind && over && normal * outward < far_side_cosine ? distance : 0.;
    }
    /// Whether the node has gone through the surface deeper than @p tolerated. Sorts the crossings.
    bool passed(double tolerated);

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &distance &over &behind &normal &crossings;
    }
  };

  /// The faces of all ranks on one side of a pair, which answer questions about nodes of the other side.
  class OtherSide
  {
  public:
    /// @p own: the faces of this rank at the positions @p now; it outlives the object. Collective.
    OtherSide(const Triangles          &own,
              const std::vector<Point> &before,
              const std::vector<Point> &now,
              MPI_Comm                  communicator);

    /// What to ask about a node that was not deeper than @p depth: it can be no deeper now than the ways of both
    /// surfaces.
    NodeQuestion question(const Point &before, const Point &now, double depth) const;
    /// What all ranks know of each node. Collective.
    std::vector<NodeAnswer> answers(const std::vector<NodeQuestion> &questions) const;

  private:
    std::vector<NodeAnswer> answer(const std::vector<NodeQuestion> &questions) const;

    const Triangles                                                  &own_;
    std::vector<Point>                                                before_; ///< moved as the surface moves
    MPI_Comm                                                          communicator_;
    unsigned int                                                      rank_;
    Vector3                                                           motion_;     ///< of the surface as a whole
    double                                                            moves_ = 0.; ///< largest besides that
    std::vector<std::pair<unsigned int, std::array<double, 2 * dim>>> of_rank_;    ///< whether it has faces, box
  };
} // namespace Nodus

#endif
