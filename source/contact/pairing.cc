#include <nodus/contact/pairing.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Nodus
{
  namespace
  {
    /// A relative motion is free when the unconstrained nodes carry at least this much of the jump's weight: a node on
    /// a symmetry plane that projects slightly inside still moves with the plane.
    constexpr double free_weight = 0.1;

    /// Master faces looking along the slave's outward normal (cosine above this) are the far side of a body.
    constexpr double far_side_cosine = 0.5;

    struct ProjectionRecord
    {
      double       xi, eta;
      unsigned int face;

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &xi &eta &face;
      }
    };

    /// What a master surface offers to the search at the current positions.
    struct MasterSurface
    {
      using Leaf = std::pair<dealii::BoundingBox<dim>, unsigned int>;
      std::vector<std::array<bool, 4>>                  boundary_edge; ///< xi = 0, 1, eta = 0, 1
      decltype(dealii::pack_rtree(std::vector<Leaf>())) tree;
      std::vector<Vector3>                              centre_normal; ///< outward unit normal at the face centre
      std::vector<double>                               size;

      MasterSurface(const std::vector<SurfaceFace> &faces, const unsigned int degree, const std::vector<Point> &x)
          : boundary_edge(faces.size())
      {
        std::map<std::pair<unsigned int, unsigned int>, unsigned int> count;
        const auto edge = [&](const SurfaceFace &face, const unsigned int e)
        {
          const unsigned int n = degree + 1, last = n * n - 1;
          const unsigned int ends[4][2] = {{0, n * degree}, {degree, last}, {0, degree}, {n * degree, last}};
          return std::make_pair(std::min(face.nodes[ends[e][0]], face.nodes[ends[e][1]]),
                                std::max(face.nodes[ends[e][0]], face.nodes[ends[e][1]]));
        };
        for (const auto &face : faces)
          for (unsigned int e = 0; e < 4; ++e)
            ++count[edge(face, e)];

        const FaceShape   centre(degree, 0.5, 0.5);
        std::vector<Leaf> leaves;
        for (unsigned int f = 0; f < faces.size(); ++f)
        {
          for (unsigned int e = 0; e < 4; ++e)
            boundary_edge[f][e] = count[edge(faces[f], e)] == 1;
          const Vector3 area = faces[f].orientation * FaceGeometry(faces[f], centre, x).area_vector();
          centre_normal.push_back(area / area.norm());
          size.push_back(std::sqrt(area.norm()));
          std::vector<Point> corners;
          for (const unsigned int n : faces[f].nodes)
            corners.push_back(x[n]);
          dealii::BoundingBox<dim> box(corners);
          // a quadratic face may bulge beyond the box of its nodes by an eighth of its size
          box.extend(degree == 1 ? 0. : size.back() / 8);
          leaves.emplace_back(box, f);
        }
        tree = dealii::pack_rtree(leaves);
      }
    };

    double squared_distance(const dealii::BoundingBox<dim> &box, const Point &p)
    {
      double d2 = 0;
      for (unsigned int c = 0; c < dim; ++c)
      {
        const double d = std::max({box.lower_bound(c) - p[c], 0., p[c] - box.upper_bound(c)});
        d2 += d * d;
      }
      return d2;
    }

    /// Averaged outward unit normals at surface nodes, weighted with the area that each face gives to the node.
    void add_nodal_normals(const std::vector<SurfaceFace> &faces,
                           const unsigned int              degree,
                           const std::vector<Point>       &x,
                           std::vector<Vector3>           &normals)
    {
      for (const auto &face : faces)
        for (unsigned int n = 0; n < face.nodes.size(); ++n)
        {
          const double s = 1. / degree;
          normals[face.nodes[n]] +=
              face.orientation *
              FaceGeometry(face, FaceShape(degree, s * (n % (degree + 1)), s * (n / (degree + 1))), x).area_vector();
        }
    }

    /// Finds the closest master point of one slave node; face stays invalid when there is none.
    ProjectionRecord find_projection(const MasterSurface            &master,
                                     const std::vector<SurfaceFace> &faces,
                                     const unsigned int              degree,
                                     const std::vector<Point>       &x,
                                     const Point                    &p,
                                     const Vector3                  &slave_normal,
                                     const double                    reach,
                                     const double                    tolerance)
    {
      namespace bgi = boost::geometry::index;
      ProjectionRecord best{0., 0., dealii::numbers::invalid_unsigned_int};
      double           best_distance = reach * reach;
      for (auto leaf = master.tree.qbegin(bgi::nearest(p, faces.size())); leaf != master.tree.qend(); ++leaf)
      {
        if (squared_distance(leaf->first, p) > best_distance)
          break; // boxes come in ascending distance
        const unsigned int f = leaf->second;
        if (master.centre_normal[f] * slave_normal > far_side_cosine)
          continue;
        double       xi, eta;
        const double d2 = closest_point(faces[f], degree, x, p, xi, eta);
        // neighbours share an edge point: the lower face index decides, on every rank alike
        const double tie = 1e-12 * master.size[f] * master.size[f];
        if (d2 < best_distance - tie || (d2 < best_distance + tie && f < best.face))
        {
          best_distance = std::min(d2, best_distance);
          best          = {xi, eta, f};
        }
      }
      if (best.face == dealii::numbers::invalid_unsigned_int)
        return best;

      // A node beyond the rim of the master surface has no partner, but for a small overhang.
      const auto &rim    = master.boundary_edge[best.face];
      const bool  on_rim = (best.xi <= 0. && rim[0]) || (best.xi >= 1. && rim[1]) || (best.eta <= 0. && rim[2]) ||
                          (best.eta >= 1. && rim[3]);
      if (on_rim)
      {
        const FaceGeometry geometry(faces[best.face], FaceShape(degree, best.xi, best.eta), x);
        const Vector3      n = geometry.area_vector() / geometry.area_vector().norm();
        const Vector3      r = p - geometry.x;
        if ((r - (r * n) * n).norm() > tolerance * master.size[best.face])
          best.face = dealii::numbers::invalid_unsigned_int;
      }
      return best;
    }

    /// The frame around the geometric normal @p direction: tangents are orthogonal to its part in the free directions and
    /// lie in them, so that normal and tangential rows never repeat each other. The normal itself stays as it is: its held
    /// components drop out of the rows, and lambda stays a pressure. found = false when no normal motion is left.
    void set_frame(const Vector3 &direction, const std::array<bool, dim> &free, NodePairing &pairing)
    {
      Vector3      n      = direction;
      unsigned int n_free = 0;
      for (unsigned int c = 0; c < dim; ++c)
      {
        n_free += free[c];
        if (!free[c])
          n[c] = 0;
      }
      pairing.normal = direction;
      pairing.found  = n.norm() > free_weight;
      n              = pairing.found ? n / n.norm() : direction;

      // As in Abaqus, the first tangent is the projection of the global x axis, or z where x is nearly normal.
      const unsigned int axis = std::abs(n[0]) > 0.999 ? 2 : 0;
      Vector3            t    = -n[axis] * n;
      t[axis] += 1.;
      if (pairing.found && n_free == 2)
      {
        Vector3 held;
        for (unsigned int c = 0; c < dim; ++c)
          held[c] = free[c] ? 0. : 1.;
        t = dealii::cross_product_3d(held, n);
      }
      pairing.tangent[0]   = t / t.norm();
      pairing.tangent[1]   = dealii::cross_product_3d(n, pairing.tangent[0]);
      pairing.tangent_free = {{pairing.found && n_free >= 2, pairing.found && n_free == 3}};
    }
  } // namespace

  double closest_point(const SurfaceFace        &face,
                       const unsigned int        degree,
                       const std::vector<Point> &positions,
                       const Point              &p,
                       double                   &xi,
                       double                   &eta)
  {
    xi = eta = 0.5;
    for (unsigned int iteration = 0; iteration < 50; ++iteration)
    {
      const FaceGeometry geometry(face, FaceShape(degree, xi, eta), positions);
      const Vector3      r    = p - geometry.x;
      const double       g[2] = {r * geometry.d_xi, r * geometry.d_eta};
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
    return (p - FaceGeometry(face, FaceShape(degree, xi, eta), positions).x).norm_square();
  }

  void Pairing::project(const std::vector<ContactPairParameters> &pairs,
                        const ContactSurfaces                    &surfaces,
                        const std::vector<Point>                 &x)
  {
    const unsigned int degree = surfaces.degree();
    const auto        &slaves = surfaces.slave_nodes();

    std::vector<Vector3>              slave_normals(x.size());
    std::vector<std::vector<Vector3>> master_normals(pairs.size());
    std::vector<MasterSurface>        masters;
    std::vector<double>               reach;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      add_nodal_normals(surfaces.slave_faces(p), degree, x, slave_normals);
      if (pairs[p].normal == ContactPairParameters::Normal::averaged)
      {
        master_normals[p].resize(x.size());
        add_nodal_normals(surfaces.master_faces(p), degree, x, master_normals[p]);
      }
      masters.emplace_back(surfaces.master_faces(p), degree, x);
      // automatic: a quarter of the diagonal of the master surface
      std::vector<Point> corners;
      for (const auto &face : surfaces.master_faces(p))
        for (const unsigned int n : face.nodes)
          corners.push_back(x[n]);
      const auto box = dealii::BoundingBox<dim>(corners).get_boundary_points();
      reach.push_back(pairs[p].search_distance > 0. ? pairs[p].search_distance : 0.25 * box.first.distance(box.second));
    }

    const auto                    owned = surfaces.owned_slave_nodes();
    std::vector<ProjectionRecord> mine;
    for (unsigned int k = owned.first; k < owned.second; ++k)
    {
      const unsigned int p = slaves[k].pair, i = slaves[k].node;
      const Vector3      slave_normal = slave_normals[i] / slave_normals[i].norm();
      mine.push_back(find_projection(masters[p],
                                     surfaces.master_faces(p),
                                     degree,
                                     x,
                                     x[i],
                                     slave_normal,
                                     reach[p],
                                     pairs[p].projection_tolerance));
    }
    const auto all = dealii::Utilities::MPI::all_gather(surfaces.layout().communicator, mine);

    nodes_.assign(slaves.size(), NodePairing());
    unsigned int k = 0;
    for (const auto &part : all)
      for (const ProjectionRecord &record : part)
      {
        NodePairing       &pairing = nodes_[k];
        const unsigned int p = slaves[k].pair, i = slaves[k].node;
        ++k;
        pairing.face = record.face;
        pairing.xi   = record.xi;
        pairing.eta  = record.eta;
        if (record.face == dealii::numbers::invalid_unsigned_int)
        {
          set_frame(slave_normals[i] / slave_normals[i].norm(), {{true, true, true}}, pairing);
          pairing.found        = false;
          pairing.tangent_free = {{false, false}};
          continue;
        }
        const SurfaceFace &face = surfaces.master_faces(p)[record.face];
        const FaceShape    shape(degree, record.xi, record.eta);
        Vector3            outward;
        if (pairs[p].normal == ContactPairParameters::Normal::averaged)
          for (unsigned int n = 0; n < face.nodes.size(); ++n)
            outward += shape.value[n] * master_normals[p][face.nodes[n]] / master_normals[p][face.nodes[n]].norm();
        else
          outward = face.orientation * FaceGeometry(face, shape, x).area_vector();

        std::array<bool, dim> free;
        for (unsigned int c = 0; c < dim; ++c)
        {
          double weight = surfaces.fixed(i, c) ? 0. : 1.;
          for (unsigned int n = 0; n < face.nodes.size(); ++n)
            if (!surfaces.fixed(face.nodes[n], c))
              weight += std::abs(shape.value[n]);
          free[c] = weight > free_weight;
        }
        set_frame(-outward / outward.norm(), free, pairing);
      }
  }
} // namespace Nodus
