#include "contact/jump_operator.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Nodus
{
  namespace
  {
    using namespace MomentBalance;
    using Entry = JumpOperator::Entry;

    /// A row of G while it is put together.
    struct Row
    {
      const ContactSurfaces &surfaces;
      std::vector<Entry>     slave = {}, master = {};
      RigidPart              rigid  = {};
      Vector3                offset = {}; ///< jump of the positions minus that of the nodal ones

      void clear()
      {
        slave.clear();
        master.clear();
        rigid  = RigidPart();
        offset = Vector3();
      }
      /// Adds @p weight times a node to @p side, #slave or #master. A hanging node is where those are that it follows,
      /// but for its reference position.
      void add(std::vector<Entry> &side, const unsigned int node, const double weight)
      {
        const auto add_free = [&side](const unsigned int free_node, const double part)
        {
          const auto at =
              std::find_if(side.begin(), side.end(), [free_node](const Entry &e) { return e.node == free_node; });
          if (at == side.end())
            side.push_back({free_node, part});
          else
            at->weight += part;
        };
        surfaces.expand(node, weight, add_free);
        offset += weight * surfaces.nodes()[node].offset;
      }
      void add(std::vector<Entry> &side, const SurfaceFace &face, const FaceShape &shape, const double sign)
      {
        for (unsigned int n = 0; n < shape.n; ++n)
          if (std::abs(shape.value[n]) > 1e-15)
            add(side, face.nodes[n], sign * shape.value[n]);
      }
    };

    /// Balances moments (eq. J4). Averaged gaps vanish in the mean alone: gaps that are left between the points, on
    /// masters that are not flat, put the mean master point beside the normal through the slave node, and forces along
    /// that would turn the bodies. The master weights are changed by the least amount, relative to themselves, that
    /// puts it on the normal; the distance along it stays. As changes are relative, a node whose weight grows from zero
    /// comes in without a jump.
    void balance_moment(const SitePairing &site, const double size, const std::vector<Point> &x, Row &row)
    {
      Vector3 beside, mean;
      double  sum = 0.;
      for (const auto *const side : {&row.slave, &row.master})
        for (const Entry &e : *side)
          beside += e.weight * x[e.node];
      for (const Entry &e : row.master)
      {
        mean += std::abs(e.weight) * x[e.node];
        sum += std::abs(e.weight);
      }
      mean /= sum;
      const auto components = [&](const Vector3 &v)
      { return Eigen::Vector2d(v * site.tangent[0], v * site.tangent[1]); };
      Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
      for (const Entry &e : row.master)
      {
        const Eigen::Vector2d d = components(x[e.node] - mean);
        spread += std::abs(e.weight) * d * d.transpose();
      }
      Eigen::Vector2d shift = components(beside);
      shift *= std::min(1., largest_shift * size / std::max(shift.norm(), std::numeric_limits<double>::min()));
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
      Eigen::Vector2d                                      slope = Eigen::Vector2d::Zero();
      for (unsigned int i = 0; i < 2; ++i)
      {
        const double part = axes.eigenvalues()[i] / (sum * size * size);
        if (!(part > no_spread))
          continue; // nodes in a line across it
        const double t = std::min(1., (part - no_spread) / (full_spread - no_spread));
        slope += t * t * (3. - 2. * t) / axes.eigenvalues()[i] * axes.eigenvectors().col(i).dot(shift) *
                 axes.eigenvectors().col(i);
      }
      for (Entry &e : row.master)
      {
        const double change = -std::abs(e.weight) * components(x[e.node] - mean).dot(slope);
        e.weight += change;
        row.offset -= change * (x[e.node] * site.normal) * site.normal;
      }
    }

    /// Of a slave node with averages over its faces.
    void
    make_averaged(const AveragedJump::Row &averages, const SitePairing &site, const std::vector<Point> &x, Row &row)
    {
      row.slave  = averages.slave;
      row.master = averages.master;
      row.rigid  = averages.rigid;
      row.offset = averages.offset - averages.rigid.x;
      if (!row.master.empty())
        balance_moment(site, std::sqrt(averages.area), x, row);
    }

    /// Of a slave node or an integration point against the point that it is projected on.
    void make_pointwise(const unsigned int s, const ContactGeometry &geometry, const Projection &master, Row &row)
    {
      const ContactSurfaces    &surfaces = row.surfaces;
      const unsigned int        p        = surfaces.pair(s);
      const RigidSurface *const rigid    = geometry.rigid[p];
      Point                     on_rigid;
      if (rigid != nullptr)
      {
        on_rigid   = rigid->closest(geometry.position(surfaces, s)).x;
        row.rigid  = rigid->part(on_rigid);
        row.offset = -row.rigid.x;
      }
      else
        row.offset = -geometry.master[p].offset(master.face, master.xi, master.eta);
      if (surfaces.is_point(s))
      {
        const SlavePoint &point = surfaces.point(s);
        const FaceShape   shape(surfaces.degree(), point.xi, point.eta);
        row.add(row.slave, geometry.slave[p].face(point.face), shape, 1.);
        row.offset += geometry.slave[p].offset(point.face, point.xi, point.eta);
      }
      else
        row.slave.push_back({surfaces.slave_nodes()[s].node, 1.});
      if (rigid != nullptr && rigid->carrier() != nullptr)
      {
        const RigidCarrier::Weights weights = rigid->carrier()->weights(on_rigid);
        for (unsigned int i = 0; i < weights.size(); ++i)
          row.add(row.master, rigid->carrier()->nodes()[i], -weights[i]);
      }
      if (master.found())
      {
        const FaceShape shape(surfaces.degree(), master.xi, master.eta);
        row.add(row.master, geometry.master[p].face(master.face), shape, -1.);
      }
    }
  } // namespace

  void JumpOperator::build(const std::vector<ContactPairParameters> &pairs,
                           const ContactSurfaces                    &surfaces,
                           const ContactGeometry                    &geometry,
                           const Pairing                            &pairing,
                           const AveragedJump                       &averaged)
  {
    entries_.clear();
    start_.assign(1, 0);
    middle_.clear();
    offset_.clear();
    rigid_.clear();
    stuck_.clear();
    Row row{surfaces};
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      const unsigned int p      = surfaces.pair(s);
      const bool         paired = pairing[s].found || pairing[s].held;
      row.clear();
      if (paired && pairs[p].scheme == ContactPairParameters::Scheme::averaged)
        make_averaged(averaged.row(s), pairing[s], geometry.slave[p].positions(), row);
      else if (paired && (pairing[s].master.found() || geometry.rigid[p] != nullptr))
        make_pointwise(s, geometry, pairing[s].master, row);
      entries_.insert(entries_.end(), row.slave.begin(), row.slave.end());
      middle_.push_back(entries_.size());
      entries_.insert(entries_.end(), row.master.begin(), row.master.end());
      start_.push_back(entries_.size());
      offset_.push_back(row.offset);
      rigid_.push_back(row.rigid);
    }
  }
} // namespace Nodus
