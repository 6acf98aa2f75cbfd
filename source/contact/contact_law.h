#ifndef nodus_contact_contact_law_h
#define nodus_contact_contact_law_h

#include <nodus/base/types.h>

#include <array>

// The law of contact and friction at one point of a slave surface (theory section 14): numbers in, numbers out. Who
// gathers the numbers, and what the sums are used for, is ContactAssembler's business. No type of Eigen stands here,
// because the library may be built for another instruction set than its callers.

namespace Nodus
{
  /// Status of the fields at a contact point, one a slave node or one for the point.
  struct LawStatus
  {
    bool contact  = false; ///< S
    bool friction = false; ///< in contact with a threshold above the floor; otherwise frictionless
    bool stick    = false; ///< S_f; meaningful where friction holds
  };

  /// Axes in which a slave node or a jump moves.
  struct LawFrame
  {
    Vector3                normal;                       ///< unit, from slave to master
    std::array<Vector3, 2> tangent;                      ///< unit, normal to each other
    std::array<bool, 2>    tangent_free{{false, false}}; ///< void directions carry no friction
    std::array<double, 2>  friction_scale{{1., 1.}};     ///< limit of friction along the tangents over the first one
  };

  /// A slave node at a contact point: what its multipliers are there.
  struct LawNode
  {
    LawStatus             status;
    LawFrame              frame;        ///< of which the multipliers use the tangents
    double                shape;        ///< phi
    double                lambda;       ///< < 0 in compression [pressure]
    std::array<double, 2> Lambda;       ///< along the tangents, friction traction over mu lambda_s
    Vector3               elastic_slip; ///< as the increment began, in the scale of the slip [length]
  };

  /// A jump at a contact point, slave minus master.
  struct LawJump
  {
    LawStatus status;
    LawFrame  frame;
    double    shape;    ///< phi of its slave node, 1 where the point has one jump
    double    distance; ///< d_n > 0 penetration, without what is adjusted [length]
    Vector3   slip; ///< jump of the displacement of the increment, of which the law takes the free tangents [length]
  };

  /// All that the law of a contact point depends on.
  struct LawPoint
  {
    static constexpr unsigned int max_nodes = 9; ///< of a face of degree 2

    unsigned int                   n_nodes = 0, n_jumps = 0; ///< n_jumps is n_nodes or 1
    std::array<LawNode, max_nodes> nodes;
    std::array<LawJump, max_nodes> jumps;
    double                         weight;                  ///< of the quadrature [area]
    double                         threshold;               ///< mu lambda_s <= 0, at the point [pressure]
    double                         normal_augmentation;     ///< h_n > 0 (eq. Q1) [pressure/length]
    double                         tangential_augmentation; ///< h_tau > 0 of this threshold (eq. Q2) [1/length]
    double overclosure    = 0.; ///< that the pressure-gap law gives at the pressure of the point (eq. C1) [length]
    double compliance     = 0.; ///< its derivative with respect to the pressure [length/pressure]
    double elastic_slip   = 0.; ///< slip over which friction reaches its limit (eq. F4) [length]
    double void_threshold = 0.; ///< s_v of integration points without friction (eq. Q4), else 0 [pressure]
    double void_weight    = 1.; ///< w_v of the rows that hold Lambda at zero there
    /// Regularised: the pressure of contact is lambda - h_n d_n, and friction takes the projection on the unit ball
    /// whether it sticks or slips (eq. F3).
    bool in_the_mean = false;
    /// The friction multipliers stay as they are; slip keeps the direction that they have (theory section 14).
    bool held = false;
    /// Whether add_contact_law() fills LawSum::by_threshold.
    bool linearise_threshold = false;
  };

  /// Residual and tangent of contact points with the same unknowns: three components of each jump, then lambda,
  /// Lambda_1, Lambda_2 of each node.
  struct LawSum
  {
    static constexpr unsigned int max_unknowns = 6 * LawPoint::max_nodes;

    /// Nothing yet, of points with @p n_jumps jumps and @p n_nodes nodes: at most LawPoint::max_nodes.
    void reset(unsigned int n_jumps, unsigned int n_nodes);

    unsigned int n_unknowns() const
    {
      return first_node + 3 * n_nodes;
    }
    double tangent(const unsigned int i, const unsigned int j) const
    {
      return matrix[i + j * n_unknowns()];
    }

    unsigned int n_nodes = 0, first_node = 0; ///< lambda of node a is unknown first_node + 3 a
    /// Conjugate to the jumps minus the forces on the slave side [force]; contact law [volume]; friction law [force
    /// length], without friction [area].
    alignas(64) std::array<double, max_unknowns> residual;
    /// Its derivative with respect to the unknowns, n_unknowns x n_unknowns, column by column.
    alignas(64) std::array<double, max_unknowns * max_unknowns> matrix;
    /// The derivative of the residual of the last point that asked for it with respect to its threshold (eq. T3, T4);
    /// h_tau goes with 1/threshold. Where the point has one node, the threshold is a factor of its whole friction law
    /// rows, and the derivative of that factor is left out. There friction that sticks has no derivative, because its
    /// traction mu lambda_s Lambda is kept when the threshold moves; with elastic slip it is Lambda that is kept.
    alignas(64) std::array<double, max_unknowns> by_threshold;
  };

  /// Adds residual and tangent of @p point to @p sum, which has been reset for its numbers of jumps and nodes. The
  /// statuses, the threshold and the augmentations are constants of the tangent, which is symmetric. Where a point is
  /// held, the rows of Lambda have no residual but a regular block, so that the correction of Lambda is zero.
  void add_contact_law(const LawPoint &point, LawSum &sum);

  /// Derivative of the threshold at a point by that of its jump @p a, in as far as the residual depends on it (eq. T1).
  /// No unit.
  double threshold_weight(const LawPoint &point, unsigned int a);
} // namespace Nodus

#endif
