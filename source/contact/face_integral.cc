#include "contact/face_integral.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace Nodus
{
  namespace
  {
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

    /// A point of a rule on whole faces.
    struct WholePoint
    {
      double                weight;
      FaceShape             shape;
      std::array<double, 9> hats;
    };

    /// Points of a rule that is exact for areas.
    const std::vector<WholePoint> &whole_points(const unsigned int degree)
    {
      const auto make = [](const unsigned int d)
      {
        const dealii::QGauss<2> gauss(4);
        std::vector<WholePoint> points;
        for (unsigned int q = 0; q < gauss.size(); ++q)
        {
          const double xi = gauss.point(q)[0], eta = gauss.point(q)[1];
          points.push_back({gauss.weight(q), FaceShape(d, xi, eta), AveragedJump::hats(d, xi, eta)});
        }
        return points;
      };
      static const std::vector<WholePoint> points[] = {make(1), make(2)};
      return points[degree - 1];
    }

    Partner meshed_partner(const ContactPairParameters &pair,
                           const SurfaceGeometry       &master,
                           const MasterSearch          &search,
                           const Projection            &point)
    {
      const auto     &nodes = master.face(point.face).nodes;
      const FaceShape shape(master.degree(), point.xi, point.eta);
      const Vector3   normal = pair.normal == ContactPairParameters::Normal::averaged
                                   ? master.averaged_normal(point.face, point.xi, point.eta)
                                   : master.facet_normal(point.face, point.xi, point.eta, search.rim(point.face));
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
  } // namespace

  FaceIntegral::FaceIntegral(const ContactPairParameters &pair,
                             const ContactSurfaces       &surfaces,
                             const ContactGeometry       &geometry,
                             const AveragedJump::Face    &face,
                             const std::vector<Point>    &measure)
      : pair_(pair)
      , surfaces_(surfaces)
      , slave_(geometry.slave[face.pair])
      , master_(geometry.master[face.pair])
      , search_(geometry.search[face.pair])
      , rigid_(geometry.rigid[face.pair])
      , measure_(measure)
      , points_(face.points)
      , face_(slave_.face(face.face))
      , f_(face.face)
      , n_(face_.nodes.size())
      , m_(face_.slaves.size())
      , part_(face.dual_part())
      , exact_(face.exact_part())
      , counted_(face.coverage.counted)
      , rows_{face.pair, face_.number, {}, {}, {}, {}, {}}
  {
  }

  FaceRows FaceIntegral::integrate()
  {
    number_nodes();
    make_dual_functions();
    n_columns_ = rows_.nodes.size() + 2;
    rows_.weights.assign(m_ * n_columns_, 0.);
    rows_.vectors.assign(FaceRows::n_vectors * m_, 0.);
    for (unsigned int q = 0; q < points_.size(); ++q)
      add_point(points_[q], weight_[q]);
    take_exact_areas();
    const Vector3 outward = slave_.normal(f_, 0.5, 0.5);
    std::copy(outward.begin_raw(), outward.end_raw(), rows_.outward.begin());
    return std::move(rows_);
  }

  void FaceIntegral::number_nodes()
  {
    nodes_ = face_.nodes;
    if (rigid_ != nullptr && rigid_->carrier() != nullptr)
      nodes_.insert(nodes_.end(), rigid_->carrier()->nodes().begin(), rigid_->carrier()->nodes().end());
    for (const MortarPoint &point : points_)
      if (rigid_ == nullptr)
        for (const unsigned int node : master_.face(point.master.face).nodes)
          if (std::find(nodes_.begin() + n_, nodes_.end(), node) == nodes_.end())
            nodes_.push_back(node);
    for (const unsigned int node : nodes_)
      rows_.nodes.push_back(surfaces_.nodes()[node].dofs[0]);
    for (const unsigned int k : face_.slaves)
      rows_.slaves.push_back(surfaces_.nodes()[surfaces_.slave_nodes()[k].node].dofs[0]);
  }

  void FaceIntegral::make_dual_functions()
  {
    Matrix mass = Matrix::Zero(m_, m_);
    Column area = Column::Zero(m_);
    weight_.resize(points_.size());
    for (unsigned int q = 0; q < points_.size(); ++q)
    {
      const FaceShape shape(slave_.degree(), points_[q].xi, points_[q].eta);
      weight_[q]       = points_[q].weight * element(shape);
      const Column phi = of_slaves(shape.value);
      mass += weight_[q] * phi * phi.transpose();
      area += weight_[q] * phi;
    }
    dual_ = Matrix::Zero(m_, m_);
    if (part_ > 0.)
      dual_ = part_ * (mass.ldlt().solve(Matrix(area.asDiagonal()))).transpose();
  }

  void FaceIntegral::add_point(const MortarPoint &point, const double weight)
  {
    const unsigned int degree = slave_.degree();
    const FaceShape    shape(degree, point.xi, point.eta);
    const Column       phi     = of_slaves(shape.value);
    const Column       hat     = of_slaves(AveragedJump::hats(degree, point.xi, point.eta));
    const Column       psi     = weight * (dual_ * phi + (1. - part_) * hat);
    const Partner      partner = rigid_ == nullptr ? meshed_partner(pair_, master_, search_, point.master)
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
        double *const v = rows_.vectors.data() + FaceRows::n_vectors * a + c;
        v[0] += psi[a] * offset[c];
        v[dim] += weight * hat[a] * normal[c];
        v[2 * dim] += psi[a] * partner.rigid.x[c];
        v[3 * dim] += psi[a] * partner.rigid.moved[c];
      }
    }
  }

  void FaceIntegral::take_exact_areas()
  {
    Column exact = Column::Zero(m_), full = Column::Zero(m_); // areas of the dual functions, hats
    for (const WholePoint &point : whole_points(slave_.degree()))
    {
      const double area = point.weight * element(point.shape);
      exact += area * of_slaves(point.shape.value);
      full += area * of_slaves(point.hats);
    }
    for (unsigned int a = 0; a < m_; ++a)
    {
      double *const row = rows_.weights.data() + a * n_columns_;
      if (exact_ > 0.)
      {
        const double scale = 1. + exact_ * (counted_ * exact[a] / row[n_columns_ - 2] - 1.);
        for (unsigned int b = 0; b < n_columns_; ++b)
          row[b] *= scale;
        for (unsigned int c = 0; c < FaceRows::n_vectors; ++c)
          rows_.vectors[FaceRows::n_vectors * a + c] *= c / dim == 1 ? 1. : scale; // normals become unit ones
      }
      row[n_columns_ - 1] = part_ * exact[a] + (1. - part_) * full[a];
    }
  }

  std::vector<unsigned int> slaves_of(const ContactSurfaces &surfaces, const FaceRows &face)
  {
    std::vector<unsigned int> slaves;
    for (const DoFIndex dof : face.slaves)
      slaves.push_back(surfaces.slave_number(face.pair, surfaces.node(dof)));
    return slaves;
  }

  std::vector<FaceRows> collect(const ContactSurfaces &surfaces, std::vector<FaceRows> mine)
  {
    std::map<unsigned int, std::vector<FaceRows>> outgoing;
    for (const FaceRows &face : mine)
    {
      std::set<unsigned int> owners;
      for (const unsigned int k : slaves_of(surfaces, face))
        owners.insert(surfaces.site_owner(k));
      for (const unsigned int owner : owners)
        outgoing[owner].push_back(face);
    }
    mine.clear();
    for (auto &[other, part] : sparse_exchange(surfaces.layout().communicator, outgoing))
      std::move(part.begin(), part.end(), std::back_inserter(mine));
    std::sort(mine.begin(),
              mine.end(),
              [](const FaceRows &a, const FaceRows &b)
              { return std::make_pair(a.pair, a.number) < std::make_pair(b.pair, b.number); });
    return mine;
  }
} // namespace Nodus
