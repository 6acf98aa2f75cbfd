#ifndef nodus_contact_tractions_h
#define nodus_contact_tractions_h

#include "contact/contact_assembler.h"
#include <nodus/contact/contact_fields.h>
#include <nodus/parameters/parameters.h>

#include <vector>

namespace Nodus
{
  /// Nodal contact fields of every pair, recovered from the nodal contact forces: traction = force / m_j, which is the
  /// weighted pressure lambda_bar in the normal direction. Faces of this rank and the nodes around. Collective.
  std::vector<ContactFields> contact_fields(const std::vector<ContactPairParameters> &pairs,
                                            const ContactSurfaces                    &surfaces,
                                            const Pairing                            &pairing,
                                            const SurfaceWeights                     &weights,
                                            const Status                             &status,
                                            const ContactAssembler                   &assembler,
                                            const ContactState                       &state,
                                            const ContactResidual                    &residual);

  /// The whole slave surfaces from the parts of all ranks, the same on every rank. Collective.
  std::vector<ContactFields> whole_surface(const std::vector<ContactFields> &parts, MPI_Comm communicator);

  /// Resultants on both sides, area in contact, largest pressure and status counts of every pair. The same on every
  /// rank. Collective.
  std::vector<ContactResultants> contact_resultants(const std::vector<ContactPairParameters> &pairs,
                                                    const ContactSurfaces                    &surfaces,
                                                    const Pairing                            &pairing,
                                                    const JumpOperator                       &jump,
                                                    const SurfaceWeights                     &weights,
                                                    const Status                             &status,
                                                    const ContactState                       &state,
                                                    const ContactResidual                    &residual);
} // namespace Nodus

#endif
