#ifndef nodus_contact_mean_normals_h
#define nodus_contact_mean_normals_h

#include "contact/master_normal.h"
#include "contact/segments.h"

#include <Eigen/Dense>

#include <vector>

namespace Nodus
{
  /// The normals of the averaged scheme, summed over the points of a slave face, and how they follow the sources (eqs.
  /// J3, G36): of the slave nodes that have no projection of their own.
  class MeanNormals
  {
  public:
    /// Sums of functions of the slave nodes.
    using Nodal = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 9, 1>;
    /// Of the logarithm of the weight of a point, its local coordinates and those on the master with respect to nodes.
    using Gradient = Eigen::Matrix<double, 5, Eigen::Dynamic, Eigen::RowMajor>;

    MeanNormals(const ContactGeometry        &geometry,
                const VariationSources       &sources,
                unsigned int                  pair,
                unsigned int                  face,
                ContactPairParameters::Normal kind);

    /// @p hat, @p d_hat: bilinear hats at the point and their slopes; @p nodes: that the gradient is with respect to.
    void add(const MortarPoint                &point,
             double                            weight,
             const Nodal                      &hat,
             const Nodal                      *d_hat,
             const Eigen::Ref<const Gradient> &gradient,
             const std::vector<unsigned int>  &nodes);

    /// Of slave node @p a of the face, not of unit length [area].
    const Vector3 &value(const unsigned int a) const
    {
      return value_[a];
    }
    void add_derivative(unsigned int a, double part, std::vector<NodeDerivative> &derivative) const;

  private:
    const SurfaceGeometry                   &slave_;
    const unsigned int                       face_;
    const bool                               of_slave_; ///< the normals are those of the slave surface
    const MasterNormal                       master_;
    std::vector<Vector3>                     value_;
    std::vector<std::vector<NodeDerivative>> derivative_;
  };
} // namespace Nodus

#endif
