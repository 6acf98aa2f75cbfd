#include "contact/self_contact.h"
#include "contact/pair_scales.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

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
      , slave_side_(surfaces, pair, slave)
      , master_side_(master.has_faces_of(slave) ? slave_side_ : Side(surfaces, pair, master))
  {
    list_faces_of_nodes();
  }

  SelfContact::Side::Side(const ContactSurfaces &surfaces, const unsigned int pair, const SurfaceGeometry &geometry)
      : start{0}
  {
    const FaceShape middle(surfaces.degree(), 0.5, 0.5);
    roles.reserve(geometry.n_faces());
    start.reserve(geometry.n_faces() + 1);
    all_nodes.reserve(middle.n * geometry.n_faces());
    for (unsigned int f = 0; f < geometry.n_faces(); ++f)
    {
      const SurfaceFace &face = geometry.face(f);
      roles.push_back(role(surfaces, pair, face, middle));
      all_nodes.insert(all_nodes.end(), face.nodes.begin(), face.nodes.end());
      for (const SurfaceFace::Follower &follower : face.hanging)
        for (const auto &[master, weight] : follower.masters)
          all_nodes.push_back(master);
      const auto begin = all_nodes.begin() + start[f];
      std::sort(begin, all_nodes.end());
      all_nodes.erase(std::unique(begin, all_nodes.end()), all_nodes.end());
      start.push_back(all_nodes.size());
    }
  }

  void SelfContact::list_faces_of_nodes()
  {
    first_face_.assign(surfaces_.nodes().size() + 1, 0);
    for (const unsigned int node : slave_side_.all_nodes)
      ++first_face_[node + 1];
    std::partial_sum(first_face_.begin(), first_face_.end(), first_face_.begin());
    faces_of_nodes_.resize(slave_side_.all_nodes.size());
    std::vector<unsigned int> next(first_face_.begin(), first_face_.end() - 1);
    for (unsigned int f = 0; f < slave_.n_faces(); ++f)
      for (auto [node, end] = slave_side_.nodes(f); node != end; ++node)
        faces_of_nodes_[next[*node]++] = f;
  }

  double SelfContact::most_visible(const unsigned int f) const
  {
    const SurfaceFace &face   = slave_.face(f);
    const unsigned int n_line = slave_.shape_degree() + 1;
    double             most   = 0.;
    for (unsigned int i = 0; i < 4; ++i)
    {
      const Point &x = slave_.shape_points(f)[(n_line - 1) * (i % 2 + n_line * (i / 2))];
      most           = std::max(most,
                      OwnNode::visible_depth * (cells_through(face, surfaces_.nodes(), i) *
                                                (slave_.positions()[face.across[i]] - x).norm()));
    }
    return most;
  }

  bool SelfContact::is_beyond(const unsigned int m, const Point &x, const Vector3 &n, const double depth) const
  {
    const auto &nodes = master_.face(m).nodes;
    return std::all_of(nodes.begin(),
                       nodes.end(),
                       [&](const unsigned int node) { return (master_.positions()[node] - x) * n < -depth; });
  }

  SelfContact::Role SelfContact::role(const ContactSurfaces &surfaces,
                                      const unsigned int     pair,
                                      const SurfaceFace     &face,
                                      const FaceShape       &middle)
  {
    const auto is_held = [&](const unsigned int node)
    { return surfaces.fixed(node, 0) && surfaces.fixed(node, 1) && surfaces.fixed(node, 2); };
    std::array<Point, 9> X;
    for (unsigned int n = 0; n < face.nodes.size(); ++n)
      X[n] = surfaces.nodes()[face.nodes[n]].X;
    const FaceGeometry geometry(middle, X.data());
    const Vector3      area = face.orientation * geometry.area_vector();
    const double       size = area.norm(), looks = direction * area / size;
    return {surfaces.is_master_alone(pair, face),
            std::all_of(face.nodes.begin(), face.nodes.end(), is_held),
            std::ldexp(std::sqrt(size), face.refined), // so that roles stay on new meshes
            surfaces.stiffness(face),
            face.body,
            looks,
            direction * Vector3(geometry.x),
            face.number};
  }

  bool SelfContact::Role::yields_to(const Role &other) const
  {
    if (rigid != other.rigid)
      return other.rigid;
    if (held != other.held)
      return other.held;
    if (much_stiffer * stiffness < other.stiffness || much_stiffer * other.stiffness < stiffness)
      return stiffness < other.stiffness;
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
    const double value[4] = {(1. - xi) * (1. - eta), xi * (1. - eta), (1. - xi) * eta, xi * eta};
    Vector3      through  = -Vector3(p);
    double       cells    = 0.;
    for (unsigned int i = 0; i < 4; ++i)
    {
      through += value[i] * x[face.across[i]];
      cells += value[i] * cells_through(face, nodes, i);
    }
    return cells * through.norm();
  }

  double
  SelfContact::cells_through(const SurfaceFace &face, const std::vector<SurfaceNode> &nodes, const unsigned int corner)
  {
    const unsigned int last = face.nodes.size() - 1, n_line = last == 3 ? 2 : 3,
                       n    = corner < 2 ? corner * (n_line - 1) : last - (3 - corner) * (n_line - 1);
    const SurfaceNode &node = nodes[face.nodes[n]];
    return std::max(1., node.wall / node.X.distance(nodes[face.across[corner]].X));
  }

  SelfContact::Seeker::Seeker(const SelfContact &rules, const unsigned int f, const double xi, const double eta)
      : rules_(rules)
      , begin_(rules.faces_of_nodes_.end())
      , end_(begin_)
      , face_(f)
      , thickness_(rules.thickness(rules.slave_, f, xi, eta))
  {
  }

  SelfContact::Seeker::Seeker(const SelfContact &rules, const unsigned int node)
      : rules_(rules)
      , begin_(rules.faces_of_nodes_.begin() + rules.first_face_[node])
      , end_(rules.faces_of_nodes_.begin() + rules.first_face_[node + 1])
      , thickness_(std::numeric_limits<double>::max())
  {
    const unsigned int degree = rules.slave_.degree();
    for (auto face = begin_; face != end_; ++face)
    {
      const unsigned int f     = *face;
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
    if (face_ != dealii::numbers::invalid_unsigned_int)
      return rules_.may_touch(face_, m);
    return std::all_of(begin_, end_, [&](const unsigned int f) { return rules_.may_touch(f, m); });
  }

  bool SelfContact::Seeker::is_slave(const unsigned int m) const
  {
    if (face_ != dealii::numbers::invalid_unsigned_int)
      return rules_.is_slave(face_, m);
    return std::any_of(begin_, end_, [&](const unsigned int f) { return rules_.is_slave(f, m); });
  }
} // namespace Nodus
