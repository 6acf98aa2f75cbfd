#include "contact/face_integral.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <Eigen/Dense>

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
      std::array<double, 9> weights{}; ///< of the nodes of the master face, or of what carries a rigid one
      Vector3               normal;    ///< unit, from slave to master
      Vector3               offset;    ///< of a smoothed surface
      RigidPart             rigid;
    };

    /// A point of a rule on whole faces.
    struct WholePoint
    {
      double                xi, eta, weight;
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
          points.push_back({xi, eta, gauss.weight(q), FaceShape(d, xi, eta), AveragedJump::hats(d, xi, eta)});
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
      const FaceShape shape(master.degree(), point.xi, point.eta);
      const Vector3   normal = pair.normal == ContactPairParameters::Normal::averaged
                                   ? master.averaged_normal(point.face, shape)
                                   : master.facet_normal(point.face, point.xi, point.eta, search.rim(point.face));
      return {shape.value, -normal, master.offset(point.face, point.xi, point.eta), {}};
    }

    Partner rigid_partner(const RigidSurface &master, const Point &p)
    {
      const RigidPoint point = master.closest(p);
      Partner          partner{{}, -point.normal, Vector3(), master.part(point.x)};
      if (const RigidCarrier *const carrier = master.carrier())
      {
        const RigidCarrier::Weights weights = carrier->weights(point.x);
        std::copy(weights.begin(), weights.end(), partner.weights.begin());
      }
      return partner;
    }

    /// Integrates one slave face of the averaged scheme over its points. @p measure: positions that areas are of.
    template <unsigned int degree>
    class FaceIntegral
    {
    public:
      FaceIntegral(const ContactPairParameters &pair,
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
          , points_(face.points)
          , face_(slave_.face(face.face))
          , f_(face.face)
          , m_(face_.slaves.size())
          , part_(face.dual_part())
          , exact_(face.exact_part())
          , counted_(face.coverage.counted)
          , measured_(degree, [&](const unsigned int node) { return Vector3(measure[face_.nodes[node]]); })
          , rows_{face.pair, face_.number, {}, {}, {}, {}, {}}
      {
      }

      /// To be called once.
      FaceRows integrate()
      {
        number_nodes();
        make_dual_functions();
        n_columns_ = rows_.nodes.size() + 2;
        rows_.weights.assign(m_ * n_columns_, 0.);
        rows_.vectors.assign(FaceRows::n_vectors * m_, 0.);
        for (unsigned int q = 0; q < points_.size(); ++q)
        {
          add_point(points_[q], weight_[q]);
          if (q + 1 == points_.size() || begins_face(q + 1))
            flush_partner(points_[q].master.face);
        }
        flush();
        take_exact_areas();
        const Vector3 outward = slave_.normal(f_, 0.5, 0.5);
        std::copy(outward.begin_raw(), outward.end_raw(), rows_.outward.begin());
        return std::move(rows_);
      }

    private:
      static constexpr unsigned int n = (degree + 1) * (degree + 1); // nodes of the face

      using Matrix  = Eigen::Matrix<double, n, n>; // zero beyond the slave nodes
      using Column  = Eigen::Matrix<double, n, 1>;
      using Vectors = Eigen::Matrix<double, n, FaceRows::n_vectors>;

      /// phi and hats are those of the slave nodes: where some of the face's nodes hang they are conforming.
      template <typename Nodal>
      Column of_slaves(const Nodal &nodal) const
      {
        if (face_.basis.empty())
          return Eigen::Map<const Column>(nodal.data());
        const auto values = face_.slave_values(nodal);
        return Eigen::Map<const Column>(values.data());
      }
      static Eigen::RowVector3d row(const Vector3 &v)
      {
        return {v[0], v[1], v[2]};
      }
      /// Which of FaceRows::vectors.
      auto vectors(const unsigned int which)
      {
        return vectors_.template middleCols<dim>(dim * which);
      }
      double element(const double xi, const double eta) const
      {
        const FacePowers::Tangents t = measured_.tangents<degree>(xi, eta);
        return dealii::cross_product_3d(FacePowers::vector(t.d_xi), FacePowers::vector(t.d_eta)).norm();
      }
      /// Points follow each other master face by master face.
      bool begins_face(const unsigned int q) const
      {
        return rigid_ == nullptr && (q == 0 || points_[q].master.face != points_[q - 1].master.face);
      }
      const RigidCarrier *carrier() const
      {
        return rigid_ == nullptr ? nullptr : rigid_->carrier();
      }

      /// Nodes of the face, then those of the master.
      void number_nodes()
      {
        nodes_ = face_.nodes;
        if (carrier() != nullptr)
          nodes_.insert(nodes_.end(), carrier()->nodes().begin(), carrier()->nodes().end());
        for (unsigned int q = 0; q < points_.size(); ++q)
          if (begins_face(q))
            for (const unsigned int node : master_.face(points_[q].master.face).nodes)
              if (std::find(nodes_.begin() + n, nodes_.end(), node) == nodes_.end())
                nodes_.push_back(node);
        for (const unsigned int node : nodes_)
          rows_.nodes.push_back(surfaces_.nodes()[node].dofs[0]);
        for (const unsigned int k : face_.slaves)
          rows_.slaves.push_back(surfaces_.nodes()[surfaces_.slave_nodes()[k].node].dofs[0]);
      }

      /// psi = part (D M^-1)^T phi + (1 - part) hat, with M and D over the covered part.
      void make_dual_functions()
      {
        Matrix mass = Matrix::Zero();
        Column area = Column::Zero();
        weight_.resize(points_.size());
        for (unsigned int q = 0; q < points_.size(); ++q)
        {
          const auto &[xi, eta, weight, partner] = points_[q];
          weight_[q]                             = weight * element(xi, eta);
          const Column phi                       = of_slaves(FaceShape(degree, xi, eta).value);
          const Column weighted                  = weight_[q] * phi;
          mass += weighted * phi.transpose();
          area += weighted;
        }
        if (part_ == 0.)
          return;
        using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, n, n>;
        dual_.topLeftCorner(m_, m_) =
            part_ * Block(mass.topLeftCorner(m_, m_)).ldlt().solve(Block(area.head(m_).asDiagonal())).transpose();
      }

      void add_point(const MortarPoint &point, const double weight)
      {
        const FaceShape shape(degree, point.xi, point.eta);
        const Column    phi     = of_slaves(shape.value);
        const Column    hat     = of_slaves(AveragedJump::hats(degree, point.xi, point.eta));
        const Column    psi     = weight * (dual_ * phi + (1. - part_) * hat);
        const Partner   partner = rigid_ == nullptr ? meshed_partner(pair_, master_, search_, point.master)
                                                    : rigid_partner(*rigid_, slave_.at(f_, point.xi, point.eta).x);
        const Vector3   normal =
            pair_.normal == ContactPairParameters::Normal::slave ? slave_.averaged_normal(f_, shape) : partner.normal;
        of_face_ += psi * Eigen::Map<const Column>(shape.value.data()).transpose();
        of_partner_ -= psi * Eigen::Map<const Column>(partner.weights.data()).transpose();
        area_ += psi;
        vectors(0) += psi * row(slave_.offset(f_, point.xi, point.eta) - partner.offset);
        vectors(1) += weight * hat * row(normal);
        if (rigid_ == nullptr)
          return;
        vectors(2) += psi * row(partner.rigid.x);
        vectors(3) += psi * row(partner.rigid.moved);
      }

      /// What the points before this one have given to the nodes of their partner, master face @p f or what carries a
      /// rigid one.
      void flush_partner(const unsigned int f)
      {
        const auto flush_to = [&](const auto &partner)
        {
          for (unsigned int b = 0; b < partner.size(); ++b)
          {
            const unsigned int column = std::find(nodes_.begin() + n, nodes_.end(), partner[b]) - nodes_.begin();
            for (unsigned int a = 0; a < m_; ++a)
              rows_.weights[a * n_columns_ + column] += of_partner_(a, b);
          }
        };
        if (rigid_ == nullptr)
          flush_to(master_.face(f).nodes);
        else if (carrier() != nullptr)
          flush_to(carrier()->nodes());
        of_partner_.setZero();
      }

      void flush()
      {
        for (unsigned int a = 0; a < m_; ++a)
        {
          double *const weights = rows_.weights.data() + a * n_columns_;
          for (unsigned int b = 0; b < n; ++b)
            weights[b] = of_face_(a, b);
          weights[n_columns_ - 2] = area_[a];
          for (unsigned int c = 0; c < FaceRows::n_vectors; ++c)
            rows_.vectors[FaceRows::n_vectors * a + c] = vectors_(a, c);
        }
      }

      /// The points on a curved face integrate its shape functions nearly, Gauss points to round-off: nodal areas of
      /// covered faces are those, times the part that they count with (eq. J10).
      void take_exact_areas()
      {
        Column exact = Column::Zero(), full = Column::Zero(); // areas of the dual functions, hats
        for (const WholePoint &point : whole_points(degree))
        {
          const double area = point.weight * element(point.xi, point.eta);
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

      const ContactPairParameters    &pair_;
      const ContactSurfaces          &surfaces_;
      const SurfaceGeometry          &slave_, &master_;
      const MasterSearch             &search_;
      const RigidSurface *const       rigid_;
      const std::vector<MortarPoint> &points_;
      const SurfaceFace              &face_;
      const unsigned int              f_, m_;    ///< the face, its slave nodes
      const double                    part_;     ///< of the dual functions in psi
      const double                    exact_;    ///< part of the exact areas
      const double                    counted_;  ///< part that the points count with, in the mean
      const FacePowers                measured_; ///< positions that areas are of
      FaceRows                        rows_;
      unsigned int                    n_columns_ = 0;
      std::vector<unsigned int>       nodes_;
      std::vector<double>             weight_;                ///< of the points
      Matrix                          dual_ = Matrix::Zero(); ///< times part
      // sums over the points, that of the partner since flush_partner()
      Matrix  of_face_ = Matrix::Zero(), of_partner_ = Matrix::Zero();
      Column  area_    = Column::Zero();
      Vectors vectors_ = Vectors::Zero();
    };
  } // namespace

  FaceRows integrate_face(const ContactPairParameters &pair,
                          const ContactSurfaces       &surfaces,
                          const ContactGeometry       &geometry,
                          const AveragedJump::Face    &face,
                          const std::vector<Point>    &measure)
  {
    return surfaces.degree() == 1 ? FaceIntegral<1>(pair, surfaces, geometry, face, measure).integrate()
                                  : FaceIntegral<2>(pair, surfaces, geometry, face, measure).integrate();
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
    const MPI_Comm                                communicator = surfaces.layout().communicator;
    const unsigned int                            rank         = dealii::Utilities::MPI::this_mpi_process(communicator);
    std::map<unsigned int, std::vector<FaceRows>> outgoing;
    std::vector<FaceRows>                         result;
    result.reserve(mine.size());
    for (FaceRows &face : mine)
    {
      std::set<unsigned int> owners;
      for (const unsigned int k : slaves_of(surfaces, face))
        owners.insert(surfaces.site_owner(k));
      const bool here = owners.erase(rank) > 0;
      for (const unsigned int owner : owners)
        outgoing[owner].push_back(face);
      if (here)
        result.push_back(std::move(face));
    }
    for (auto &[other, part] : sparse_exchange(communicator, outgoing))
      std::move(part.begin(), part.end(), std::back_inserter(result));
    std::sort(result.begin(),
              result.end(),
              [](const FaceRows &a, const FaceRows &b)
              { return std::make_pair(a.pair, a.number) < std::make_pair(b.pair, b.number); });
    return result;
  }
} // namespace Nodus
