#ifndef nodus_contact_contact_error_h
#define nodus_contact_contact_error_h

#include "bulk/nodal_stress.h"
#include "contact/contact_geometry.h"
#include "contact/surface.h"
#include "mesh/refinement.h"
#include <nodus/contact/contact_fields.h>

#include <vector>

namespace Nodus
{
  /// Adds to @p indicator what a contact solution says about the mesh on both sides of each pair.
  ///
  /// With h, A the size and the area of a slave face and E the softer Young's modulus @p stiffness of its pair, the
  /// squared error of the face is @p weight times h A/E times the sum of (eq. A2)
  /// - the mean square over its nodes of the jump between the contact traction and the recovered stress below it, where
  ///   some node is closed,
  /// - (E g/h)^2, g the gap in the middle of a face whose nodes are all closed, the penetration there where some are,
  /// - the largest squared traction of a face whose nodes are not all open or all closed, a quarter of the square
  ///   of its friction where some stick and some slip: the ends of the contact and of the stick zone lie in it.
  /// The cell of the master face that faces its middle gets the same share. Collective.
  void add_contact_error(double                            weight,
                         const std::vector<double>        &stiffness,
                         const ContactSurfaces            &surfaces,
                         const ContactGeometry            &geometry,
                         const std::vector<ContactFields> &fields,
                         const NodalStress                &stress,
                         RefinementIndicator              &indicator);

  /// The largest pressure at the nodes of the slave faces of a cell, and of those whose middles its master faces face,
  /// by active cell index of @p n_cells; 0 without. Collective.
  std::vector<double> largest_contact_pressure(const ContactSurfaces            &surfaces,
                                               const ContactGeometry            &geometry,
                                               const std::vector<ContactFields> &fields,
                                               unsigned int                      n_cells);

  /// Marks the cells of slave faces that are larger than the master faces they face, by more than a third.
  void
  mark_coarse_slaves(const ContactSurfaces &surfaces, const ContactGeometry &geometry, RefinementIndicator &indicator);

  /// Marks the cells on both sides of gaps up to @p distance of each pair (0: its mean slave face size), measured at
  /// the nodes and the middles of slave faces. Collective.
  void mark_near_contact(const std::vector<double> &distance,
                         const ContactSurfaces     &surfaces,
                         const ContactGeometry     &geometry,
                         RefinementIndicator       &indicator);
} // namespace Nodus

#endif
