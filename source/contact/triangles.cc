#include "contact/triangles.h"
#include "contact/self_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// A point this far outside of a triangle (part of its size) still goes through it, lest any slip between two.
    constexpr double slack = 1e-9;

    Vector3 cross(const Vector3 &a, const Vector3 &b)
    {
      return dealii::cross_product_3d(a, b);
    }

    TreeBox box_of(const std::initializer_list<Point> &points)
    {
      TreeBox box;
      for (const Point &p : points)
        box.add(p);
      return box;
    }

    /// Barycentric coordinates of the point of a triangle that is closest to @p p (Ericson 2005, section 5.1.5).
    std::array<double, 3> closest_point(const Point &p, const Point &a, const Point &b, const Point &c)
    {
      const Vector3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
      const double  d1 = ab * ap, d2 = ac * ap, d3 = ab * bp, d4 = ac * bp, d5 = ab * cp, d6 = ac * cp;
      if (d1 <= 0. && d2 <= 0.)
        return {{1., 0., 0.}};
      if (d3 >= 0. && d4 <= d3)
        return {{0., 1., 0.}};
      if (d6 >= 0. && d5 <= d6)
        return {{0., 0., 1.}};
      const double of_c = d1 * d4 - d3 * d2, of_b = d5 * d2 - d1 * d6, of_a = d3 * d6 - d5 * d4;
      if (of_c <= 0. && d1 >= 0. && d3 <= 0.)
        return {{1. - d1 / (d1 - d3), d1 / (d1 - d3), 0.}};
      if (of_b <= 0. && d2 >= 0. && d6 <= 0.)
        return {{1. - d2 / (d2 - d6), 0., d2 / (d2 - d6)}};
      if (const double e = d4 - d3, f = d5 - d6; of_a <= 0. && e >= 0. && f >= 0.)
        return {{0., 1. - e / (e + f), e / (e + f)}};
      const double sum = of_a + of_b + of_c;
      return {{of_a / sum, of_b / sum, of_c / sum}};
    }

    /// A vector that changes evenly.
    struct Moving
    {
      Vector3 start, change;
      Moving(const Way &to, const Way &from)
          : start(to[0] - from[0])
          , change((to[1] - from[1]) - start)
      {
      }
      Vector3 at(const double t) const
      {
        return start + t * change;
      }
    };

    /// Where in [0, 1] a cubic polynomial changes its sign, in ascending order, and whether it was positive before.
    std::vector<std::pair<double, bool>> sign_changes(const std::array<double, 4> &c)
    {
      const auto          value = [&](const double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); };
      std::vector<double> ends{0.};
      const double        a = 3. * c[3], b = 2. * c[2], discriminant = b * b - 4. * a * c[1];
      if (discriminant > 0.)
      {
        const double        q       = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
        std::vector<double> extrema = {a != 0. ? q / a : -1., q != 0. ? c[1] / q : -1.};
        std::sort(extrema.begin(), extrema.end());
        for (const double t : extrema)
          if (t > 0. && t < 1.)
            ends.push_back(t);
      }
      ends.push_back(1.);
      std::vector<std::pair<double, bool>> changes;
      for (unsigned int i = 0; i + 1 < ends.size(); ++i)
      {
        double low = ends[i], high = ends[i + 1];
        if ((value(low) > 0.) == (value(high) > 0.))
          continue;
        const bool positive = value(low) > 0.;
        for (unsigned int bisection = 0; bisection < 50; ++bisection)
        {
          const double middle                             = 0.5 * (low + high);
          ((value(middle) > 0.) == positive ? low : high) = middle;
        }
        changes.emplace_back(high, positive);
      }
      return changes;
    }

    /// Whether it cannot change its sign in [0, 1]: it lies between the least and the largest of its Bernstein
    /// coefficients.
    bool keeps_sign(const std::array<double, 4> &c)
    {
      const double b[4] = {c[0], c[0] + c[1] / 3., c[0] + (2. * c[1] + c[2]) / 3., c[0] + c[1] + c[2] + c[3]};
      return std::min({b[0], b[1], b[2], b[3]}) > 0. || std::max({b[0], b[1], b[2], b[3]}) < 0.;
    }
  } // namespace

  std::vector<Crossing> find_crossings(const Way &p, const Way &a, const Way &b, const Way &c)
  {
    const Moving q(p, a), e(b, a), f(c, a);
    // the volume q . (e x f), which vanishes while the point is in the plane of the triangle
    const Vector3 n[3] = {
        cross(e.start, f.start), cross(e.start, f.change) + cross(e.change, f.start), cross(e.change, f.change)};
    const std::array<double, 4> volume = {
        {q.start * n[0], q.start * n[1] + q.change * n[0], q.start * n[2] + q.change * n[1], q.change * n[2]}};
    std::vector<Crossing> found;
    if (keeps_sign(volume))
      return found;
    for (const auto &[t, was_outside] : sign_changes(volume))
    {
      const Vector3 r = q.at(t), along = e.at(t), across = f.at(t), normal = cross(along, across);
      const double  area = normal * normal;
      const double  of_b = cross(r, across) * normal / area, of_c = cross(along, r) * normal / area;
      if (area > 0. && of_b >= -slack && of_c >= -slack && of_b + of_c <= 1. + slack)
        found.push_back(
            {t, was_outside, std::abs((q.change - of_b * e.change - of_c * f.change) * normal) / std::sqrt(area)});
    }
    return found;
  }

  Triangles::Triangles(const std::vector<SurfaceFace> &faces,
                       const unsigned int              rank,
                       const unsigned int              degree,
                       const std::vector<Point>       &x,
                       const std::vector<SurfaceNode> *nodes)
      : x_(x)
      , normals_(x.size())
      , on_rim_(x.size(), 0)
  {
    std::vector<Triangle> all;
    std::vector<char>     own;
    for (const SurfaceFace &face : faces)
      for (unsigned int j = 0; j < degree; ++j)
        for (unsigned int i = 0; i < degree; ++i)
        {
          const unsigned int first = i + j * (degree + 1), n[4] = {face.nodes[first],
                                                                   face.nodes[first + 1],
                                                                   face.nodes[first + degree + 2],
                                                                   face.nodes[first + degree + 1]};
          const bool         turn = face.orientation < 0.;
          for (const auto &[b, c] : {std::make_pair(1u, 2u), {2u, 3u}})
          {
            all.push_back({{{n[0], n[turn ? c : b], n[turn ? b : c]}}, {{false, false, false}}, &face});
            own.push_back(face.owner == rank);
          }
        }
    using Edge      = std::uint64_t; // both nodes, the lower one first
    const auto edge = [](const Triangle &triangle, const unsigned int opposite)
    {
      const unsigned int a = triangle.nodes[(opposite + 1) % 3], b = triangle.nodes[(opposite + 2) % 3];
      return Edge(std::min(a, b)) << 32 | std::max(a, b);
    };
    std::vector<std::pair<Edge, unsigned int>> edges; // with three times the triangle and the corner opposite to it
    edges.reserve(3 * all.size());
    for (unsigned int i = 0; i < all.size(); ++i)
    {
      const Triangle    &triangle = all[i];
      const Point *const p[3]     = {&x[triangle.nodes[0]], &x[triangle.nodes[1]], &x[triangle.nodes[2]]};
      const Vector3      area     = cross(*p[1] - *p[0], *p[2] - *p[0]);
      for (unsigned int v = 0; v < 3; ++v)
      {
        normals_[triangle.nodes[v]] += area;
        edges.emplace_back(edge(triangle, v), 3 * i + v);
      }
    }
    std::sort(edges.begin(), edges.end());
    for (unsigned int e = 0; e < edges.size(); ++e)
      if ((e == 0 || edges[e - 1].first != edges[e].first) &&
          (e + 1 == edges.size() || edges[e + 1].first != edges[e].first))
      {
        const unsigned int v                 = edges[e].second % 3;
        Triangle          &triangle          = all[edges[e].second / 3];
        triangle.rim[v]                      = true;
        on_rim_[triangle.nodes[(v + 1) % 3]] = on_rim_[triangle.nodes[(v + 2) % 3]] = true;
      }
    std::vector<TreeBox> boxes;
    for (unsigned int i = 0; i < all.size(); ++i)
    {
      const Triangle &triangle = all[i];
      if (!own[i])
        continue;
      boxes.push_back(box_of({x[triangle.nodes[0]], x[triangle.nodes[1]], x[triangle.nodes[2]]}));
      box_.add(boxes.back());
      nodes_.insert(nodes_.end(), triangle.nodes.begin(), triangle.nodes.end());
      triangles_.push_back(triangle);
    }
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    for (Vector3 &normal : normals_)
      if (const double length = normal.norm(); length > 0.)
        normal /= length;
    tree_ = BoxTree(std::move(boxes));
    if (nodes != nullptr)
      know_nodes(faces, degree, *nodes);
  }

  void Triangles::know_nodes(const std::vector<SurfaceFace> &faces,
                             const unsigned int              degree,
                             const std::vector<SurfaceNode> &nodes)
  {
    own_.resize(x_.size());
    for (const unsigned int n : nodes_)
    {
      own_[n].nodes.push_back(nodes[n].dofs[0]);
      for (const auto &[master, weight] : nodes[n].masters)
        own_[n].nodes.push_back(nodes[master].dofs[0]);
      own_[n].outward = normals_[n];
      own_[n].visible = std::numeric_limits<double>::max();
    }
    for (const SurfaceFace &face : faces)
      for (unsigned int n = 0; n < face.nodes.size(); ++n)
        if (!own_[face.nodes[n]].nodes.empty())
        {
          auto &elsewhere = own_[face.nodes[n]].elsewhere;
          for (const unsigned int side : face.elsewhere)
            if (std::find(elsewhere.begin(), elsewhere.end(), side) == elsewhere.end())
              elsewhere.push_back(side);
          double      &visible = own_[face.nodes[n]].visible;
          const double xi = double(n % (degree + 1)) / degree, eta = double(n / (degree + 1)) / degree;
          visible = std::min(
              visible, OwnNode::visible_depth * SelfContact::thickness(face, nodes, x_, x_[face.nodes[n]], xi, eta));
        }
  }

  OwnNode Triangles::own_node(const unsigned int node) const
  {
    return own_.empty() ? OwnNode() : own_[node];
  }

  double Triangles::least_visible() const
  {
    double least = std::numeric_limits<double>::max();
    for (const OwnNode &own : own_)
      if (!own.nodes.empty())
        least = std::min(least, own.visible);
    return least;
  }

  bool Triangles::is_at(const Triangle &triangle, const OwnNode &own) const
  {
    for (const unsigned int n : triangle.face->nodes)
      for (const DoFIndex node : own.nodes)
        if (std::count(own_[n].nodes.begin(), own_[n].nodes.end(), node) > 0)
          return true;
    return false;
  }

  /// What looks for its own wall meets what it does not touch.
  bool Triangles::may_meet(const Triangle &triangle, const OwnNode &own) const
  {
    return !is_at(triangle, own) && (own.least > 0. || !meet_elsewhere(own.elsewhere, triangle.face->elsewhere));
  }

  Height Triangles::height(const Triangle &triangle, const Point &p) const
  {
    const auto  &n     = triangle.nodes;
    const auto   share = closest_point(p, x_[n[0]], x_[n[1]], x_[n[2]]);
    Vector3      r(p);
    Vector3      mean;
    Height       result;
    unsigned int at = 3, zeros = 0; // the corner that counts, the edge opposite to which p is nearest to
    for (unsigned int v = 0; v < 3; ++v)
    {
      r -= share[v] * x_[n[v]];
      mean += share[v] * normals_[n[v]];
      zeros += share[v] == 0.;
    }
    for (unsigned int v = 0; v < 3; ++v)
      if ((zeros == 1 && share[v] == 0.) || (zeros == 2 && share[v] != 0.))
        at = v;
    result.distance = r.norm();
    result.over     = zeros == 0 || (zeros == 1 ? !triangle.rim[at] : !on_rim_[n[at]]);
    // inside the triangle its own normal decides, at its edges and corners the mean of those around
    result.normal = zeros == 0 ? cross(x_[n[1]] - x_[n[0]], x_[n[2]] - x_[n[0]]) : mean;
    result.behind = r * result.normal < 0.;
    result.normal /= result.normal.norm();
    return result;
  }

  bool Triangles::counts(const Triangle &triangle, const Height &height, const OwnNode &own) const
  {
    if ((own.outward != Vector3() && height.normal * own.outward > SelfContact::averted_cosine) ||
        !may_meet(triangle, own))
      return false;
    if (own.least > 0.)
      return height.behind && height.distance > own.least;
    double visible = own.visible;
    for (const unsigned int n : triangle.nodes)
      visible = std::min(visible, own_[n].visible);
    return !height.behind || height.distance <= visible;
  }

  void Triangles::follow_face(const Triangle &triangle, const Point &p, Height &height) const
  {
    const SurfaceFace &face   = *triangle.face;
    const unsigned int degree = face.nodes.size() == 4 ? 1 : 2;
    const auto         share  = closest_point(p, x_[triangle.nodes[0]], x_[triangle.nodes[1]], x_[triangle.nodes[2]]);
    double             xi = 0., eta = 0.;
    Vector3            flat;
    for (unsigned int v = 0; v < 3; ++v)
    {
      const unsigned int n = std::find(face.nodes.begin(), face.nodes.end(), triangle.nodes[v]) - face.nodes.begin();
      xi += share[v] * (n % (degree + 1)) / degree;
      eta += share[v] * (n / (degree + 1)) / degree;
      flat += share[v] * x_[triangle.nodes[v]];
    }
    const double rise    = (FaceGeometry(face, FaceShape(degree, xi, eta), x_).x - flat) * height.normal;
    const double outside = (height.behind ? -height.distance : height.distance) - rise;
    height.distance      = std::abs(outside);
    height.behind        = outside < 0.;
  }

  Height Triangles::height(const Point &p, const double reach, const OwnNode &own) const
  {
    Height       nearest;
    unsigned int triangle = 0;
    nearest.distance      = reach;
    tree_.nearest(p,
                  reach * reach,
                  [&](const unsigned int t, double)
                  {
                    const Height here = height(triangles_[t], p);
                    if (here.distance < nearest.distance && (own.nodes.empty() || counts(triangles_[t], here, own)))
                    {
                      nearest  = here;
                      triangle = t;
                    }
                    return nearest.distance * nearest.distance;
                  });
    if (!(nearest.distance < reach))
      return Height();
    if (nearest.over)
      follow_face(triangles_[triangle], p, nearest);
    return nearest;
  }

  std::vector<std::vector<Crossing>> Triangles::crossings(const std::vector<Way>     &ways,
                                                          const std::vector<Point>   &before,
                                                          const std::vector<OwnNode> &own) const
  {
    std::vector<std::vector<Crossing>> result(ways.size());
    if (ways.empty())
      return result;
    std::vector<TreeBox> swept;
    swept.reserve(triangles_.size());
    for (const Triangle &triangle : triangles_)
    {
      const auto &n = triangle.nodes;
      swept.push_back(box_of({x_[n[0]], x_[n[1]], x_[n[2]], before[n[0]], before[n[1]], before[n[2]]}));
    }
    const BoxTree tree(std::move(swept));
    for (unsigned int w = 0; w < ways.size(); ++w)
    {
      tree.meeting(box_of({ways[w][0], ways[w][1]}),
                   [&](const unsigned int t)
                   {
                     const auto &n   = triangles_[t].nodes;
                     const auto  way = [&](const unsigned int v) { return Way{{before[n[v]], x_[n[v]]}}; };
                     if (!own[w].nodes.empty() && !may_meet(triangles_[t], own[w]))
                       return;
                     for (const Crossing &crossing : find_crossings(ways[w], way(0), way(1), way(2)))
                       result[w].push_back(crossing);
                   });
    }
    return result;
  }
} // namespace Nodus
