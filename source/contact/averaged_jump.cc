#include "contact/averaged_jump.h"
#include "contact/face_integral.h"
#include "contact/face_rule.h"
#include "contact/segments.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Covered fraction of a face at which psi starts to turn from the hats to the dual functions. The dual functions
    /// of a quadratic face keep positive integrals down to here.
    constexpr double dual_coverage = 0.75;
    /// The same, of the areas that its points integrate, at which these turn to those of the whole face.
    constexpr double exact_coverage = 0.999;

    /// From 0 at @p begin to 1 where all is covered but for round-off.
    constexpr double round_off = 1e-8;
    double           grown(const double covered, const double begin)
    {
      return std::clamp((covered - begin) / (1. - begin - round_off), 0., 1.);
    }
    double growth(const double covered, const double begin)
    {
      const double part = grown(covered, begin);
      return part > 0. && part < 1. ? 1. / (1. - begin - round_off) : 0.;
    }
    /// A node with this part of its surface covered, or more, gets a constraint of its own, and keeps it down to the
    /// second: an equilibrium in which it goes with it and comes back without is found by no iteration. Where a corner
    /// of the master lies at a node a quarter is covered.
    constexpr double well_covered = 0.2, still_covered = 0.1;
    /// Less of the node's surface than this has no partner worth a constraint.
    constexpr double smallest_coverage = 2e-2;
    /// Entries of the slave part below this are round-off of the biorthogonality.
    constexpr double smallest_entry = 1e-13;

    /// The closest master point of a point of slave face @p f, of a rigid master empty: whoever needs it finds it
    /// again. @returns the part of the slave point that counts: beyond the rim it fades out (eq. J7), and is 0 where
    /// there is no partner.
    double find_partner(const ContactGeometry &geometry,
                        const unsigned int     pair,
                        const unsigned int     f,
                        const double           xi,
                        const double           eta,
                        Projection            &at)
    {
      const Point   x      = geometry.slave[pair].at(f, xi, eta).x;
      const Vector3 normal = geometry.slave[pair].normal(f, xi, eta);
      if (geometry.rigid[pair] != nullptr)
      {
        const RigidPoint point    = geometry.closest_on_rigid(pair, x, normal);
        const double     overhang = point.overhang > 0. ? point.overhang / geometry.overhang[pair] : 0.;
        return point.found ? ContactGeometry::counted_part(overhang) : 0.;
      }
      at = geometry.closest_to_face(pair, f, xi, eta, x, normal);
      return at.found() ? ContactGeometry::counted_part(geometry.search[pair].overhang(at, x).norm()) : 0.;
    }

    /// Points of a fixed rule with their closest master points; returns the covered fraction, in local coordinates: it
    /// follows the points at the rim alone.
    double face_points(const ContactGeometry       &geometry,
                       const unsigned int           pair,
                       const unsigned int           f,
                       const dealii::Quadrature<2> &rule,
                       std::vector<MortarPoint>    &points)
    {
      double covered = 0.;
      points.clear();
      for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const double xi = rule.point(q)[0], eta = rule.point(q)[1];
        Projection   master;
        const double counts = find_partner(geometry, pair, f, xi, eta, master);
        covered += counts * rule.weight(q);
        if (counts > 0.)
          points.push_back({xi, eta, counts * rule.weight(q), master});
      }
      return covered;
    }

    /// A hanging node is where those are that it follows, but for its reference position.
    void add_entry(const ContactSurfaces            &surfaces,
                   std::vector<AveragedJump::Entry> &entries,
                   const unsigned int                node,
                   const double                      weight,
                   Vector3                          &offset)
    {
      surfaces.expand(node,
                      weight,
                      [&](const unsigned int free_node, const double part)
                      {
                        for (auto &entry : entries)
                          if (entry.node == free_node)
                          {
                            entry.weight += part;
                            return;
                          }
                        entries.push_back({free_node, part});
                      });
      offset += weight * surfaces.nodes()[node].offset;
    }

    /// Whether points come from overlaps rather than from a rule.
    bool has_segments(const ContactPairParameters &pair, const ContactGeometry &geometry, const unsigned int p)
    {
      return geometry.rigid[p] == nullptr && pair.integration == ContactPairParameters::Integration::segment;
    }

    /// Whether a pair has averaged jumps, and acts.
    bool
    averages(const std::vector<ContactPairParameters> &pairs, const ContactSurfaces &surfaces, const unsigned int p)
    {
      return pairs[p].scheme == ContactPairParameters::Scheme::averaged && surfaces.acts(p);
    }

    /// A surface that touches itself goes around the edges of bodies. What looks elsewhere than the covered faces at a
    /// node is not of the surface around it that these are a part of.
    void leave_out_beyond_edges(const ContactSurfaces &surfaces, std::vector<FaceRows> &faces)
    {
      std::vector<Vector3> normal(surfaces.slave_nodes().size()); // of the covered parts, complete for owned nodes
      const auto           for_each = [&](const auto &f)
      {
        for (FaceRows &face : faces)
        {
          if (!surfaces.touches_itself(face.pair))
            continue;
          const std::vector<unsigned int> slaves    = slaves_of(surfaces, face);
          const unsigned int              n_columns = face.nodes.size() + 2;
          for (unsigned int a = 0; a < slaves.size(); ++a)
            f(face, a, normal[slaves[a]], face.weights.data() + (a + 1) * n_columns - 2);
        }
      };
      for_each(
          [](const FaceRows &face, const unsigned int a, Vector3 &n, const double *)
          {
            for (unsigned int c = 0; c < dim; ++c)
              n[c] += face.vectors[FaceRows::n_vectors * a + dim + c];
          });
      for_each(
          [](const FaceRows &face, const unsigned int, const Vector3 &n, double *const area)
          {
            const Vector3 outward({face.outward[0], face.outward[1], face.outward[2]});
            if (area[0] == 0. && n != Vector3())
              area[1] *= facing(outward * n / n.norm()).part;
          });
    }

    /// Sums over faces become means; a node with next to no partner loses its row.
    void normalise(AveragedJump::Row &row)
    {
      if (!(row.area > smallest_coverage * row.whole))
      {
        row = AveragedJump::Row();
        return;
      }
      for (auto *const entries : {&row.slave, &row.master})
      {
        for (AveragedJump::Entry &entry : *entries)
          entry.weight /= row.area;
        entries->erase(std::remove_if(entries->begin(),
                                      entries->end(),
                                      [](const AveragedJump::Entry &e) { return std::abs(e.weight) < smallest_entry; }),
                       entries->end());
        std::sort(entries->begin(),
                  entries->end(),
                  [](const AveragedJump::Entry &a, const AveragedJump::Entry &b) { return a.node < b.node; });
      }
      for (Vector3 *const v : {&row.offset, &row.rigid.x, &row.rigid.moved})
        *v /= row.area;
      row.normal /= row.normal.norm();
    }
  } // namespace

  std::array<double, 9> AveragedJump::hats(const unsigned int degree, const double xi, const double eta)
  {
    double s[2][3];
    for (unsigned int d = 0; d < 2; ++d)
      for (unsigned int i = 0; i <= degree; ++i)
        s[d][i] = std::max(0., 1. - std::abs(degree * (d == 0 ? xi : eta) - i));
    std::array<double, 9> result{};
    for (unsigned int j = 0, n = 0; j <= degree; ++j)
      for (unsigned int i = 0; i <= degree; ++i, ++n)
        result[n] = s[0][i] * s[1][j];
    return result;
  }

  double AveragedJump::Face::dual_part() const
  {
    return grown(coverage.fraction, dual_coverage);
  }

  double AveragedJump::Face::dual_slope() const
  {
    return growth(coverage.fraction, dual_coverage);
  }

  double AveragedJump::Face::exact_part() const
  {
    return grown(coverage.fraction, exact_coverage);
  }

  double AveragedJump::Face::exact_slope() const
  {
    return growth(coverage.fraction, exact_coverage);
  }

  void AveragedJump::find_points(const ContactPairParameters &pair,
                                 const ContactGeometry       &geometry,
                                 const dealii::Quadrature<2> &rule,
                                 Face                        &face)
  {
    const unsigned int p = face.pair, f = face.face;
    if (has_segments(pair, geometry, p))
      face.coverage = segment_points(geometry, p, f, face.points, face.trace);
    else
      face.coverage = {face_points(geometry, p, f, rule, face.points)};
  }

  /// Decides which nodes share out their parts. Collective.
  void AveragedJump::share_out(const ContactSurfaces &surfaces, const std::vector<FaceRows> &faces)
  {
    std::vector<std::array<double, 2>> areas(rows_.size(), {{0., 0.}}); // covered, whole
    const auto                         for_each_area = [&](const auto &f)
    {
      for (const FaceRows &face : faces)
      {
        const std::vector<unsigned int> slaves    = slaves_of(surfaces, face);
        const unsigned int              n_columns = face.nodes.size() + 2;
        for (unsigned int a = 0; a < slaves.size(); ++a)
          if (surfaces.is_owned(slaves[a]))
            f(slaves, slaves[a], face.weights.data() + (a + 1) * n_columns - 2);
      }
    };
    for_each_area(
        [&](const std::vector<unsigned int> &, const unsigned int k, const double *const area)
        {
          for (unsigned int i = 0; i < 2; ++i)
            areas[k][i] += area[i];
        });
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
      cover_[k] = !(areas[k][0] > 0.)                                                             ? Cover::little
                  : areas[k][0] >= (constrained_[k] ? still_covered : well_covered) * areas[k][1] ? Cover::well
                                                                                                  : Cover::shared_out;
    surfaces.slave_exchange().update(cover_);
    std::vector<unsigned int> alone;
    for_each_area(
        [&](const std::vector<unsigned int> &slaves, const unsigned int k, const double *const area)
        {
          if (area[0] > 0. && std::none_of(slaves.begin(),
                                           slaves.end(),
                                           [&](const unsigned int j) { return cover_[j] == Cover::well; }))
            alone.push_back(k);
        });
    for (const unsigned int k : alone)
      cover_[k] = Cover::little;
    surfaces.slave_exchange().update(cover_);
  }

  /// Adds what a face has to the rows of its slave nodes that are here.
  void AveragedJump::add(const ContactSurfaces &surfaces, const FaceRows &face)
  {
    const std::vector<unsigned int> slaves    = slaves_of(surfaces, face);
    const unsigned int              n         = (surfaces.degree() + 1) * (surfaces.degree() + 1);
    const unsigned int              n_columns = face.nodes.size() + 2;
    for (const unsigned int k : slaves)
    {
      if (!surfaces.is_owned(k) || shared_out(k))
        continue;
      Row &row = rows_[k];
      for_each_part(
          slaves,
          k,
          [&](const unsigned int a, const double part)
          {
            const double *const w = face.weights.data() + a * n_columns;
            for (unsigned int b = 0; b < face.nodes.size(); ++b)
              if (w[b] != 0.)
                add_entry(
                    surfaces, b < n ? row.slave : row.master, surfaces.node(face.nodes[b]), part * w[b], row.offset);
            row.area += part * w[n_columns - 2];
            if (slaves[a] == k)
              row.whole += w[n_columns - 1];
            for (unsigned int c = 0; c < dim; ++c)
            {
              const double *const v = face.vectors.data() + FaceRows::n_vectors * a + c;
              row.offset[c] += part * v[0];
              row.normal[c] += part * v[dim];
              row.rigid.x[c] += part * v[2 * dim];
              row.rigid.moved[c] += part * v[3 * dim];
            }
          });
    }
  }

  /// Finds the points of this rank's faces and integrates over them. Most of a surface that touches itself is near
  /// nothing: a face without points has an area at nodes that other faces have points around, and counts nowhere else.
  /// Collective.
  std::vector<FaceRows> AveragedJump::integrate(const std::vector<ContactPairParameters> &pairs,
                                                const ContactSurfaces                    &surfaces,
                                                const ContactGeometry                    &geometry,
                                                const std::vector<Point>                 &x,
                                                const std::vector<Point>                 &X)
  {
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(surfaces.layout().communicator);
    faces_.clear();
    Face                                               face{};
    std::vector<std::pair<unsigned int, unsigned int>> empty;       // pairs and faces
    std::vector<double> covered(surfaces.slave_nodes().size(), 0.); // faces with points around each node
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (!averages(pairs, surfaces, p))
        continue;
      const auto rule =
          has_segments(pairs[p], geometry, p) ? dealii::Quadrature<2>() : face_rule(pairs[p], surfaces.degree());
      for (unsigned int f = 0; f < geometry.slave[p].n_faces(); ++f)
      {
        if (geometry.slave[p].face(f).owner != rank)
          continue;
        face.pair = p;
        face.face = f;
        find_points(pairs[p], geometry, rule, face);
        if (face.points.empty())
        {
          empty.emplace_back(p, f);
          continue;
        }
        faces_.push_back(std::move(face));
        for (const unsigned int k : geometry.slave[p].face(f).slaves)
          covered[k] += 1.;
      }
    }
    surfaces.slave_exchange().sum(covered);

    std::vector<FaceRows> mine;
    const auto            take = [&](const Face &f)
    {
      const bool current = pairs[f.pair].surface_measure == ContactPairParameters::SurfaceMeasure::current;
      mine.push_back(integrate_face(pairs[f.pair], surfaces, geometry, f, current ? x : X));
    };
    for (const Face &f : faces_)
      take(f);
    for (const auto &[p, f] : empty)
    {
      const auto &slaves = geometry.slave[p].face(f).slaves;
      if (std::any_of(slaves.begin(), slaves.end(), [&](const unsigned int k) { return covered[k] > 0.; }))
        take({p, f, {}, {}, {}});
    }
    return collect(surfaces, std::move(mine));
  }

  void AveragedJump::compute(const std::vector<ContactPairParameters> &pairs,
                             const ContactSurfaces                    &surfaces,
                             const ContactGeometry                    &geometry,
                             const std::vector<Point>                 &x,
                             const std::vector<Point>                 &X)
  {
    rows_.assign(surfaces.slave_nodes().size(), Row());
    cover_.assign(rows_.size(), Cover::well);
    constrained_.resize(rows_.size(), false);
    faces_.clear();
    bool any = false;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      any = any || averages(pairs, surfaces, p);
    if (!any)
      return;
    std::vector<FaceRows> around = integrate(pairs, surfaces, geometry, x, X);
    leave_out_beyond_edges(surfaces, around);
    share_out(surfaces, around);
    for (const FaceRows &face : around)
      add(surfaces, face);
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
    {
      normalise(rows_[k]);
      constrained_[k] = covered(k);
    }

    std::vector<double> area(rows_.size());
    for (unsigned int k = 0; k < rows_.size(); ++k)
      area[k] = rows_[k].area;
    surfaces.slave_exchange().update(area);
    for (unsigned int k = 0; k < rows_.size(); ++k)
      rows_[k].area = area[k];
  }
} // namespace Nodus
