#include "contact/jump_operator.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Nodus
{
  std::pair<double, double> MomentBalance::inverse_of_spread(const double spread, const double size)
  {
    const double part = spread / (size * size);
    if (!(part > no_spread))
      return {0., 0.};
    const Fading counts(part, full_spread, no_spread);
    const double value = counts.part / spread;
    return {value, (counts.slope / (size * size) - value) / spread};
  }

  std::array<Vector3, 2> MomentBalance::basis(const SitePairing &site)
  {
    // where components are held the tangents lie across the free part of the normal alone
    Vector3 first = site.tangent[0] - (site.tangent[0] * site.normal) * site.normal;
    if (first.norm() < 1e-3)
      first = site.tangent[1] - (site.tangent[1] * site.normal) * site.normal;
    first /= first.norm();
    return {{first, dealii::cross_product_3d(site.normal, first)}};
  }

  namespace
  {
    using namespace MomentBalance;
    /// Mean square distances of master nodes, over the square of the size, up to which those around them share in full
    /// with averages over segments, and from which on not at all: wide apart, for the tangent has no change of it.
    constexpr double near_nodes = 1e-4, far_nodes = 1e-2;
    /// Shorter levers are round-off, of sizes of the surface around the slave node.
    constexpr double smallest_lever = 1e-13;

    using Entry = JumpOperator::Entry;

    /// A row of G while it is put together.
    struct Row
    {
      const ContactSurfaces &surfaces;
      std::vector<Entry>     slave = {}, master = {};
      RigidPart              rigid  = {};
      Vector3                offset = {}; ///< jump of the positions minus that of the nodal ones
      double                 size   = 0.; ///< of the surface [length]
      double                 lever  = 0.;

      void clear()
      {
        slave.clear();
        master.clear();
        rigid  = RigidPart();
        offset = Vector3();
        lever = size = 0.;
      }
      Point mean_slave_point(const std::vector<Point> &x) const
      {
        Point mean;
        for (const Entry &e : slave)
          mean += e.weight * Vector3(x[e.node]);
        return mean;
      }
      /// Adds @p weight times a node to @p side, #slave or #master. A hanging node is where those are that it follows,
      /// but for its reference position.
      void add(std::vector<Entry> &side, const unsigned int node, const double weight, const double share = 0.)
      {
        const auto add_free = [&](const unsigned int free_node, const double part)
        {
          const auto at =
              std::find_if(side.begin(), side.end(), [free_node](const Entry &e) { return e.node == free_node; });
          if (at == side.end())
            side.push_back({free_node, part * weight, {}, 0., part * share});
          else
          {
            at->weight += part * weight;
            at->share += part * share;
          }
        };
        surfaces.expand(node, 1., add_free);
        offset += weight * surfaces.nodes()[node].offset;
      }
      /// Those that carry a rigid master share evenly in what balances moments.
      void add_carriers(const RigidCarrier &carrier, const Point &x)
      {
        const RigidCarrier::Weights weights = carrier.weights(x);
        for (unsigned int n = 0; n < weights.size(); ++n)
          add(master, carrier.nodes()[n], -weights[n], 1. / weights.size());
      }
      void share_as_weighted()
      {
        for (Entry &e : master)
          e.share += std::abs(e.weight);
      }
      /// The nodes around those of a meshed master share in what balances moments.
      void share_around(const SurfaceGeometry &geometry, const Vector3 &normal, const double factor)
      {
        const unsigned int n = master.size();
        for (unsigned int i = 0; i < n; ++i)
          geometry.for_nodes_around(
              master[i].node,
              -normal,
              [&, share = factor * std::abs(master[i].weight)](const unsigned int node, const double part)
              { add(master, node, 0., share * part); });
      }
    };

    /// Where the nodes of a master are, as they share in what balances moments, across the normal.
    struct Spread
    {
      Spread(const std::vector<Entry> &master, const std::array<Vector3, 2> &basis, const std::vector<Point> &x)
          : b(basis)
      {
        double sum = 0.;
        for (const Entry &e : master)
        {
          mean += e.share * x[e.node];
          sum += e.share;
        }
        mean /= sum;
        Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
        for (const Entry &e : master)
        {
          const Eigen::Vector2d y = components(x[e.node] - mean);
          squares += e.share * y * y.transpose();
        }
        axes.computeDirect(squares);
      }
      Eigen::Vector2d components(const Vector3 &v) const
      {
        return {v * b[0], v * b[1]};
      }
      Eigen::Matrix2d inverse(const double size) const
      {
        Eigen::Vector2d value;
        for (unsigned int i = 0; i < 2; ++i)
          value[i] = inverse_of_spread(axes.eigenvalues()[i], size).first;
        return axes.eigenvectors() * value.asDiagonal() * axes.eigenvectors().transpose();
      }

      std::array<Vector3, 2>                         b;
      Vector3                                        mean;
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
    };

    /// How the nodes of a row share. Averages over segments are of one node alone where that lies on the slave node:
    /// those around it take part where its own are near each other.
    Shares share(const ContactPairParameters &pair,
                 const ContactGeometry       &geometry,
                 const unsigned int           p,
                 const SitePairing           &site,
                 Row                         &row)
    {
      const bool averaged = pair.scheme == ContactPairParameters::Scheme::averaged;
      Shares     shares;
      if (averaged && (geometry.rigid[p] != nullptr || pair.integration == ContactPairParameters::Integration::segment))
      {
        shares.weighted = 1.;
        row.share_as_weighted();
      }
      if (geometry.rigid[p] != nullptr)
        return shares;
      shares.around = 1.;
      if (shares.weighted > 0.)
      {
        const Spread spread(row.master, MomentBalance::basis(site), geometry.slave[p].positions());
        shares.around -= Fading(spread.axes.eigenvalues()[0] / (row.size * row.size), far_nodes, near_nodes).part;
      }
      if (shares.around > 0.)
        row.share_around(geometry.master[p], site.normal, shares.around);
      return shares;
    }

    /// Balances moments. Averaged gaps vanish in the mean alone: gaps that are left between the points, on masters that
    /// are not flat, put the mean master point beside the normal through the slave node, and forces along that would
    /// turn the bodies; so do smoothed facets and overhang in the other schemes. The master weights are changed by the
    /// least amount, relative to the shares of the nodes, that puts it on the normal (eq. J4); the distance along it
    /// stays. A node comes in without a jump: shares grow with the weights of the nodes, or of those around
    /// them (eq. J6).
    /// Friction acts with that distance as its lever: its moment is taken up by forces along the normal, and what the
    /// master turns counts as slip at the slave (eq. J5).
    void balance_moment(
        const SitePairing &site, const double adjustment, const bool friction, const std::vector<Point> &x, Row &row)
    {
      Vector3 apart;
      for (auto *const side : {&row.slave, &row.master})
        for (Entry &e : *side)
        {
          e.unbalanced = e.weight;
          apart += e.weight * x[e.node];
        }
      const Spread          spread(row.master, basis(site), x);
      const Eigen::Matrix2d inverse = spread.inverse(row.size);
      const double          limit   = largest_shift * row.size;
      Eigen::Vector2d       beside  = spread.components(apart);
      beside *= std::min(1., limit / std::max(beside.norm(), std::numeric_limits<double>::min()));
      double lever = apart * site.normal - adjustment;
      for (Entry &e : row.master)
      {
        const Vector3         arm    = x[e.node] - spread.mean;
        const Eigen::Vector2d slope  = e.share * inverse * spread.components(arm);
        const double          change = -slope.dot(beside), along = change * (arm * site.normal);
        e.weight += change;
        for (unsigned int i = 0; i < 2; ++i)
          if (friction && site.tangent_free[i]) // there is no friction along the other one
            e.turn += slope[i] * spread.b[i];
        row.offset -= along * site.normal;
        lever += along;
      }
      if (friction && std::abs(lever) > smallest_lever * row.size)
        row.lever = std::clamp(lever, -limit, limit);
    }

    /// Of a slave node with averages over its faces.
    void make_averaged(const AveragedJump::Row &averages, Row &row)
    {
      for (const AveragedJump::Entry &e : averages.slave)
        row.slave.push_back({e.node, e.weight, {}, 0., 0.});
      for (const AveragedJump::Entry &e : averages.master)
        row.master.push_back({e.node, e.weight, {}, 0., 0.});
      row.offset = averages.offset - averages.rigid.x;
      row.size   = std::sqrt(averages.whole);
    }

    /// Of a slave node or an integration point against the point that it is projected on.
    void make_pointwise(const unsigned int s, const ContactGeometry &geometry, const Projection &master, Row &row)
    {
      const ContactSurfaces    &surfaces = row.surfaces;
      const unsigned int        p        = surfaces.pair(s);
      const RigidSurface *const rigid    = geometry.rigid[p];
      Point                     on_rigid;
      row.size = surfaces.face_size(p);
      if (rigid != nullptr)
      {
        on_rigid   = rigid->closest(geometry.position(surfaces, s)).x;
        row.offset = -rigid->part(on_rigid).x;
      }
      else
        row.offset = -geometry.master[p].offset(master.face, master.xi, master.eta);
      if (surfaces.is_point(s))
      {
        const SlavePoint &point = surfaces.point(s);
        const FaceShape   shape(surfaces.degree(), point.xi, point.eta);
        for (unsigned int n = 0; n < shape.n; ++n)
          if (std::abs(shape.value[n]) > 1e-15)
            row.add(row.slave, geometry.slave[p].face(point.face).nodes[n], shape.value[n]);
        row.offset += geometry.slave[p].offset(point.face, point.xi, point.eta);
      }
      else
        row.slave.push_back({surfaces.slave_nodes()[s].node, 1., {}, 0., 0.});
      if (rigid != nullptr && rigid->carrier() != nullptr)
        row.add_carriers(*rigid->carrier(), on_rigid);
      if (master.found())
      {
        const FaceShape shape(surfaces.degree(), master.xi, master.eta);
        for (unsigned int n = 0; n < shape.n; ++n)
          row.add(row.master, geometry.master[p].face(master.face).nodes[n], -shape.value[n]);
      }
    }
  } // namespace

  void JumpOperator::build(const std::vector<ContactPairParameters> &pairs,
                           const ContactSurfaces                    &surfaces,
                           const ContactGeometry                    &geometry,
                           const Pairing                            &pairing,
                           const AveragedJump                       &averaged,
                           const Status                             &status)
  {
    entries_.clear();
    start_.assign(1, 0);
    middle_.clear();
    offset_.clear();
    shares_.clear();
    rigid_.clear();
    stuck_.clear();
    normal_.clear();
    lever_.clear();
    size_.clear();
    Row row{surfaces};
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      const unsigned int p      = surfaces.pair(s);
      const bool         paired = pairing[s].found || pairing[s].held;
      Shares             shares;
      row.clear();
      if (paired && pairs[p].scheme == ContactPairParameters::Scheme::averaged)
        make_averaged(averaged.row(s), row);
      else if (paired && (pairing[s].master.found() || geometry.rigid[p] != nullptr))
        make_pointwise(s, geometry, pairing[s].master, row);
      if (!row.master.empty())
      {
        shares = share(pairs[p], geometry, p, pairing[s], row);
        balance_moment(pairing[s], status.adjustment(s), status.has_friction(p), geometry.slave[p].positions(), row);
      }
      if (const RigidSurface *const rigid = geometry.rigid[p]; rigid != nullptr && !row.slave.empty())
        row.rigid = rigid->part(row.mean_slave_point(geometry.slave[p].positions()));
      entries_.insert(entries_.end(), row.slave.begin(), row.slave.end());
      middle_.push_back(entries_.size());
      entries_.insert(entries_.end(), row.master.begin(), row.master.end());
      start_.push_back(entries_.size());
      offset_.push_back(row.offset);
      normal_.push_back(pairing[s].normal);
      lever_.push_back(row.lever);
      size_.push_back(row.size);
      shares_.push_back(shares);
      rigid_.push_back(row.rigid);
    }
  }
} // namespace Nodus
