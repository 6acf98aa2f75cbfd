#include "contact/averaged_jump.h"
#include "contact/face_rule.h"
#include "contact/segments.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <Eigen/Dense>

#include <algorithm>
#include <map>
#include <set>

namespace Nodus
{
  namespace
  {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 9, 9>;
    using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 9, 1>;

    /// Covered fraction of a face at which psi starts to turn from the hats to the dual functions. The dual functions
    /// of a quadratic face keep positive integrals down to here.
    constexpr double dual_coverage = 0.75;
    constexpr double dual_growth   = 1. / (1. - dual_coverage - 1e-8);
    /// Less of the node's surface than this has no partner worth a constraint.
    constexpr double smallest_coverage = 2e-2;
    /// Entries of the slave part below this are round-off of the biorthogonality.
    constexpr double smallest_entry = 1e-13;

    /// What a slave face adds to the rows of its slave nodes, before the division by the area.
    struct FaceRows
    {
      unsigned int          pair, number; ///< of the face
      std::vector<DoFIndex> slaves;       ///< first degrees of freedom
      std::vector<DoFIndex> nodes;        ///< likewise: nodes of the face, then master nodes
      std::vector<double>   weights;      ///< per slave node: weight of each node, area, full area
      std::vector<double>   vectors;      ///< per slave node: offset, normal, rigid part

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &pair &number &slaves &nodes &weights &vectors;
      }
    };

    /// Vectors of each node in FaceRows.
    constexpr unsigned int n_vectors = 4 * dim;

    /// Points of a fixed rule with their closest master points; returns the covered fraction.
    double face_points(const SurfaceGeometry       &slave,
                       const unsigned int           f,
                       const dealii::Quadrature<2> &rule,
                       const MasterSearch          &search,
                       const double                 reach,
                       const double                 tolerance,
                       std::vector<MortarPoint>    &points)
    {
      points.clear();
      double area = 0., covered = 0.;
      bool   inside = false;
      for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const double       xi = rule.point(q)[0], eta = rule.point(q)[1];
        const FaceGeometry geometry = slave.at(f, xi, eta);
        const double       part     = rule.weight(q) * geometry.area_vector().norm();
        area += part;
        const Projection master = search.closest(geometry.x, slave.normal(f, xi, eta), reach, tolerance);
        if (!master.found())
          continue;
        covered += part;
        inside = inside || search.closest(geometry.x, slave.normal(f, xi, eta), reach, 0.).found();
        points.push_back({xi, eta, rule.weight(q), master});
      }
      // A face of which nothing but overhang is covered would repeat the constraints of its neighbour.
      if (!inside)
        points.clear();
      return inside ? covered / area : 0.;
    }

    /// The same where the master is rigid. The master points are not kept: whoever needs them finds them again from the
    /// slave points.
    double face_points(const ContactGeometry       &geometry,
                       const unsigned int           pair,
                       const unsigned int           f,
                       const dealii::Quadrature<2> &rule,
                       std::vector<MortarPoint>    &points)
    {
      const SurfaceGeometry &slave = geometry.slave[pair];
      double                 area = 0., covered = 0.;
      for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const double       xi = rule.point(q)[0], eta = rule.point(q)[1];
        const FaceGeometry point = slave.at(f, xi, eta);
        const double       part  = rule.weight(q) * point.area_vector().norm();
        area += part;
        if (!geometry.closest_on_rigid(pair, point.x, slave.normal(f, xi, eta)).found)
          continue;
        covered += part;
        points.push_back({xi, eta, rule.weight(q), Projection()});
      }
      return covered / area;
    }

    /// The master at a point of a slave face.
    struct Partner
    {
      unsigned int          n     = 0;       ///< nodes
      const unsigned int   *nodes = nullptr; ///< of the master face, or of what carries a rigid one
      std::array<double, 9> weights;
      Vector3               normal; ///< unit, from slave to master
      Vector3               offset; ///< of a smoothed surface
      RigidPart             rigid;
    };

    Partner meshed_partner(const ContactPairParameters &pair, const SurfaceGeometry &master, const Projection &point)
    {
      const auto     &nodes = master.face(point.face).nodes;
      const FaceShape shape(master.degree(), point.xi, point.eta);
      const Vector3   normal = pair.normal == ContactPairParameters::Normal::averaged
                                   ? master.averaged_normal(point.face, point.xi, point.eta)
                                   : master.normal(point.face, point.xi, point.eta);
      return {static_cast<unsigned int>(nodes.size()),
              nodes.data(),
              shape.value,
              -normal,
              master.offset(point.face, point.xi, point.eta),
              {}};
    }

    Partner rigid_partner(const RigidSurface &master, const Point &p)
    {
      const RigidPoint point = master.closest(p);
      Partner          partner{0, nullptr, {}, -point.normal, Vector3(), master.part(point.x)};
      if (const RigidCarrier *const carrier = master.carrier())
      {
        const RigidCarrier::Weights weights = carrier->weights(point.x);
        std::copy(weights.begin(), weights.end(), partner.weights.begin());
        partner.n     = weights.size();
        partner.nodes = carrier->nodes().data();
      }
      return partner;
    }

    /// Integrates one face: what it adds to the rows of its slave nodes.
    class FaceIntegral
    {
    public:
      FaceIntegral(const ContactPairParameters &pair,
                   const ContactSurfaces       &surfaces,
                   const SurfaceGeometry       &slave,
                   const unsigned int           f,
                   const SurfaceGeometry       &master,
                   const RigidSurface *const    rigid,
                   const std::vector<Point>    &measure)
          : pair_(pair)
          , surfaces_(surfaces)
          , slave_(slave)
          , master_(master)
          , rigid_(rigid)
          , measure_(measure)
          , face_(slave.face(f))
          , f_(f)
          , n_(face_.nodes.size())
          , m_(face_.slaves.size())
          , rows_{0, face_.number, {}, {}, {}, {}}
      {
      }

      FaceRows integrate(const AveragedJump::Face &face)
      {
        const std::vector<MortarPoint> &points = face.points;
        number_nodes(points);
        make_dual_functions(points, face.dual_part());
        n_columns_ = rows_.nodes.size() + 2;
        rows_.weights.assign(m_ * n_columns_, 0.);
        rows_.vectors.assign(n_vectors * m_, 0.);
        for (unsigned int q = 0; q < points.size(); ++q)
          add_point(points[q], weight_[q]);
        take_exact_areas();
        return std::move(rows_);
      }

    private:
      /// phi and hats are those of the slave nodes: where some of the face's nodes hang they are conforming.
      template <typename Nodal>
      Column of_slaves(const Nodal &nodal) const
      {
        const auto values = face_.slave_values(nodal);
        return Eigen::Map<const Column>(values.data(), m_);
      }
      double element(const FaceShape &shape) const
      {
        return FaceGeometry(face_, shape, measure_).area_vector().norm();
      }

      /// Nodes of the face, then those of the master.
      void number_nodes(const std::vector<MortarPoint> &points)
      {
        nodes_ = face_.nodes;
        if (rigid_ != nullptr && rigid_->carrier() != nullptr)
          nodes_.insert(nodes_.end(), rigid_->carrier()->nodes().begin(), rigid_->carrier()->nodes().end());
        for (const MortarPoint &point : points)
          if (rigid_ == nullptr)
            for (const unsigned int node : master_.face(point.master.face).nodes)
              if (std::find(nodes_.begin() + n_, nodes_.end(), node) == nodes_.end())
                nodes_.push_back(node);
        for (const unsigned int node : nodes_)
          rows_.nodes.push_back(surfaces_.nodes()[node].dofs[0]);
        for (const unsigned int k : face_.slaves)
          rows_.slaves.push_back(surfaces_.nodes()[surfaces_.slave_nodes()[k].node].dofs[0]);
      }

      /// psi = part (D M^-1)^T phi + (1 - part) hat, with M and D over the covered part.
      void make_dual_functions(const std::vector<MortarPoint> &points, const double part)
      {
        Matrix mass = Matrix::Zero(m_, m_);
        Column area = Column::Zero(m_);
        weight_.resize(points.size());
        for (unsigned int q = 0; q < points.size(); ++q)
        {
          const FaceShape shape(slave_.degree(), points[q].xi, points[q].eta);
          weight_[q]       = points[q].weight * element(shape);
          const Column phi = of_slaves(shape.value);
          mass += weight_[q] * phi * phi.transpose();
          area += weight_[q] * phi;
        }
        part_ = part;
        dual_ = Matrix::Zero(m_, m_);
        if (part_ > 0.)
          dual_ = part_ * (mass.ldlt().solve(Matrix(area.asDiagonal()))).transpose();
      }

      void add_point(const MortarPoint &point, const double weight)
      {
        const unsigned int degree = slave_.degree();
        const FaceShape    shape(degree, point.xi, point.eta);
        const Column       phi     = of_slaves(shape.value);
        const Column       hat     = of_slaves(AveragedJump::hats(degree, point.xi, point.eta));
        const Column       psi     = weight * (dual_ * phi + (1. - part_) * hat);
        const Partner      partner = rigid_ == nullptr ? meshed_partner(pair_, master_, point.master)
                                                       : rigid_partner(*rigid_, slave_.at(f_, point.xi, point.eta).x);
        const Vector3      offset  = slave_.offset(f_, point.xi, point.eta) - partner.offset;
        const Vector3      normal  = pair_.normal == ContactPairParameters::Normal::slave
                                         ? slave_.averaged_normal(f_, point.xi, point.eta)
                                         : partner.normal;
        unsigned int       column[9];
        for (unsigned int b = 0; b < partner.n; ++b)
          column[b] = std::find(nodes_.begin() + n_, nodes_.end(), partner.nodes[b]) - nodes_.begin();
        for (unsigned int a = 0; a < m_; ++a)
        {
          double *const row = rows_.weights.data() + a * n_columns_;
          for (unsigned int b = 0; b < n_; ++b)
            row[b] += psi[a] * shape.value[b];
          for (unsigned int b = 0; b < partner.n; ++b)
            row[column[b]] -= psi[a] * partner.weights[b];
          row[n_columns_ - 2] += psi[a];
          for (unsigned int c = 0; c < dim; ++c)
          {
            double *const v = rows_.vectors.data() + n_vectors * a + c;
            v[0] += psi[a] * offset[c];
            v[dim] += weight * hat[a] * normal[c];
            v[2 * dim] += psi[a] * partner.rigid.x[c];
            v[3 * dim] += psi[a] * partner.rigid.moved[c];
          }
        }
      }

      /// The points on a curved face integrate its shape functions nearly, Gauss points to round-off: nodal areas of
      /// covered faces are those.
      void take_exact_areas()
      {
        static const dealii::QGauss<2> gauss(4);
        const unsigned int             degree = slave_.degree();
        Column exact = Column::Zero(m_), full = Column::Zero(m_); // areas of the dual functions, hats
        for (unsigned int q = 0; q < gauss.size(); ++q)
        {
          const FaceShape shape(degree, gauss.point(q)[0], gauss.point(q)[1]);
          const double    area = gauss.weight(q) * element(shape);
          exact += area * of_slaves(shape.value);
          full += area * of_slaves(AveragedJump::hats(degree, gauss.point(q)[0], gauss.point(q)[1]));
        }
        for (unsigned int a = 0; a < m_; ++a)
        {
          double *const row = rows_.weights.data() + a * n_columns_;
          if (part_ > 0.)
          {
            const double scale = 1. + part_ * (exact[a] / row[n_columns_ - 2] - 1.);
            for (unsigned int b = 0; b < n_columns_; ++b)
              row[b] *= scale;
            for (unsigned int c = 0; c < n_vectors; ++c)
              rows_.vectors[n_vectors * a + c] *= c / dim == 1 ? 1. : scale; // normals become unit ones
          }
          row[n_columns_ - 1] = part_ * exact[a] + (1. - part_) * full[a];
        }
      }

      const ContactPairParameters &pair_;
      const ContactSurfaces       &surfaces_;
      const SurfaceGeometry       &slave_, &master_;
      const RigidSurface *const    rigid_;
      const std::vector<Point>    &measure_;
      const SurfaceFace           &face_;
      const unsigned int           f_, n_, m_; ///< the face, its nodes and slave nodes
      FaceRows                     rows_;
      unsigned int                 n_columns_ = 0;
      std::vector<unsigned int>    nodes_;
      std::vector<double>          weight_; ///< of the points
      double                       part_ = 0.;
      Matrix                       dual_; ///< times part
    };

    /// A hanging node is where those are that it follows, but for its reference position.
    void add(const ContactSurfaces            &surfaces,
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

    /// Whoever owns a node sums over its faces, in an order that does not depend on the ranks. @p mine are those of @p
    /// faces. Collective.
    std::vector<FaceRows>
    collect(const ContactSurfaces &surfaces, const std::vector<AveragedJump::Face> &faces, std::vector<FaceRows> mine)
    {
      std::map<unsigned int, std::vector<FaceRows>> outgoing;
      for (unsigned int i = 0; i < mine.size(); ++i)
      {
        std::set<unsigned int> owners;
        for (const unsigned int k : surfaces.slave_faces(faces[i].pair)[faces[i].face].slaves)
          owners.insert(surfaces.site_owner(k));
        for (const unsigned int owner : owners)
          outgoing[owner].push_back(mine[i]);
      }
      mine.clear();
      for (auto &[other, part] : sparse_exchange(surfaces.layout().communicator, outgoing))
        mine.insert(mine.end(), part.begin(), part.end());
      std::sort(mine.begin(),
                mine.end(),
                [](const FaceRows &a, const FaceRows &b)
                { return std::make_pair(a.pair, a.number) < std::make_pair(b.pair, b.number); });
      return mine;
    }

    /// Adds a face to the rows of its slave nodes that are here, and its full areas to @p full.
    void add(const ContactSurfaces          &surfaces,
             const FaceRows                 &face,
             std::vector<AveragedJump::Row> &rows,
             std::vector<double>            &full)
    {
      const unsigned int n         = (surfaces.degree() + 1) * (surfaces.degree() + 1);
      const unsigned int n_columns = face.nodes.size() + 2;
      for (unsigned int a = 0; a < face.slaves.size(); ++a)
      {
        const unsigned int k = surfaces.slave_number(surfaces.node(face.slaves[a]));
        if (!surfaces.is_owned(k))
          continue;
        AveragedJump::Row  &row = rows[k];
        const double *const w   = face.weights.data() + a * n_columns;
        for (unsigned int b = 0; b < face.nodes.size(); ++b)
          if (w[b] != 0.)
            add(surfaces, b < n ? row.slave : row.master, surfaces.node(face.nodes[b]), w[b], row.offset);
        row.area += w[n_columns - 2];
        full[k] += w[n_columns - 1];
        for (unsigned int c = 0; c < dim; ++c)
        {
          const double *const v = face.vectors.data() + n_vectors * a + c;
          row.offset[c] += v[0];
          row.normal[c] += v[dim];
          row.rigid.x[c] += v[2 * dim];
          row.rigid.moved[c] += v[3 * dim];
        }
      }
    }

    /// Sums over faces become means; a node with next to no partner loses its row.
    void normalise(const double full_area, AveragedJump::Row &row)
    {
      if (!(row.area > smallest_coverage * full_area))
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
    return std::clamp((coverage - dual_coverage) * dual_growth, 0., 1.);
  }

  double AveragedJump::Face::dual_slope() const
  {
    const double part = dual_part();
    return part > 0. && part < 1. ? dual_growth : 0.;
  }

  void AveragedJump::find_points(const ContactPairParameters &pair,
                                 const ContactGeometry       &geometry,
                                 const dealii::Quadrature<2> &rule,
                                 Face                        &face)
  {
    const unsigned int p = face.pair, f = face.face;
    if (geometry.rigid[p] != nullptr)
      face.coverage = face_points(geometry, p, f, rule, face.points);
    else if (pair.integration == ContactPairParameters::Integration::segment)
      face.coverage = segment_points(
          geometry.slave[p], f, geometry.master[p], geometry.search[p], geometry.reach[p], face.points, face.trace);
    else
      face.coverage = face_points(
          geometry.slave[p], f, rule, geometry.search[p], geometry.reach[p], pair.projection_tolerance, face.points);
  }

  void AveragedJump::compute(const std::vector<ContactPairParameters> &pairs,
                             const ContactSurfaces                    &surfaces,
                             const ContactGeometry                    &geometry,
                             const std::vector<Point>                 &x,
                             const std::vector<Point>                 &X)
  {
    rows_.assign(surfaces.slave_nodes().size(), Row());
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(surfaces.layout().communicator);

    std::vector<FaceRows> mine;
    faces_.clear();
    bool any = false;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (pairs[p].scheme != ContactPairParameters::Scheme::averaged)
        continue;
      any                 = true;
      const auto  rule    = face_rule(pairs[p], surfaces.degree());
      const auto &measure = pairs[p].surface_measure == ContactPairParameters::SurfaceMeasure::current ? x : X;
      for (unsigned int f = 0; f < geometry.slave[p].n_faces(); ++f)
      {
        if (geometry.slave[p].face(f).owner != rank)
          continue;
        faces_.push_back({p, f, {}, {}, 0.});
        Face &face = faces_.back();
        find_points(pairs[p], geometry, rule, face);
        FaceIntegral integral(pairs[p], surfaces, geometry.slave[p], f, geometry.master[p], geometry.rigid[p], measure);
        mine.push_back(integral.integrate(face));
        mine.back().pair = p;
      }
    }
    if (!any)
      return;
    std::vector<double> full(surfaces.n_owned_slave_nodes(), 0.);
    for (const FaceRows &face : collect(surfaces, faces_, std::move(mine)))
      add(surfaces, face, rows_, full);
    for (unsigned int k = 0; k < full.size(); ++k)
      normalise(full[k], rows_[k]);

    std::vector<double> area(rows_.size());
    for (unsigned int k = 0; k < rows_.size(); ++k)
      area[k] = rows_[k].area;
    surfaces.slave_exchange().update(area);
    for (unsigned int k = 0; k < rows_.size(); ++k)
      rows_[k].area = area[k];
  }
} // namespace Nodus
