#ifndef nodus_contact_contact_scatter_h
#define nodus_contact_contact_scatter_h

#include "contact/contact_assembler.h"
#include "contact/contact_law.h"

#include <Eigen/Dense>

#include <array>
#include <vector>

namespace Nodus
{
  /// Site with jump @p a of a contact point: its own one, or that of a slave node.
  inline unsigned int jump_site(const ContactPoint &point, const unsigned int a)
  {
    return point.site != dealii::numbers::invalid_unsigned_int ? point.site : point.slaves[a];
  }

  /// Brings what the contact law says of points into the linear system and the residual: jumps become displacements, of
  /// which the prescribed ones drop out, and motions of driven rigid bodies, which stand in the border.
  class ContactScatter
  {
  public:
    ContactScatter(const ContactSurfaces &surfaces,
                   const Pairing         &pairing,
                   const JumpOperator    &jump,
                   const ContactState    &state);

    /// Adds the weight |mu lambda_s phi| of a point to its slave nodes with friction (eq. Q3).
    void add_friction_weight(const ContactPoint &point, const LawPoint &law);

    /// Adds the residual of the @p sum of points with the unknowns of @p point to what finish() hands over.
    void add(const ContactPoint &point, const LawSum &sum);

    /// Adds their tangent to the contact couplings and the border of @p system, and their right-hand side to what
    /// fill_rhs() brings there.
    void add_tangent(const ContactPoint &point, const LawSum &sum, LinearSystem &system);

    /// Adds the derivative of that sum with respect to the pressures lambda of slave nodes to the variation and the
    /// border: one column of @p derivative for each of @p slaves.
    void add_variation(const ContactPoint              &point,
                       const LawSum                    &sum,
                       const std::vector<unsigned int> &slaves,
                       const Eigen::MatrixXd           &derivative,
                       LinearSystem                    &system) const;

    /// The same with respect to the distance, of a regularised point whose threshold has the derivative @p slope with
    /// respect to it [pressure/length] (eq. T5).
    void add_distance_variation(const ContactPoint &point, const LawSum &sum, double slope, LinearSystem &system) const;

    /// The residual of all ranks. Collective.
    ContactResidual finish();

    /// Fills the right-hand side of the multipliers and of the border, and subtracts the contact forces from that of
    /// the displacements. Collective.
    void fill_rhs(LinearSystem &system);

    /// Adds to the border what turning bodies do to the moments of the forces in @p residual.
    void add_turns(const ContactResidual &residual, LinearSystem &system) const;

  private:
    /// Part of a driven rigid body in the jump of a site (eq. R4), or that of the shortening of a bolt at a section
    /// (eq. R11), which has neither arm nor turns.
    struct RigidShare
    {
      unsigned int                 site, body;
      Vector3                      arm;  ///< the jump has the part omega x arm [length]
      std::array<Vector3, 2 * dim> jump; ///< by T and omega
    };

    /// An unknown of the system in the local ones of a point: in one of them, or in the components of a jump.
    struct Unknown
    {
      DoFIndex     index; ///< flat
      unsigned int first, n;
      Vector3      part;
      unsigned int row = 0; ///< of all with this index

      double of(const double *const local) const
      {
        double sum = part[0] * local[first];
        for (unsigned int i = 1; i < n; ++i)
          sum += part[i] * local[first + i];
        return sum;
      }
    };

    void take_shares();
    void find_unknowns(const ContactPoint &point, const LawSum &sum) const;
    void add_entry(TripletMatrix &inner, DoFIndex row, DoFIndex column, double value, LinearSystem &system) const;
    static void add_resultant(std::vector<double> &sum, const RigidShare &share, const Vector3 &force);

    const ContactSurfaces    &surfaces_;
    const Pairing            &pairing_;
    const JumpOperator       &jump_;
    const ContactState       &state_;
    std::vector<RigidShare>   shares_;         ///< site by site
    std::vector<unsigned int> shares_of_site_; ///< where they begin, and the end; empty without driven bodies
    // scratch
    mutable std::vector<Unknown>  unknowns_;
    mutable std::vector<DoFIndex> rows_; ///< the indices of the unknowns, each once
    mutable std::vector<double>   half_, product_;

    /// Three components of each jump; lambda, two Lambda and, in the residual, the friction weight of each slave node.
    /// The points of this rank add to ghosts, too.
    std::vector<double> jump_residual_, jump_rhs_, law_residual_, law_rhs_;
  };
} // namespace Nodus

#endif
