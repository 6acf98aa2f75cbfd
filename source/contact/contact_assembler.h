#ifndef nodus_contact_contact_assembler_h
#define nodus_contact_contact_assembler_h

#include "contact/jump_operator.h"
#include "contact/pairing.h"
#include "contact/status.h"
#include "contact/surface.h"
#include "contact/surface_weights.h"
#include "solve/linear_system.h"

#include <array>
#include <vector>

namespace Nodus
{
  class ContactScatter;
  struct LawPoint;

  /// Nodal values that the contact terms depend on, of the local surface nodes and slave nodes.
  struct ContactState
  {
    std::vector<Point>   x;          ///< current positions of the surface nodes, of sections of bolts those of (R11)
    std::vector<Vector3> increment;  ///< their displacement since the start of the increment
    std::vector<Vector3> prescribed; ///< what the next correction must add at prescribed components, zero elsewhere
    std::vector<Point>   centre;     ///< of the driven rigid bodies
    std::vector<Vector3> shortening; ///< of sections of bolts, among all that is driven
    std::vector<double>  lambda;     ///< per slave node [pressure]
    std::vector<std::array<double, 2>> Lambda; ///< per slave node, in its tangent frame
    /// As the increment began, per slave node, in space and in the scale of the slip (eq. F4) [length].
    std::vector<Vector3> elastic_slip;
  };

  /// Contact and friction terms of the residual (eq. 49-59; weak form eq. 10-15), owned sites and ghosts.
  struct ContactResidual
  {
    std::vector<Vector3> jump;   ///< per site, work conjugate to its jump: minus the force on the slave [force]
    std::vector<double>  lambda; ///< contact law, per slave node [volume]
    std::vector<std::array<double, 2>> Lambda;          ///< friction law, per slave node
    std::vector<double>                friction_weight; ///< sum of weight |mu lambda_s phi|, per slave node [force]
    std::vector<double> rigid; ///< six per driven rigid body: force and moment about its centre, of owned sites alone
  };

  /// Residual and symmetric tangent of contact and friction for frozen pairing, statuses and threshold.
  ///
  /// Every product of two contact fields is a sum over the points of SurfaceWeights of filtered fields: contact S,
  /// stick S S_f, slip S (1 - S_f), open 1 - S. Nodal statuses filter the nodal values of both factors (eq. 30-34); a
  /// point of the integration point scheme has one jump and one status, which filter the fields at the point (eq.
  /// 16-21).
  class ContactAssembler
  {
  public:
    ContactAssembler(const ContactSurfaces &surfaces,
                     const Pairing         &pairing,
                     const JumpOperator    &jump,
                     const SurfaceWeights  &weights,
                     const Status          &status);

    /// The residual alone. Collective.
    ContactResidual residual(const ContactState &state) const;

    /// Fills the contact couplings, the multiplier scale, the border and the multiplier blocks of the right-hand side
    /// of @p system; subtracts the contact forces from its displacement block (free components only). Collective.
    /// @p linearise_threshold: the thresholds follow the current pressure (site_pressure, eq. T1-T4), and the tangent
    /// gets their derivative with respect to lambda in friction tractions and friction laws: it is not symmetric any
    /// more. What is left out of it where a point has one node stands at LawSum::by_threshold.
    ContactResidual assemble(const ContactState &state, LinearSystem &system, bool linearise_threshold = false) const;

    /// Adds the contact force residual G^T R_jump (eq. N1) to all components, prescribed ones too. Collective
    /// (compresses).
    void add_forces(const ContactResidual &residual, Vector &force) const;

    /// Largest relative violation of the contact and friction laws (eq. N4): lengths over @p length, friction law
    /// absolute. Collective.
    double norm(const ContactResidual &residual, double length) const;

    /// d_n, without what is adjusted, and the tangential jump of the increment (eq. K2), owned sites; 0 where unpaired.
    double                distance(const ContactState &state, unsigned int site) const;
    std::array<double, 2> slip(const ContactState &state, unsigned int site) const;

  private:
    /// Adds what the contact law says of all points of this rank to @p scatter, with the tangent where there is a
    /// @p system, and with the derivative by the thresholds where that is not symmetric.
    void visit_points(const ContactState &state, bool unsymmetric, LinearSystem *system, ContactScatter &scatter) const;
    /// What the contact law of @p point depends on, into @p law.
    void gather(const ContactPoint &point, const ContactState &state, LawPoint &law) const;

    const ContactSurfaces &surfaces_;
    const Pairing         &pairing_;
    const JumpOperator    &jump_;
    const SurfaceWeights  &weights_;
    const Status          &status_;
  };
} // namespace Nodus

#endif
