#ifndef nodus_contact_surface_weights_h
#define nodus_contact_surface_weights_h

#include "contact/surface.h"
#include <nodus/parameters/parameters.h>

#include <vector>

namespace Nodus
{
  class AveragedJump;

  /// A quadrature point of the contact surface: weight and slave shape functions.
  struct ContactPoint
  {
    double                    weight; ///< [area]
    std::vector<unsigned int> slaves; ///< slave numbers of the face (one only when the weights are lumped)
    std::vector<double>       shape;  ///< phi of the same nodes
    unsigned int              owner;  ///< rank that assembles it
    /// Site with the jump and the statuses of this point; invalid: those of the slave nodes, interpolated.
    unsigned int site = dealii::numbers::invalid_unsigned_int;
  };

  /// Quadrature of the slave surfaces (eq. W1): M_ij = sum over points of weight phi_i phi_j, m_j of weight phi_j.
  ///
  /// `nodal quadrature` (trapezoid, Simpson) and `dual` (biorthogonal multipliers, m_j = int phi_j) have one point a
  /// node, so that every product of filtered fields is nodal; `consistent` has the points of the rule of the pair. The
  /// averaged scheme has one point a node with the area of its jump, the integration point scheme the points of its
  /// rule.
  class SurfaceWeights
  {
  public:
    /// @p x current and @p X reference positions of the surface nodes; each pair takes its own measure. Consistent
    /// weights of pairs that are @p lumped have one point a node like dual ones, with the same m_j. Collective.
    void compute(const std::vector<ContactPairParameters> &pairs,
                 const ContactSurfaces                    &surfaces,
                 const AveragedJump                       &averaged,
                 const std::vector<Point>                 &x,
                 const std::vector<Point>                 &X,
                 const std::vector<bool>                  &lumped = {});

    const std::vector<ContactPoint> &points() const
    {
      return points_;
    }
    /// Nodal areas m_j > 0.
    const std::vector<double> &area() const
    {
      return area_;
    }

    /// (M f)_j / m_j for a nodal field (eq. W2): the weighted nodal value that statuses are tested with; right where
    /// all faces of the node are here, as for own nodes.
    std::vector<double> weighted(const std::vector<double> &nodal_field) const;

  private:
    std::vector<ContactPoint> points_;
    std::vector<double>       area_;
  };
} // namespace Nodus

#endif
