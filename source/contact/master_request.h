#ifndef nodus_contact_master_request_h
#define nodus_contact_master_request_h

#include "contact/surface.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/base/bounding_box.h>

#include <map>
#include <vector>

namespace Nodus
{
  /// Box around a face, wherever it bulges: a quadratic or smoothed face passes the box of its nodes by less than an
  /// eighth of its size.
  dealii::BoundingBox<dim> face_box(const SurfaceFace &face, unsigned int degree, const std::vector<Point> &x);

  /// Distance up to which each pair looks for partners: the one asked for, or a quarter of the diagonal of the master
  /// surface at @p x. Collective.
  std::vector<double> search_reach(const std::vector<ContactPairParameters> &pairs,
                                   const ContactSurfaces                    &surfaces,
                                   const std::vector<Point>                 &x);

  /// Master faces of this rank (indices into master_faces(pair)) that other ranks want, by rank and pair: all that can
  /// be partners of their sites as long as no node is farther than @p moves from its place @p x. Collective.
  ///
  /// In two rounds: first the owners tell how far the nearest facing master face is at most from each slave face; then
  /// whatever is nearer is wanted and, for pairs integrated by segments, what lies in the sweep of the slave face.
  std::map<unsigned int, std::vector<std::vector<unsigned int>>>
  wanted_masters(const std::vector<ContactPairParameters> &pairs,
                 const ContactSurfaces                    &surfaces,
                 const std::vector<Point>                 &x,
                 double                                    moves);
} // namespace Nodus

#endif
