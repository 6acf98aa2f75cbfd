#ifndef nodus_contact_averaged_jump_h
#define nodus_contact_averaged_jump_h

#include "contact/contact_geometry.h"
#include "contact/segments.h"

#include <array>
#include <vector>

namespace Nodus
{
  /// Jumps averaged over the slave faces around each slave node, for the pairs with that scheme (theory section 7):
  /// [[u]]_j = int psi_j [[u]] / int psi_j over the part of the slave surface that has a partner.
  ///
  /// On a covered face psi is biorthogonal to the slave shape functions, so that the slave part of the jump is u_j. On
  /// a face that sticks out of the master surface those functions grow without bound as the covered part shrinks: from
  /// three quarters of the face downwards psi fades into the bilinear hats of the nodes (on the quarters of a face of
  /// degree 2), which are positive. Both are partitions of unity, so uniform pressures pass the patch test everywhere.
  class AveragedJump
  {
  public:
    struct Entry
    {
      unsigned int node; ///< index into ContactSurfaces::nodes()
      double       weight;
    };
    struct Row
    {
      double             area  = 0.; ///< m_j = int psi_j over the covered part [area]
      double             whole = 0.; ///< of the surface around the node, covered or not [area]
      std::vector<Entry> slave, master;
      Vector3            offset; ///< of smoothed surfaces: jump of the positions minus jump of the nodal ones [length]
      RigidPart          rigid;
      Vector3            normal; ///< averaged, unit, from slave to master
    };

    /// Measures as the pairs ask: @p x current, @p X reference positions. Each rank integrates its faces; the rows are
    /// those of its slave nodes, ghosts know their area alone. Collective.
    void compute(const std::vector<ContactPairParameters> &pairs,
                 const ContactSurfaces                    &surfaces,
                 const ContactGeometry                    &geometry,
                 const std::vector<Point>                 &x,
                 const std::vector<Point>                 &X);

    /// A fair part of the surface around the slave node has a partner.
    bool covered(const unsigned int slave) const
    {
      return rows_[slave].area > 0.;
    }
    const Row &row(const unsigned int slave) const
    {
      return rows_[slave];
    }

    /// A slave face with its integration points. On a rigid master their master face is not set.
    struct Face
    {
      unsigned int             pair, face;
      std::vector<MortarPoint> points;
      SegmentTrace             trace; ///< of segments; empty for a fixed rule
      Coverage                 coverage;

      /// Part of the dual functions in psi, the rest being hats, and how it changes with the coverage.
      double dual_part() const;
      double dual_slope() const;
    };
    /// Finds the points of a face of a pair with the averaged scheme; @p rule: face_rule() of the pair.
    static void find_points(const ContactPairParameters &pair,
                            const ContactGeometry       &geometry,
                            const dealii::Quadrature<2> &rule,
                            Face                        &face);

    /// The slave faces of this rank.
    const std::vector<Face> &faces() const
    {
      return faces_;
    }
    /// Bilinear hats of the nodes: on the face, or on the quarters of one of degree 2.
    static std::array<double, 9> hats(unsigned int degree, double xi, double eta);

  private:
    std::vector<Face> faces_;
    std::vector<Row> rows_; ///< per slave node; area 0 where not covered or of another scheme; of ghosts the area alone
  };
} // namespace Nodus

#endif
