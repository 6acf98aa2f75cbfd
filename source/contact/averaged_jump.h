#ifndef nodus_contact_averaged_jump_h
#define nodus_contact_averaged_jump_h

#include "contact/contact_geometry.h"
#include "contact/segments.h"

#include <array>
#include <utility>
#include <vector>

namespace Nodus
{
  struct FaceRows;

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
    /// Per owned slave node: it had a constraint of its own when this was computed last, and keeps it longer.
    void set_constrained(std::vector<char> constrained)
    {
      constrained_ = std::move(constrained);
    }
    const std::vector<char> &constrained() const
    {
      return constrained_;
    }

    /// A fair part of the surface around the slave node has a partner.
    bool covered(const unsigned int slave) const
    {
      return rows_[slave].area > 0.;
    }
    const Row &row(const unsigned int slave) const
    {
      return rows_[slave];
    }

    /// It has next to no partner, and well covered nodes take what is around it.
    bool shared_out(const unsigned int slave) const
    {
      return cover_[slave] == Cover::shared_out;
    }
    /// Calls f(a, part) for the parts of a slave face that are in the row of a slave node: number of the psi among the
    /// slave nodes @p slaves of the face, and how much of it.
    template <typename Function>
    void for_each_part(const std::vector<unsigned int> &slaves, const unsigned int slave, const Function &f) const;

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
      /// Part of the exact areas of the face in those of its rows (eq. J10), likewise.
      double exact_part() const;
      double exact_slope() const;
    };
    /// Finds the points of a face of a pair with the averaged scheme; @p rule: face_rule() of the pair.
    static void find_points(const ContactPairParameters &pair,
                            const ContactGeometry       &geometry,
                            const dealii::Quadrature<2> &rule,
                            Face                        &face);

    /// The slave faces of this rank that have points.
    const std::vector<Face> &faces() const
    {
      return faces_;
    }
    /// Bilinear hats of the nodes: on the face, or on the quarters of one of degree 2.
    static std::array<double, 9> hats(unsigned int degree, double xi, double eta);

  private:
    /// How much of the surface around a slave node has a partner.
    enum class Cover : char
    {
      little,     ///< or nothing; a face around it has no well covered node: it keeps its constraint
      shared_out, ///< likewise, to the well covered nodes of all faces around it
      well
    };
    std::vector<FaceRows> integrate(const std::vector<ContactPairParameters> &pairs,
                                    const ContactSurfaces                    &surfaces,
                                    const ContactGeometry                    &geometry,
                                    const std::vector<Point>                 &x,
                                    const std::vector<Point>                 &X);
    void                  share_out(const ContactSurfaces &surfaces, const std::vector<FaceRows> &faces);
    void                  add(const ContactSurfaces &surfaces, const FaceRows &face);

    std::vector<Face>  faces_;
    std::vector<Cover> cover_; ///< per slave node, ghosts too
    std::vector<char>  constrained_;
    std::vector<Row> rows_; ///< per slave node; area 0 where not covered or of another scheme; of ghosts the area alone
  };

  template <typename Function>
  void AveragedJump::for_each_part(const std::vector<unsigned int> &slaves,
                                   const unsigned int               slave,
                                   const Function                  &f) const
  {
    unsigned int n_well = 0;
    for (const unsigned int k : slaves)
      n_well += cover_[k] == Cover::well;
    for (unsigned int a = 0; a < slaves.size(); ++a)
      if (slaves[a] == slave)
        f(a, 1.);
      else if (cover_[slave] == Cover::well && cover_[slaves[a]] == Cover::shared_out)
        f(a, 1. / n_well);
  }
} // namespace Nodus

#endif
