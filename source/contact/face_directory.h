#ifndef nodus_contact_face_directory_h
#define nodus_contact_face_directory_h

#include "mesh/hanging_nodes.h"
#include <nodus/base/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>

#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

namespace Nodus
{
  class Bodies;
  class Region;

  enum SurfaceSide : unsigned int
  {
    slave_side,
    master_side
  };

  /// A contact face as ranks send it.
  struct FaceRecord
  {
    DoFIndex     dofs[9][dim];
    double       X[9][dim]; ///< reference positions
    double       orientation;
    unsigned int pair, side, rank;
    unsigned int number;    ///< in its pair and side, in the order of the cells, which does not depend on the ranks
    unsigned int cell;      ///< active cell index on the rank that owns it
    unsigned int body;      ///< its number, from 1
    unsigned int refined;   ///< how often the run has split its cell, Bodies::level() not counted
    DoFIndex     across[4]; ///< first degrees of freedom of the corners of the face across the cell, ...
    double       X_across[4][dim]; ///< ... and where they are
    /// Of degree 1: the face's share in the averaged normals of its corners (eq. P7).
    double normal_share[4];
    /// Of pairs that touch themselves: the sides of other pairs, numbered 2 pair + side, that the face belongs to and
    /// that come before this one.
    std::vector<unsigned int> elsewhere;

    /// Node n hangs; one of the nodes that it follows.
    struct Follower
    {
      unsigned int n;
      DoFIndex     dof; ///< the first of the three
      double       X[dim], weight;
      double       share; ///< of the multiplier of that node at node n; 0 where it is no node of this side

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &n &dof &X &weight &share;
      }
    };
    std::vector<Follower> followers;

    bool hangs(const unsigned int n) const
    {
      for (const Follower &follower : followers)
        if (follower.n == n)
          return true;
      return false;
    }

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &dofs &X &orientation &pair &side &rank &number &cell &body &refined &across &X_across &normal_share
          &elsewhere &followers;
    }
    bool operator<(const FaceRecord &other) const
    {
      return std::make_pair(pair, number) < std::make_pair(other.pair, other.number);
    }
  };

  /// The contact faces of this rank's cells, and who else has faces at which node.
  class FaceDirectory
  {
  public:
    FaceDirectory(const dealii::DoFHandler<dim> &dof_handler, unsigned int n_pairs);

    /// Adds the faces of owned cells in @p region. @p elsewhere: what becomes FaceRecord::elsewhere of those in it.
    void collect(const Region                         &region,
                 const Bodies                         &bodies,
                 const dealii::Mapping<dim>           &mapping,
                 unsigned int                          pair,
                 unsigned int                          side,
                 const std::map<unsigned int, Region> &elsewhere = {});
    /// Numbers the faces and tells the owners of their nodes of them. Collective, after the last collect().
    void publish();

    /// Faces of owned cells, in ascending order of their numbers.
    const std::vector<FaceRecord> &own(const unsigned int pair, const unsigned int side) const
    {
      return own_[2 * pair + side];
    }
    /// Number of faces on all ranks.
    unsigned int size(const unsigned int pair, const unsigned int side) const
    {
      return size_[2 * pair + side];
    }
    /// Faces with the basis functions of nodes of this rank.
    const std::vector<FaceRecord> &at_own_nodes() const
    {
      return at_own_nodes_;
    }
    /// Adds to @p faces of one side all with basis functions that one of them has, on any rank, and sorts them.
    /// Collective.
    void add_layer(std::vector<FaceRecord> &faces) const;

    /// Rank that owns a degree of freedom.
    unsigned int owner(DoFIndex dof) const;

  private:
    using NodeKey = std::pair<unsigned int, DoFIndex>; ///< 2 pair + side, first degree of freedom

    void share_multipliers();
    /// Finds FaceRecord::normal_share of all faces.
    void share_normals();
    /// Ranks that have the face: its own and those of the nodes of its basis functions.
    std::set<unsigned int> holders(const FaceRecord &face) const;
    /// The faces of one side around a node, as indices into at_own_nodes_ and the corner that the node is.
    std::vector<std::pair<unsigned int, unsigned int>> corners_at(const NodeKey &node) const;
    /// First degrees of freedom of the nodes whose basis functions are not zero on a face: its free ones and those that
    /// its hanging ones follow.
    std::vector<DoFIndex> support(const FaceRecord &face) const;

    const dealii::DoFHandler<dim>               &dof_handler_;
    HangingNodes                                 hanging_;
    std::unordered_map<DoFIndex, Point>          followed_; ///< positions of the nodes that hanging ones follow
    unsigned int                                 rank_, n_face_nodes_;
    std::vector<DoFIndex>                        end_of_rank_; ///< of the ascending ranges of degrees of freedom
    std::vector<std::vector<FaceRecord>>         own_;
    std::vector<unsigned int>                    size_;
    std::vector<FaceRecord>                      at_own_nodes_;
    std::map<NodeKey, std::vector<unsigned int>> incident_; ///< own nodes: indices into at_own_nodes_
  };

  /// Sorts by pair and number and drops repetitions.
  void make_unique(std::vector<FaceRecord> &faces);
} // namespace Nodus

#endif
