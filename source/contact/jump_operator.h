#ifndef nodus_contact_jump_operator_h
#define nodus_contact_jump_operator_h

#include "contact/averaged_jump.h"
#include "contact/pairing.h"
#include "contact/status.h"
#include "contact/surface.h"

#include <array>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Bounds on the changes of rows that keep forces from turning the bodies.
  namespace MomentBalance
  {
    /// Largest shift of a master point, in sizes of the surface: of sites far from contact.
    constexpr double largest_shift = 0.5;
    /// Mean square distance of the master nodes, over the square of that size, at which their point is not moved, as
    /// they are in a line, and from which on it is in full.
    constexpr double no_spread = 1e-6, full_spread = 1e-5;
    /// 1 / @p spread [1/area], or less where that is little, and its derivative. @p size: of the surface [length].
    std::pair<double, double> inverse_of_spread(double spread, double size);
    /// Unit vectors across the normal of a site and each other. The first tangents that carry friction are these.
    std::array<Vector3, 2> basis(const SitePairing &site);
    /// How master nodes share in what balances moments: as they are weighted, as the nodes around them are weighted
    /// (eq. J6), or the sum of both. Neither where they share evenly (what carries a rigid master).
    struct Shares
    {
      double weighted = 0., around = 0.; ///< factors of the weights
    };
  } // namespace MomentBalance

  /// G: the jump of each contact site as a combination of nodal values, slave minus master (eq. 18, 22).
  ///
  /// The schemes differ in its rows alone: a slave node against the master shape functions at its projection (nodal),
  /// an integration point of a slave face against the same (integration point), or averages over the faces of a slave
  /// node.
  class JumpOperator
  {
  public:
    /// A node in the jump of a site, [[u]] += weight u + lever turn (n . u) with the normal n and the lever of the
    /// site.
    struct Entry
    {
      unsigned int node; ///< index into ContactSurfaces::nodes()
      double       weight;
      /// Along the surface: what a turn of the master adds to the slip of points that are apart (eq. J5) [1/length].
      Vector3 turn;
      /// The weight before moments are balanced and, of a master node, its part in what balances them (eq. J4).
      double unbalanced = 0., share = 0.;
    };

    /// @p status: which pairs have friction, and what is adjusted at the start.
    /// Sites without partner have no entry, nor have ghosts of the averaged scheme and those whose partner is not here:
    /// no point of this rank's faces needs them.
    void build(const std::vector<ContactPairParameters> &pairs,
               const ContactSurfaces                    &surfaces,
               const ContactGeometry                    &geometry,
               const Pairing                            &pairing,
               const AveragedJump                       &averaged,
               const Status                             &status);

    /// Entries of the row: slave nodes (weights of sum 1) from begin to middle, master nodes or those that carry a
    /// rigid master (of sum -1, none where that moves as prescribed) to end.
    const Entry *begin(const unsigned int site) const
    {
      return entries_.data() + start_[site];
    }
    const Entry *middle(const unsigned int site) const
    {
      return entries_.data() + middle_[site];
    }
    const Entry *end(const unsigned int site) const
    {
      return entries_.data() + start_[site + 1];
    }

    /// Jump of a nodal displacement field at a site.
    Vector3 jump(const unsigned int site, const std::vector<Vector3> &displacement) const
    {
      Vector3 result, turn;
      for (const Entry *e = begin(site); e != end(site); ++e)
        result += e->weight * displacement[e->node];
      for (const Entry *e = middle(site); e != end(site) && lever_[site] != 0.; ++e)
        turn += (normal_[site] * displacement[e->node]) * e->turn;
      return result + lever_[site] * turn;
    }
    /// What an entry of the row of a site gets of the residual of the jump: the transposed operator.
    Vector3 force(const unsigned int site, const Entry &e, const Vector3 &residual) const
    {
      return e.weight * residual + lever_[site] * (e.turn * residual) * normal_[site];
    }
    const Vector3 &normal(const unsigned int site) const
    {
      return normal_[site];
    }
    /// How far the nodes of the slave are beyond those of the master along the normal, in pairs with friction, but for
    /// what counts as no overlap or gap: at closed sites what smoothed surfaces are off their facets [length].
    double lever(const unsigned int site) const
    {
      return lever_[site];
    }
    /// What bounds on the balance of moments refer to [length].
    double size(const unsigned int site) const
    {
      return size_[site];
    }
    /// How the nodes of the master share in what balances the moments of a site.
    const MomentBalance::Shares &shares(const unsigned int site) const
    {
      return shares_[site];
    }
    /// Jump of the displacement of the increment (eq. K2): with the way of a rigid master and, on a new mesh, what
    /// set_stuck() adds.
    Vector3 jump_of_increment(const unsigned int site, const std::vector<Vector3> &increment) const
    {
      return jump(site, increment) - rigid_[site].moved + (stuck_.empty() ? Vector3() : stuck_[site]);
    }
    /// On a new mesh: sets the jump with which the increment begins, relative to where the site stuck (eq. X2). It
    /// lasts until the next build().
    void set_stuck(std::vector<Vector3> jumps)
    {
      stuck_ = std::move(jumps);
    }
    /// Jump of positions: with what rigid masters and smoothed surfaces add.
    Vector3 jump(const unsigned int site, const std::vector<Point> &positions) const
    {
      Vector3 result = offset_[site];
      for (const Entry *e = begin(site); e != end(site); ++e)
        result += e->weight * positions[e->node];
      return result;
    }
    /// Part of a rigid master in the jump, at the point where the slave is; zero where there is none.
    const RigidPart &rigid(const unsigned int site) const
    {
      return rigid_[site];
    }

  private:
    std::vector<Entry>                 entries_;
    std::vector<unsigned int>          start_, middle_;
    std::vector<Vector3>               offset_, normal_;
    std::vector<double>                lever_, size_;
    std::vector<MomentBalance::Shares> shares_;
    std::vector<RigidPart>             rigid_;
    std::vector<Vector3>               stuck_; ///< empty, or per site
  };
} // namespace Nodus

#endif
