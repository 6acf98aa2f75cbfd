#ifndef nodus_contact_surface_h
#define nodus_contact_surface_h

#include "contact/face_directory.h"
#include "contact/surface_face.h"
#include "contact/surface_gather.h"
#include "mesh/bodies.h"
#include "parallel/ghost_exchange.h"
#include "rigid/rigid_surface.h"
#include "solve/linear_system.h"
#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <algorithm>
#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

namespace Nodus
{
  /// A displacement node of a contact surface.
  struct SurfaceNode
  {
    std::array<DoFIndex, dim> dofs;
    Point                     X;         ///< reference position
    unsigned int              owner;     ///< rank that owns its degrees of freedom
    unsigned int              body;      ///< its number, from 1
    double                    wall = 0.; ///< thickness of the one behind it at the start, see wall_thickness() [length]

    /// Of a hanging node: what it follows, indices into ContactSurfaces::nodes() and weights, and how far its reference
    /// position is from theirs.
    std::vector<std::pair<unsigned int, double>> masters;
    Vector3                                      offset;
  };

  /// How messages call a pair: its number, and its name when it has one.
  std::string pair_label(const std::vector<ContactPairParameters> &pairs, unsigned int pair);

  /// Divides the cells among the ranks so that those with slave faces do not all come on top of an equal share, now and
  /// whenever the mesh changes. @p mapping must outlive that. Collective.
  void
  balance_contact(const std::vector<ContactPairParameters> &pairs, const dealii::Mapping<dim> &mapping, Bodies &bodies);

  /// This rank's part of the slave and master surfaces of all pairs, in local numbers.
  ///
  /// A slave node that hangs is no slave node: it carries no multiplier and no status, the basis functions of the slave
  /// nodes that it follows extend over it. Where a jump or a force has to do with a hanging node of either side, its
  /// share goes to the nodes that it follows (expand()).
  ///
  /// - slave faces: of own cells, and all at the nodes of those and at own nodes. Normals and areas are complete at the
  ///   nodes of own faces and at own nodes; values that need more at the nodes beyond come from their owners, by the
  ///   exchanges;
  /// - master faces: of own cells, those that can be partners of this rank's sites, and one layer around for the
  ///   normals. They are fetched anew when the surfaces have moved.
  ///
  /// Faces are in ascending order of their numbers, which do not depend on the number of ranks: so ties are broken and
  /// sums are ordered alike on all of them.
  class ContactSurfaces
  {
  public:
    /// Collective. @p pairs must outlive it. @throws InputError on all ranks: a side without faces, a face that is
    /// slave twice, slave surfaces of two pairs that meet without an edge, a face on both sides of a pair.
    /// @p stiffness: Young's modulus of each body [pressure]; empty: all the same.
    ContactSurfaces(const std::vector<ContactPairParameters> &pairs,
                    const Bodies                             &bodies,
                    const dealii::DoFHandler<dim>            &dof_handler,
                    const dealii::Mapping<dim>               &mapping,
                    std::vector<double>                       stiffness = {});

    unsigned int degree() const
    {
      return degree_;
    }
    unsigned int n_pairs() const
    {
      return slave_faces_.size();
    }
    /// Sites of a pair that does not act have no partner; all act before the first choice.
    void let_act(std::vector<char> pairs)
    {
      acting_ = std::move(pairs);
    }
    bool acts(const unsigned int pair) const
    {
      return acting_[pair];
    }
    double stiffness(const SurfaceFace &face) const
    {
      return stiffness_.empty() ? 0. : stiffness_[face.body - 1];
    }
    /// The first are those of slave_nodes(), in their order, then what else is on slave faces.
    const std::vector<SurfaceNode> &nodes() const
    {
      return nodes_;
    }
    /// Those of this rank come first, in the order of their multipliers; those of one node follow each other.
    const std::vector<SlaveNode> &slave_nodes() const
    {
      return sites_.nodes;
    }
    /// Integration points of the pairs that have that scheme, face by face.
    const std::vector<SlavePoint> &slave_points() const
    {
      return sites_.points;
    }
    /// Contact sites are the places with a jump, a frame and statuses: first the slave nodes, then the integration
    /// points.
    unsigned int n_sites() const
    {
      return sites_.nodes.size() + sites_.points.size();
    }
    bool is_point(const unsigned int site) const
    {
      return site >= sites_.nodes.size();
    }
    const SlavePoint &point(const unsigned int site) const
    {
      return sites_.points[site - sites_.nodes.size()];
    }
    unsigned int pair(const unsigned int site) const
    {
      return is_point(site) ? point(site).pair : sites_.nodes[site].pair;
    }
    /// Slave nodes of a pair with integration points carry multipliers and frames, but no statuses.
    bool has_status(const unsigned int site) const
    {
      return is_point(site) || !sites_.has_points[sites_.nodes[site].pair];
    }
    bool has_points(const unsigned int pair) const
    {
      return sites_.has_points[pair];
    }
    /// Rank that projects and assembles a site.
    unsigned int site_owner(const unsigned int site) const
    {
      return is_point(site) ? slave_faces_[point(site).pair][point(site).face].owner
                            : nodes_[sites_.nodes[site].node].owner;
    }
    /// Reference position of a site.
    Point        site_position(unsigned int site) const;
    unsigned int n_owned_slave_nodes() const
    {
      return sites_.n_owned_nodes;
    }
    /// This rank owns the site (site_owner); false for invalid numbers, too.
    bool is_owned(const unsigned int site) const
    {
      return site < sites_.n_owned_nodes || (is_point(site) && site < n_sites() && site_owner(site) == rank_);
    }
    /// Number of the slave node's multiplier among those of all ranks (BlockLayout).
    DoFIndex multiplier(const unsigned int slave) const
    {
      return sites_.multiplier[slave];
    }
    /// Number of an owned site on the whole surface that does not depend on the ranks.
    DoFIndex order(const unsigned int site) const
    {
      return sites_.order[site];
    }

    /// Arrays over slave_nodes() and over the sites.
    const GhostExchange &slave_exchange() const
    {
      return sites_.node_exchange;
    }
    const GhostExchange &site_exchange() const
    {
      return sites_.exchange;
    }

    const std::vector<SurfaceFace> &slave_faces(const unsigned int pair) const
    {
      return slave_faces_[pair];
    }
    const std::vector<SurfaceFace> &master_faces(const unsigned int pair) const
    {
      return master_faces_[pair];
    }
    /// Number of faces on all ranks.
    unsigned int n_faces(unsigned int pair, SurfaceSide side) const;
    /// Index into slave_nodes() of a surface node on the slave side of a pair, or invalid_unsigned_int.
    unsigned int slave_number(unsigned int pair, unsigned int node) const;
    /// Whether an own slave node has multipliers of other pairs, too.
    bool shares_node(unsigned int slave) const;
    /// Pairs whose slave surfaces meet are in different layers; 0, ..., in most models one for all.
    const std::vector<unsigned int> &layers() const
    {
      return sites_.layers;
    }
    unsigned int n_layers() const;
    /// Calls f(node, weight) for the free nodes that make up @p weight times the displacement of a node.
    template <typename Function>
    void expand(const unsigned int node, const double weight, const Function &f) const
    {
      if (nodes_[node].masters.empty())
        f(node, weight);
      else
        for (const auto &[master, part] : nodes_[node].masters)
          f(master, weight * part);
    }
    /// Active cell index of this rank's face @p number of a side.
    unsigned int own_cell(unsigned int pair, SurfaceSide side, unsigned int number) const;
    /// Index into nodes() by the first degree of freedom; the node must be there.
    unsigned int node(const DoFIndex first_dof) const
    {
      return node_of_dof_.at(first_dof);
    }
    /// Mean size (square root of the area) of the slave faces of a pair, reference configuration.
    double face_size(const unsigned int pair) const
    {
      return face_size_[pair];
    }
    /// The same of the master faces; of the slave faces where there are none.
    double master_face_size(const unsigned int pair) const
    {
      return master_face_size_[pair];
    }
    const BlockLayout &layout() const
    {
      return layout_;
    }

    /// The master of a pair without master faces, or nullptr.
    const RigidSurface *rigid_master(const unsigned int pair) const
    {
      return rigid_masters_[pair].get();
    }
    RigidSurface *rigid_master(const unsigned int pair)
    {
      return rigid_masters_[pair].get();
    }
    bool has_rigid_masters() const;
    bool touches_itself(unsigned int pair) const; ///< the master side has all that the slave side has, and rigid bodies
    bool is_master_alone(unsigned int pair, const SurfaceFace &face) const; ///< of one of these, in such a pair
    std::vector<SurfaceFace> faces_that_are_master_alone(unsigned int pair) const;
    /// Moves them to where they are at the end of an increment, or, those that a body of the model carries, to where
    /// the nodes are: @p positions of all nodes. @throws InputError on every rank
    void move_rigid_masters(double begin, double end);
    void place_carried_masters(const std::vector<Point> &positions);

    /// Fetches the master faces near this rank's slave faces at displacement @p u and these shortenings of bolts,
    /// unless no surface node has moved much since the last time; returns whether nodes() and master_faces() have
    /// changed. Collective.
    bool fetch_masters(const Vector &u, const std::vector<Vector3> &shortenings);

    /// Values of a displacement-like vector (fully distributed) at all local nodes. Collective.
    void gather(const Vector &v, std::vector<Vector3> &nodal_values) const
    {
      gather_.gather(v, nodal_values);
    }
    /// The same of a displacement, with the slave sides of bolts' sections where they would be had the bolts not been
    /// shortened there (eq. R11), by RigidBodies::shortenings(). Collective.
    void gather(const Vector &u, const std::vector<Vector3> &shortenings, std::vector<Vector3> &displacements) const;
    /// Adds what all ranks have for their local nodes to such a vector. Collective.
    void add(const std::vector<Vector3> &nodal_values, Vector &v) const
    {
      gather_.add(nodal_values, v);
    }

    /// Which components of which nodes are prescribed, those of hanging nodes when all that they follow are; whenever
    /// the constraints have changed. Collective.
    void set_fixed(const dealii::AffineConstraints<double> &constraints);
    bool fixed(const unsigned int node, const unsigned int component) const
    {
      return held_.fixed[node][component];
    }
    const std::vector<std::array<bool, dim>> &fixed() const
    {
      return held_.fixed;
    }

    /// Numbers of driven rigid bodies by body, invalid for the others; @p n: all that are driven, faces behind bodies.
    void set_rigid_bodies(const std::vector<unsigned int> &numbers, unsigned int n);
    /// Which of these a node belongs to, or invalid_unsigned_int.
    unsigned int rigid_body(const unsigned int node) const
    {
      return held_.rigid_body.empty() ? dealii::numbers::invalid_unsigned_int : held_.rigid_body[node];
    }
    /// The sections of bolts among all that is driven: by pair, or invalid, and their axes.
    void set_sections(const std::vector<unsigned int> &of_pairs, const std::vector<Vector3> &axes);
    /// Number of the section that a pair is, or invalid_unsigned_int, and its axis.
    unsigned int section(const unsigned int pair) const
    {
      return pair < held_.section_of_pair.size() ? held_.section_of_pair[pair] : dealii::numbers::invalid_unsigned_int;
    }
    const Vector3 &axis(const unsigned int section) const
    {
      return held_.axes[section];
    }
    /// Number of the section that a node is on the slave side of, or invalid_unsigned_int.
    unsigned int section_of_node(const unsigned int node) const
    {
      return held_.section.empty() ? dealii::numbers::invalid_unsigned_int : held_.section[node];
    }
    /// Calls f(flat index, weight) for the unknowns that move component @p c of a node: its own displacement, where
    /// that is free, or translation and spin of its rigid body, @p x being where the node is and @p centre those of the
    /// bodies; and the shortening of its section.
    template <typename Function>
    void for_each_unknown(const unsigned int        node,
                          const unsigned int        c,
                          const Point              &x,
                          const std::vector<Point> &centre,
                          const Function           &f) const
    {
      if (!fixed(node, c))
        f(nodes_[node].dofs[c], 1.);
      else if (const unsigned int body = rigid_body(node); body != dealii::numbers::invalid_unsigned_int)
        for_each_rigid_unknown(body, c, 1., Vector3(x - centre[body]), f);
      if (const unsigned int section = section_of_node(node); section != dealii::numbers::invalid_unsigned_int)
        f(layout_.rigid(section, 0), -held_.axes[section][c]);
    }
    /// The same for what moves like component @p c of @p weight T + omega x @p arm.
    template <typename Function>
    void for_each_rigid_unknown(
        const unsigned int body, const unsigned int c, const double weight, const Vector3 &arm, const Function &f) const
    {
      const unsigned int j = (c + 1) % dim, k = (c + 2) % dim;
      f(layout_.rigid(body, c), weight);
      f(layout_.rigid(body, dim + j), arm[k]);
      f(layout_.rigid(body, dim + k), -arm[j]);
    }

    std::vector<Point> positions(const std::vector<Vector3> &u) const; ///< x = X + u for all nodes
    std::vector<Point> reference_positions() const;

  private:
    std::string repeated_slave_face() const;
    std::string refused_meeting() const;
    std::string repeated_face() const;
    void        measure_faces();
    void        take_slave_faces();
    void        find_layers();
    void        take_carriers(const Bodies &bodies, const dealii::DoFHandler<dim> &dof_handler);
    void        make_points();
    void        number_sites();
    void        make_layout(const dealii::IndexSet &owned_dofs);
    void        fetch(const std::vector<Vector3> &u);
    void        take_master_faces(const std::vector<FaceRecord> &records);
    void        add_node(DoFIndex dof, const double *X, unsigned int body);
    void        add_nodes(const FaceRecord &record);
    void        link_followers(const std::vector<FaceRecord> &records);
    SurfaceFace make_face(const FaceRecord &record) const;
    void        gather_fixed();
    void        gather_walls();
    void        find_rigid_nodes();
    void        find_sections();

    /// The places with a jump, a frame and statuses, and what carries multipliers.
    struct Sites
    {
      std::vector<SlaveNode>    nodes;         ///< those of this rank first
      std::vector<unsigned int> first_of_node; ///< of each node that has some; ends with the number of all
      std::vector<unsigned int> layers;        ///< of each pair
      unsigned int              n_owned_nodes = 0;
      std::vector<SlavePoint>   points;
      std::vector<char>         has_points; ///< of each pair: its statuses are those of points
      std::vector<DoFIndex>     multiplier; ///< of each slave node
      std::vector<DoFIndex>     order;      ///< of each site, complete for owned ones
      GhostExchange             node_exchange, exchange;
    };
    /// Displacements that are not unknowns of their own: prescribed ones, and those of driven rigid bodies.
    struct Held
    {
      Vector                             mask; ///< 1 at prescribed degrees of freedom
      std::vector<std::array<bool, dim>> fixed;
      std::vector<unsigned int>          rigid_number;             ///< by body
      std::vector<unsigned int>          rigid_body;               ///< by node, empty without any
      std::vector<unsigned int>          section_of_pair, section; ///< likewise, the second by node
      std::vector<Vector3>               axes;                     ///< of all that is driven
    };

    const std::vector<ContactPairParameters>  &pairs_;
    MPI_Comm                                   communicator_;
    unsigned int                               degree_, rank_;
    FaceDirectory                              directory_;
    std::vector<SurfaceNode>                   nodes_;
    unsigned int                               n_slave_side_nodes_ = 0;
    std::unordered_map<DoFIndex, unsigned int> node_of_dof_;
    Sites                                      sites_;
    std::vector<std::vector<SurfaceFace>>      slave_faces_, master_faces_;
    std::vector<std::unique_ptr<RigidSurface>> rigid_masters_; ///< of each pair, or nullptr
    std::vector<double>                        face_size_, master_face_size_;
    Vector                                     fetched_at_;        ///< displacement
    std::vector<Vector3>                       fetched_tightened_; ///< shortenings then, empty: none
    Vector                                     walls_;             ///< empty, or wall_thickness()
    Held                                       held_;
    BlockLayout                                layout_;
    SurfaceGather                              gather_;
    std::vector<char>                          acting_;    ///< of each pair
    std::vector<double>                        stiffness_; ///< of each body
  };
} // namespace Nodus

#endif
