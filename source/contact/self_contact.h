#ifndef nodus_contact_self_contact_h
#define nodus_contact_self_contact_h

#include "contact/surface_geometry.h"
#include "contact/triangles.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace Nodus
{
  /// How the faces of a surface that touches itself take each other: which of two is slave, which cannot meet, and how
  /// far behind a face another one counts (theory section 35). Both sides of such a pair have the same faces, but for
  /// those of rigid bodies, which are on the master side alone.
  class SelfContact
  {
  public:
    /// @p slave, @p master: the sides of @p pair at the same positions; they and @p surfaces outlive the object. Faces
    /// farther than @p reach do not meet [length].
    SelfContact(const ContactSurfaces &surfaces,
                unsigned int           pair,
                const SurfaceGeometry &slave,
                const SurfaceGeometry &master,
                double                 reach);

    /// Cosine between normals up from which faces do not look at each other.
    static constexpr double averted_cosine = -0.25881905;

    /// Whether slave face @p f and master face @p m have no node in common, for neighbours do not touch, and are not
    /// left to another pair, or to none.
    bool may_touch(unsigned int f, unsigned int m) const
    {
      return !meet(slave_side_.nodes(f), master_side_.nodes(m)) &&
             !meet_elsewhere(slave_.face(f).elsewhere, master_.face(m).elsewhere);
    }
    /// Whether @p f is the slave of @p m where they touch (eq. O2); one of both is.
    bool is_slave(const unsigned int f, const unsigned int m) const
    {
      return slave_side_.roles[f].yields_to(master_side_.roles[m]);
    }
    /// Depth up to which a point of master face @p m counts behind a point of slave face @p f [length].
    double visible(unsigned int f, double xi, double eta, unsigned int m, double master_xi, double master_eta) const
    {
      return OwnNode::visible_depth *
             std::min(thickness(slave_, f, xi, eta), thickness(master_, m, master_xi, master_eta));
    }
    /// Whether all of master face @p m lies deeper behind the point @p x of a surface with the outward normal @p n than
    /// @p depth: then none of it counts there.
    bool is_beyond(unsigned int m, const Point &x, const Vector3 &n, double depth) const;
    /// The largest depth up to which anything counts behind slave face @p f [length].
    double most_visible(unsigned int f) const;
    /// Part that a cell at this distance counts with: it fades in as surfaces come near (eq. O3).
    Fading near_part(const double distance) const
    {
      return Fading(distance, 0.5 * reach_, reach_);
    }

    /// Of the wall behind the point (xi, eta) of a face, which is at @p p [length]. @p x: positions of the nodes.
    static double thickness(const SurfaceFace              &face,
                            const std::vector<SurfaceNode> &nodes,
                            const std::vector<Point>       &x,
                            const Point                    &p,
                            double                          xi,
                            double                          eta);

    /// What looks for a partner: a point of a slave face, or a slave node with all its faces.
    class Seeker
    {
    public:
      Seeker(const SelfContact &rules, unsigned int f, double xi, double eta);
      Seeker(const SelfContact &rules, unsigned int node);

      /// Whether face @p m may be a partner of this, which is at @p x and looks along @p n.
      bool may_meet(unsigned int m, const Point &x, const Vector3 &n) const;
      bool is_slave(unsigned int m) const;
      /// Depth up to which a point of master face @p m counts behind it [length].
      double visible(const unsigned int m, const double xi, const double eta) const
      {
        return OwnNode::visible_depth * std::min(thickness_, rules_.thickness(rules_.master_, m, xi, eta));
      }

    private:
      const SelfContact                        &rules_;
      std::vector<unsigned int>::const_iterator begin_, end_;     ///< faces of a node
      unsigned int face_ = dealii::numbers::invalid_unsigned_int; ///< or the one that it is on
      double       thickness_;
    };

  private:
    /// Cells through the wall behind one of its four corners.
    static double cells_through(const SurfaceFace &face, const std::vector<SurfaceNode> &nodes, unsigned int corner);
    /// What decides who is slave, in the order of the members (eq. O2).
    struct Role
    {
      bool         rigid;     ///< of a rigid body
      bool         held;      ///< no node of it can move
      double       size;      ///< reference configuration, before the run adapts the mesh [length]
      double       stiffness; ///< Young's modulus of the body
      unsigned int body;
      double       looks, place; ///< normal and middle along one direction, reference configuration
      unsigned int number;

      bool yields_to(const Role &other) const;
    };
    /// Of a face in ascending order, with those that its hanging ones follow: begin and end.
    using Nodes = std::pair<const unsigned int *, const unsigned int *>;
    /// The faces of a side.
    struct Side
    {
      Side(const ContactSurfaces &surfaces, unsigned int pair, const SurfaceGeometry &geometry);

      Nodes nodes(const unsigned int f) const
      {
        return {all_nodes.data() + start[f], all_nodes.data() + start[f + 1]};
      }
      std::vector<Role>         roles;
      std::vector<unsigned int> all_nodes, start; ///< of each face from start on
    };

    static bool meet(const Nodes &a, const Nodes &b)
    {
      for (const unsigned int *i = a.first, *j = b.first; i != a.second && j != b.second;)
        if (*i == *j)
          return true;
        else
          ++(*i < *j ? i : j);
      return false;
    }
    static Role
           role(const ContactSurfaces &surfaces, unsigned int pair, const SurfaceFace &face, const FaceShape &middle);
    void   list_faces_of_nodes();
    double thickness(const SurfaceGeometry &side, const unsigned int f, const double xi, const double eta) const
    {
      return thickness(side.face(f), surfaces_.nodes(), side.positions(), side.position(f, xi, eta), xi, eta);
    }

    const ContactSurfaces    &surfaces_;
    const SurfaceGeometry    &slave_, &master_;
    const double              reach_;
    const Side                slave_side_, master_side_;
    std::vector<unsigned int> faces_of_nodes_, first_face_; ///< slave faces; those of each node from first_face_ on
  };
} // namespace Nodus

#endif
