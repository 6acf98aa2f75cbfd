#ifndef nodus_contact_site_values_h
#define nodus_contact_site_values_h

#include "contact/contact_assembler.h"

#include <vector>

namespace Nodus
{
  /// Contact pressure of every site (eq. S1) [pressure]: lambda_bar = S_j (M S lambda)_j / m_j at slave nodes,
  /// the force on the node over its area; lambda interpolated at integration points, open ones too. Collective.
  std::vector<double> site_pressure(const ContactSurfaces     &surfaces,
                                    const SurfaceWeights      &weights,
                                    const Status              &status,
                                    const std::vector<double> &lambda);

  /// The pressure that friction follows: site_pressure(), and at regularised points that which acts (eq. F3), so that
  /// friction vanishes as they open [pressure]. Collective.
  std::vector<double> friction_pressure(const ContactSurfaces  &surfaces,
                                        const Pairing          &pairing,
                                        const SurfaceWeights   &weights,
                                        const Status           &status,
                                        const ContactAssembler &assembler,
                                        const ContactState     &state);

  /// Overclosure that pressure-gap laws give at every site, of the multipliers that the contact law has there, at open
  /// ones that of pressure 0; 0 where contact is hard [length]. @p pressure: as site_pressure() gives it.
  std::vector<double> site_overclosures(const ContactSurfaces     &surfaces,
                                        const Status              &status,
                                        const std::vector<double> &pressure,
                                        const std::vector<double> &lambda);

  /// What elastic slip takes of the slip of the increment (eq. F4), along the tangents of every site, 0 where there is
  /// none [length]. Right at owned sites. Collective.
  std::vector<std::array<double, 2>> elastic_slip_change(const ContactSurfaces &surfaces,
                                                         const Pairing         &pairing,
                                                         const SurfaceWeights  &weights,
                                                         const Status          &status,
                                                         const ContactState    &state);

  /// What the status tests look at (eq. S1). Friction as the pressure: at slave nodes the weighted mean of Lambda by
  /// components, of nodes with friction; at integration points Lambda interpolated in space. `Status test = raw` takes
  /// the nodal unknowns. Right at owned sites. Collective.
  StatusInput status_input(const std::vector<ContactPairParameters> &pairs,
                           const ContactSurfaces                    &surfaces,
                           const Pairing                            &pairing,
                           const SurfaceWeights                     &weights,
                           const Status                             &status,
                           const ContactAssembler                   &assembler,
                           const ContactState                       &state);

  /// How far prescribed displacements move a site along its closest master point in the increment [length]: the motion
  /// of the nodes that are prescribed there. Averages reach nodes beside that point, too, which move as the body does;
  /// on a plane of symmetry that is no slip. Where no master has faces, the jump of the increment.
  Vector3 prescribed_motion(const ContactSurfaces      &surfaces,
                            const Pairing              &pairing,
                            const JumpOperator         &jump,
                            const std::vector<Vector3> &increment,
                            unsigned int                site);
} // namespace Nodus

#endif
