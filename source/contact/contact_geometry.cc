#include "contact/contact_geometry.h"
#include "contact/master_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace Nodus
{
  namespace
  {
    /// Master faces looking along the slave's outward normal (cosine above this) are the far side of a body.
    constexpr double far_side_cosine = 0.5;
    /// Face sizes that a point on the rim may be beyond it by round-off.
    constexpr double no_tolerance = 1e-12;

    /// An edge of a face by its nodes in ascending order, then invalid ones, or those of the larger face's edge that it
    /// is half of.
    struct Edge
    {
      std::array<unsigned int, 9> nodes;
      bool                        half = false;

      Edge(const SurfaceFace &face, const unsigned int degree, const unsigned int e)
      {
        const unsigned int n = degree + 1, first[4] = {0, degree, 0, n * degree}, step[4] = {n, n, 1, 1};
        nodes.fill(dealii::numbers::invalid_unsigned_int);
        for (unsigned int i = 0; i < n; ++i)
          nodes[i] = face.nodes[first[e] + i * step[e]];
        for (unsigned int i = 0; i < n && !face.hanging.empty() && !half; ++i)
          if (const auto *const hung = face.follower(first[e] + i * step[e]))
            take_larger(hung->masters, n, i);
        std::sort(nodes.begin(), nodes.end());
      }

    private:
      /// If all nodes but @p hung are among those that this one follows.
      void take_larger(const std::vector<std::pair<unsigned int, double>> &larger,
                       const unsigned int                                  n,
                       const unsigned int                                  hung)
      {
        for (unsigned int i = 0; i < n; ++i)
          if (i != hung &&
              std::none_of(larger.begin(), larger.end(), [&](const auto &master) { return master.first == nodes[i]; }))
            return;
        half = true;
        for (unsigned int i = 0; i < std::min<std::size_t>(larger.size(), nodes.size()); ++i)
          nodes[i] = larger[i].first;
      }
    };

    std::vector<TreeBox> face_boxes(const SurfaceGeometry &surface)
    {
      std::vector<TreeBox> boxes;
      boxes.reserve(surface.n_faces());
      for (unsigned int f = 0; f < surface.n_faces(); ++f)
        boxes.emplace_back(face_box(surface.face(f), surface.degree(), surface.positions()));
      return boxes;
    }
  } // namespace

  MasterSearch::MasterSearch(const SurfaceGeometry &master, const double tolerance, const bool segments)
      : master_(master)
      , segments_(segments)
      , tolerance_(std::max(tolerance, no_tolerance))
      , tree_(face_boxes(master))
      , on_rim_(master.n_faces())
  {
    const FaceShape middle(master.shape_degree(), 0.5, 0.5);
    for (unsigned int f = 0; f < master.n_faces(); ++f)
    {
      const FaceGeometry centre(middle, master.shape_points(f));
      const Vector3      area = master.face(f).orientation * centre.area_vector();
      centre_.push_back(centre.x);
      centre_normal_.push_back(area / area.norm());
      size_.push_back(std::sqrt(centre.area_vector().norm()));
    }
    find_rims();
  }

  void MasterSearch::find_rims()
  {
    std::vector<Edge> edges;
    edges.reserve(4 * on_rim_.size());
    for (unsigned int f = 0; f < on_rim_.size(); ++f)
      for (unsigned int e = 0; e < 4; ++e)
        edges.emplace_back(master_.face(f), master_.degree(), e);
    for (unsigned int at = 0; at < edges.size(); ++at)
    {
      const Edge        &own     = edges[at];
      const unsigned int f       = at / 4;
      const auto         is_same = [&](const Edge &other)
      { return other.nodes[0] == own.nodes[0] && other.nodes == own.nodes && !(other.half && own.half); };
      const auto goes_on = [&](const unsigned int g)
      { return g != f && std::any_of(&edges[4 * g], &edges[4 * g] + 4, is_same) && !falls_off(f, g); };
      on_rim_[f][at % 4] =
          std::none_of(own.nodes.begin(),
                       std::find(own.nodes.begin(), own.nodes.end(), dealii::numbers::invalid_unsigned_int),
                       [&](const unsigned int node) { return master_.any_at(node, goes_on); });
    }
  }

  bool MasterSearch::falls_off(const unsigned int f, const unsigned int neighbour) const
  {
    return segments_ && centre_normal_[f] * centre_normal_[neighbour] <= -SelfContact::averted_cosine &&
           (centre_[neighbour] - centre_[f]) * centre_normal_[f] < 0.;
  }

  namespace
  {
    /// The closest of several faces.
    struct Closest
    {
      Projection at;
      double     distance; ///< squared

      void take(const Projection &other, const double d2, const double size)
      {
        // neighbours share an edge point: the lower face number decides, on every rank alike
        const double tie = 1e-12 * size * size;
        if (!(d2 < distance - tie || (d2 < distance + tie && other.face < at.face)))
          return;
        distance = std::min(d2, distance);
        at       = other;
      }
      /// Boxes nearer than this may have faces that count: as near as the best one, too.
      double limit() const
      {
        return std::nextafter(distance, std::numeric_limits<double>::infinity());
      }
    };
  } // namespace

  Projection
  MasterSearch::closest(const Point &p, const Vector3 &slave_normal, const double reach, const double part) const
  {
    const double along = segments_ ? SelfContact::averted_cosine : far_side_cosine;
    Closest      best{{}, reach * reach};
    tree_.nearest(p,
                  best.limit(),
                  [&](const unsigned int f, double)
                  {
                    Projection at{f};
                    if (centre_normal_[f] * slave_normal <= along)
                      best.take(at, closest_point(master_, f, p, at.xi, at.eta), size_[f]);
                    return best.limit();
                  });
    return within_rim(best.at, p, part);
  }

  Projection MasterSearch::closest_of_own(const Point               &p,
                                          const Vector3             &normal,
                                          const double               reach,
                                          const double               part,
                                          const SelfContact::Seeker &seeker) const
  {
    // Boxes in ascending distance, of those that may be partners: most that are nearby are its own neighbours.
    thread_local std::vector<std::pair<double, unsigned int>> faces;
    dealii::BoundingBox<dim>                                  around({p, p});
    around.extend(reach);
    faces.clear();
    tree_.meeting(TreeBox(around),
                  [&](const unsigned int f)
                  {
                    if (centre_normal_[f] * normal <= SelfContact::averted_cosine && seeker.may_meet(f, p, normal))
                      faces.emplace_back(tree_.box(f).squared_distance(p), f);
                  });
    std::sort(faces.begin(), faces.end());
    Closest best{{}, reach * reach};
    for (const auto &[least, f] : faces)
    {
      if (least > best.distance)
        break;
      Projection   at{f};
      const double d2 = closest_point(master_, f, p, at.xi, at.eta);
      // a face that is beside it is not far along its own normal, but may be along that of the face
      const Vector3 apart  = master_.position(f, at.xi, at.eta) - p;
      const double  height = std::min(apart * normal, -(apart * master_.normal(f, at.xi, at.eta)));
      if (height >= 0. || height >= -seeker.visible(f, at.xi, at.eta))
        best.take(at, d2, size_[f]);
    }
    return best.at.found() && seeker.is_slave(best.at.face) ? within_rim(best.at, p, part) : Projection();
  }

  /// A point beyond the rim of the master surface has no partner, but for a small overhang.
  Projection MasterSearch::within_rim(const Projection &closest, const Point &p, const double part) const
  {
    return closest.found() && overhang(closest, p).norm() <= part ? closest : Projection();
  }

  Vector3 MasterSearch::overhang(const Projection &closest, const Point &p) const
  {
    const auto &[f, xi, eta] = closest;
    const auto &rim          = on_rim_[f];
    if (!(xi <= 0. && rim[0]) && !(xi >= 1. && rim[1]) && !(eta <= 0. && rim[2]) && !(eta >= 1. && rim[3]))
      return Vector3();
    const Vector3 n = master_.normal(f, xi, eta);
    const Vector3 r = p - master_.at(f, xi, eta).x;
    return (r - (r * n) * n) / tolerated_overhang(f);
  }

  void MasterSearch::candidates(const dealii::BoundingBox<dim> &box, std::vector<unsigned int> &faces) const
  {
    faces.clear();
    tree_.meeting(TreeBox(box), [&](const unsigned int f) { faces.push_back(f); });
    std::sort(faces.begin(), faces.end());
  }

  namespace
  {
    bool have_same_nodes(const std::vector<SurfaceFace> &a, const std::vector<SurfaceFace> &b)
    {
      return std::equal(a.begin(),
                        a.end(),
                        b.begin(),
                        b.end(),
                        [](const SurfaceFace &f, const SurfaceFace &g) { return f.nodes == g.nodes; });
    }
  } // namespace

  ContactGeometry::ContactGeometry(const std::vector<ContactPairParameters> &pairs,
                                   const ContactSurfaces                    &surfaces,
                                   const std::vector<Point>                 &positions)
      : reach(search_reach(pairs, surfaces, positions))
  {
    slave.reserve(pairs.size());
    master.reserve(pairs.size()); // the searches refer to the masters
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      slave.emplace_back(surfaces.slave_faces(p), surfaces.degree(), positions, surfaces.fixed(), pairs[p].surface);
      if (pairs[p].self_contact && have_same_nodes(surfaces.slave_faces(p), surfaces.master_faces(p)))
        master.push_back(slave[p]);
      else
        master.emplace_back(surfaces.master_faces(p), surfaces.degree(), positions, surfaces.fixed(), pairs[p].surface);
      search.emplace_back(master[p],
                          pairs[p].projection_tolerance,
                          pairs[p].scheme == ContactPairParameters::Scheme::averaged &&
                              pairs[p].integration == ContactPairParameters::Integration::segment);
      self.push_back(pairs[p].self_contact ? std::make_unique<SelfContact>(surfaces, p, slave[p], master[p], reach[p])
                                           : nullptr);
      rigid.push_back(surfaces.rigid_master(p));
      overhang.push_back(pairs[p].projection_tolerance * surfaces.face_size(p));
    }
  }

  Projection ContactGeometry::closest_to_face(const unsigned int pair,
                                              const unsigned int f,
                                              const double       xi,
                                              const double       eta,
                                              const Point       &p,
                                              const Vector3     &normal,
                                              const double       part) const
  {
    if (self[pair] == nullptr)
      return search[pair].closest(p, normal, reach[pair], part);
    const SelfContact::Seeker seeker(*self[pair], f, xi, eta);
    return search[pair].closest_of_own(p, normal, reach[pair], part, seeker);
  }

  Projection ContactGeometry::closest_to_node(
      const unsigned int pair, const unsigned int node, const Point &p, const Vector3 &normal, const double part) const
  {
    if (self[pair] == nullptr)
      return search[pair].closest(p, normal, reach[pair], part);
    const SelfContact::Seeker seeker(*self[pair], node);
    return search[pair].closest_of_own(p, normal, reach[pair], part, seeker);
  }

  RigidPoint ContactGeometry::closest_on_rigid(const unsigned int pair,
                                               const Point       &p,
                                               const Vector3     &slave_normal,
                                               const double       part) const
  {
    RigidPoint point = rigid[pair]->closest(p);
    point.found = point.found && std::abs(point.height) <= reach[pair] && point.overhang <= part * overhang[pair] &&
                  point.normal * slave_normal <= far_side_cosine;
    return point;
  }

  Point ContactGeometry::position(const ContactSurfaces &surfaces, const unsigned int site) const
  {
    const unsigned int p = surfaces.pair(site);
    if (!surfaces.is_point(site))
      return slave[p].positions()[surfaces.slave_nodes()[site].node];
    const SlavePoint &point = surfaces.point(site);
    return slave[p].at(point.face, point.xi, point.eta).x;
  }

  double closest_point(const SurfaceGeometry &surface, const unsigned int f, const Point &p, double &xi, double &eta)
  {
    xi = eta = 0.5;
    for (unsigned int iteration = 0; iteration < 50; ++iteration)
    {
      const FaceGeometry geometry = surface.at(f, xi, eta);
      const Vector3      r        = p - geometry.x;
      const double       g[2]     = {r * geometry.d_xi, r * geometry.d_eta};
      // Gauss-Newton metric: safe far from the face, exact on a plane one
      const double a = geometry.d_xi * geometry.d_xi, b = geometry.d_xi * geometry.d_eta,
                   c      = geometry.d_eta * geometry.d_eta;
      const bool hold_xi  = (xi <= 0. && g[0] <= 0.) || (xi >= 1. && g[0] >= 0.);
      const bool hold_eta = (eta <= 0. && g[1] <= 0.) || (eta >= 1. && g[1] >= 0.);
      double     step_xi = 0., step_eta = 0.;
      if (!hold_xi && !hold_eta)
      {
        const double det = a * c - b * b;
        step_xi          = (c * g[0] - b * g[1]) / det;
        step_eta         = (a * g[1] - b * g[0]) / det;
      }
      else if (!hold_xi)
        step_xi = g[0] / a;
      else if (!hold_eta)
        step_eta = g[1] / c;
      const double new_xi = std::clamp(xi + step_xi, 0., 1.), new_eta = std::clamp(eta + step_eta, 0., 1.);
      const double change = std::max(std::abs(new_xi - xi), std::abs(new_eta - eta));
      xi                  = new_xi;
      eta                 = new_eta;
      if (change < 1e-14)
        break;
    }
    return (p - surface.at(f, xi, eta).x).norm_square();
  }

} // namespace Nodus
