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

    /// Averaged gaps vanish in the mean alone: gaps that are left between the points, on masters that are not flat, put
    /// the mean master point beside the normal through the slave node, and forces along that would turn the bodies. The
    /// least change of the master weights, relative to these, that puts it on the normal; the distance along it stays.
    /// Nodes that come in with a weight of zero so change nothing at once.
    void balance_moment(const SitePairing         &site,
                        const double               size,
                        const std::vector<Point>  &x,
                        const AveragedJump::Entry *first,
                        AveragedJump::Entry       *master,
                        const AveragedJump::Entry *last,
                        Vector3                   &offset)
    {
      Vector3 beside, mean;
      double  sum = 0.;
      for (const AveragedJump::Entry *e = first; e != last; ++e)
        beside += e->weight * x[e->node];
      for (const AveragedJump::Entry *e = master; e != last; ++e)
      {
        mean += std::abs(e->weight) * x[e->node];
        sum += std::abs(e->weight);
      }
      mean /= sum;
      const auto components = [&](const Vector3 &v)
      { return Eigen::Vector2d(v * site.tangent[0], v * site.tangent[1]); };
      Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
      for (const AveragedJump::Entry *e = master; e != last; ++e)
      {
        const Eigen::Vector2d d = components(x[e->node] - mean);
        spread += std::abs(e->weight) * d * d.transpose();
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
      for (AveragedJump::Entry *e = master; e != last; ++e)
      {
        const double change = -std::abs(e->weight) * components(x[e->node] - mean).dot(slope);
        e->weight += change;
        offset -= change * (x[e->node] * site.normal) * site.normal;
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
    stuck_.clear();
    std::size_t first_of_part = 0; // slave or master part of a row
    // a hanging node is where those are that it follows, but for its reference position
    const auto add = [&](const unsigned int node, const double weight)
    {
      surfaces.expand(node,
                      weight,
                      [&](const unsigned int free_node, const double part)
                      {
                        const auto at = std::find_if(entries_.begin() + first_of_part,
                                                     entries_.end(),
                                                     [&](const Entry &e) { return e.node == free_node; });
                        if (at == entries_.end())
                          entries_.push_back({free_node, part});
                        else
                          at->weight += part;
                      });
      offset_.back() += weight * surfaces.nodes()[node].offset;
    };
    rigid_.assign(surfaces.n_sites(), RigidPart());
    const auto add_shape = [&](const SurfaceFace &face, const FaceShape &shape, const double sign)
    {
      for (unsigned int n = 0; n < shape.n; ++n)
        if (std::abs(shape.value[n]) > 1e-15)
          add(face.nodes[n], sign * shape.value[n]);
    };
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      const unsigned int        p        = surfaces.pair(s);
      const bool                averages = pairs[p].scheme == ContactPairParameters::Scheme::averaged;
      const Projection         &master   = pairing[s].master;
      const RigidSurface *const rigid    = geometry.rigid[p];
      middle_.push_back(entries_.size());
      first_of_part = entries_.size();
      offset_.emplace_back();
      if (pairing[s].found && averages)
      {
        const AveragedJump::Row &row = averaged.row(s);
        entries_.insert(entries_.end(), row.slave.begin(), row.slave.end());
        middle_.back() = entries_.size();
        entries_.insert(entries_.end(), row.master.begin(), row.master.end());
        rigid_[s]      = row.rigid;
        offset_.back() = row.offset - row.rigid.x;
        if (!row.master.empty())
          balance_moment(pairing[s],
                         std::sqrt(row.area),
                         geometry.slave[p].positions(),
                         entries_.data() + start_.back(),
                         entries_.data() + middle_.back(),
                         entries_.data() + entries_.size(),
                         offset_.back());
      }
      else if (pairing[s].found && (master.found() || rigid != nullptr))
      {
        Point on_rigid;
        if (rigid != nullptr)
        {
          on_rigid       = rigid->closest(geometry.position(surfaces, s)).x;
          rigid_[s]      = rigid->part(on_rigid);
          offset_.back() = -rigid_[s].x;
        }
        else
          offset_.back() = -geometry.master[p].offset(master.face, master.xi, master.eta);
        if (surfaces.is_point(s))
        {
          const SlavePoint &point = surfaces.point(s);
          add_shape(geometry.slave[p].face(point.face), FaceShape(surfaces.degree(), point.xi, point.eta), 1.);
          offset_.back() += geometry.slave[p].offset(point.face, point.xi, point.eta);
        }
        else
          entries_.push_back({surfaces.slave_nodes()[s].node, 1.});
        middle_.back() = first_of_part = entries_.size();
        if (rigid != nullptr && rigid->carrier() != nullptr)
        {
          const RigidCarrier::Weights weights = rigid->carrier()->weights(on_rigid);
          for (unsigned int i = 0; i < weights.size(); ++i)
            add(rigid->carrier()->nodes()[i], -weights[i]);
        }
        if (master.found())
          add_shape(geometry.master[p].face(master.face), FaceShape(surfaces.degree(), master.xi, master.eta), -1.);
      }
      start_.push_back(entries_.size());
    }
  }
} // namespace Nodus
