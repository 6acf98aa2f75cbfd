#ifndef nodus_contact_jump_operator_h
#define nodus_contact_jump_operator_h

#include "contact/averaged_jump.h"
#include "contact/pairing.h"
#include "contact/surface.h"

#include <vector>

namespace Nodus
{
  /// Bounds on the change of averaged master weights that keeps forces from turning the bodies.
  namespace MomentBalance
  {
    /// Largest shift of a mean master point, in sizes of the surface of its slave node: of sites far from contact.
    constexpr double largest_shift = 0.1;
    /// Mean square distance of the master nodes, over the surface of the slave node, at which their mean is not moved,
    /// and from which on it is in full.
    constexpr double no_spread = 1e-3, full_spread = 1e-2;
  } // namespace MomentBalance

  /// G: the jump of each contact site as a combination of nodal values, slave minus master (eq. 18, 22).
  ///
  /// The schemes differ in its rows alone: a slave node against the master shape functions at its projection (nodal),
  /// an integration point of a slave face against the same (integration point), or averages over the faces of a slave
  /// node.
  class JumpOperator
  {
  public:
    using Entry = AveragedJump::Entry;

    /// Sites without partner have no entry, nor have ghosts of the averaged scheme and those whose partner is not here:
    /// no point of this rank's faces needs them.
    void build(const std::vector<ContactPairParameters> &pairs,
               const ContactSurfaces                    &surfaces,
               const ContactGeometry                    &geometry,
               const Pairing                            &pairing,
               const AveragedJump                       &averaged);

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
      Vector3 result;
      for (const Entry *e = begin(site); e != end(site); ++e)
        result += e->weight * displacement[e->node];
      return result;
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
    /// Part of a rigid master in the jump, zero where there is none.
    const RigidPart &rigid(const unsigned int site) const
    {
      return rigid_[site];
    }

  private:
    std::vector<Entry>        entries_;
    std::vector<unsigned int> start_, middle_;
    std::vector<Vector3>      offset_;
    std::vector<RigidPart>    rigid_;
    std::vector<Vector3>      stuck_; ///< empty, or per site
  };
} // namespace Nodus

#endif
