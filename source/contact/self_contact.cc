#include "contact/self_contact.h"

#include <cmath>
#include <limits>

namespace Nodus
{
  namespace
  {
    /// A face that is smaller than another one by more than this is the finer one, a body with less stiffness the
    /// softer.
    constexpr double finer = 0.8, softer = 0.8;
    /// Faces of one body and size have an order by where they look, and by where they are, in a direction that lies
    /// along no axis of a model.
    const Vector3    direction({0.80, 0.53, 0.28});
    constexpr double same_direction = 1e-6;
  } // namespace

  SelfContact::SelfContact(const ContactSurfaces &surfaces,
                           const unsigned int     pair,
                           const SurfaceGeometry &slave,
                           const SurfaceGeometry &master,
                           const double           reach)
      : surfaces_(surfaces)
      , slave_(slave)
      , master_(master)
      , reach_(reach)
      , faces_of_node_(surfaces.nodes().size())
  {
    const auto take = [&](const SurfaceGeometry &side, std::vector<Role> &roles, std::vector<Nodes> &of_faces)
    {
      for (unsigned int f = 0; f < side.n_faces(); ++f)
      {
        roles.push_back(role(surfaces, pair, side.face(f)));
        of_faces.push_back(nodes(side.face(f)));
      }
    };
    take(slave, slave_roles_, slave_nodes_);
    take(master, master_roles_, master_nodes_);
    for (unsigned int f = 0; f < slave.n_faces(); ++f)
    {
      for (const unsigned int node : slave_nodes_[f])
        faces_of_node_[node].push_back(f);
      most_visible_.push_back(0.);
      for (unsigned int corner = 0; corner < 4; ++corner)
        most_visible_[f] =
            std::max(most_visible_[f], OwnNode::visible_depth * thickness(slave, f, corner % 2, corner / 2));
    }
  }

  bool SelfContact::is_beyond(const unsigned int m, const Point &x, const Vector3 &n, const double depth) const
  {
    const auto &nodes = master_.face(m).nodes;
    return std::all_of(nodes.begin(),
                       nodes.end(),
                       [&](const unsigned int node) { return (master_.positions()[node] - x) * n < -depth; });
  }

  SelfContact::Nodes SelfContact::nodes(const SurfaceFace &face)
  {
    Nodes nodes = face.nodes;
    for (const SurfaceFace::Follower &follower : face.hanging)
      for (const auto &[master, weight] : follower.masters)
        nodes.push_back(master);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

  bool SelfContact::meet(const Nodes &a, const Nodes &b)
  {
    for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();)
      if (*i == *j)
        return true;
      else
        ++(*i < *j ? i : j);
    return false;
  }

  SelfContact::Role SelfContact::role(const ContactSurfaces &surfaces, const unsigned int pair, const SurfaceFace &face)
  {
    Role role{surfaces.is_master_alone(pair, face), true, 0., surfaces.stiffness(face), face.body, 0., 0., face.number};
    for (const unsigned int node : face.nodes)
      for (unsigned int c = 0; c < dim; ++c)
        role.held = role.held && surfaces.fixed(node, c);
    const FaceShape    shape(surfaces.degree(), 0.5, 0.5);
    std::vector<Point> X;
    for (const unsigned int node : face.nodes)
      X.push_back(surfaces.nodes()[node].X);
    const FaceGeometry middle(shape, X.data());
    const Vector3      area = face.orientation * middle.area_vector();
    role.size               = std::ldexp(std::sqrt(area.norm()), face.refined); // so that roles stay on new meshes
    role.looks              = direction * area / area.norm();
    role.place              = direction * Vector3(middle.x);
    return role;
  }

  bool SelfContact::Role::yields_to(const Role &other) const
  {
    if (rigid != other.rigid)
      return other.rigid;
    if (held != other.held)
      return other.held;
    if (size < finer * other.size || other.size < finer * size)
      return size < other.size;
    if (stiffness < softer * other.stiffness || other.stiffness < softer * stiffness)
      return stiffness < other.stiffness;
    if (body != other.body)
      return body < other.body;
    if (std::abs(looks - other.looks) > same_direction)
      return looks > other.looks;
    return place != other.place ? place > other.place : number < other.number;
  }

  double SelfContact::thickness(const SurfaceFace              &face,
                                const std::vector<SurfaceNode> &nodes,
                                const std::vector<Point>       &x,
                                const Point                    &p,
                                const double                    xi,
                                const double                    eta)
  {
    const unsigned int last = face.nodes.size() - 1, n_line = last == 3 ? 2 : 3,
                       corner[4] = {0, n_line - 1, last - n_line + 1, last};
    const double value[4]        = {(1. - xi) * (1. - eta), xi * (1. - eta), (1. - xi) * eta, xi * eta};
    Vector3      through         = -Vector3(p);
    double       cells           = 0.;
    for (unsigned int i = 0; i < 4; ++i)
    {
      through += value[i] * x[face.across[i]];
      const SurfaceNode &node = nodes[face.nodes[corner[i]]];
      cells += value[i] * std::max(1., node.wall / node.X.distance(nodes[face.across[i]].X));
    }
    return cells * through.norm();
  }

  SelfContact::Seeker::Seeker(const SelfContact &rules, const unsigned int f, const double xi, const double eta)
      : rules_(rules)
      , face_(f)
      , faces_(nullptr)
      , thickness_(rules.thickness(rules.slave_, f, xi, eta))
  {
  }

  SelfContact::Seeker::Seeker(const SelfContact &rules, const unsigned int node)
      : rules_(rules)
      , face_(0)
      , faces_(&rules.faces_of_node_[node])
      , thickness_(std::numeric_limits<double>::max())
  {
    const unsigned int degree = rules.slave_.degree();
    for (const unsigned int f : *faces_)
    {
      const auto        &nodes = rules.slave_.face(f).nodes;
      const unsigned int n     = std::find(nodes.begin(), nodes.end(), node) - nodes.begin();
      if (n < nodes.size())
        thickness_ = std::min(thickness_,
                              rules.thickness(rules.slave_,
                                              f,
                                              static_cast<double>(n % (degree + 1)) / degree,
                                              static_cast<double>(n / (degree + 1)) / degree));
    }
  }

  bool SelfContact::Seeker::may_meet(const unsigned int m, const Point &x, const Vector3 &n) const
  {
    if (rules_.is_beyond(m, x, n, OwnNode::visible_depth * thickness_))
      return false;
    if (faces_ == nullptr)
      return rules_.may_touch(face_, m);
    return std::all_of(faces_->begin(), faces_->end(), [&](const unsigned int f) { return rules_.may_touch(f, m); });
  }

  bool SelfContact::Seeker::is_slave(const unsigned int m) const
  {
    if (faces_ == nullptr)
      return rules_.is_slave(face_, m);
    return std::any_of(faces_->begin(), faces_->end(), [&](const unsigned int f) { return rules_.is_slave(f, m); });
  }
} // namespace Nodus
