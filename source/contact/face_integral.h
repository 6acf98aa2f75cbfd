#ifndef nodus_contact_face_integral_h
#define nodus_contact_face_integral_h

#include "contact/averaged_jump.h"

#include <Eigen/Dense>
#include <boost/serialization/array.hpp>

#include <vector>

namespace Nodus
{
  /// What a slave face adds to the rows of its slave nodes (AveragedJump::Row), before the division by the area.
  struct FaceRows
  {
    static constexpr unsigned int n_vectors = 4 * dim; ///< entries of vectors per slave node

    unsigned int          pair, number; ///< of the face
    std::vector<DoFIndex> slaves;       ///< first degrees of freedom
    std::vector<DoFIndex> nodes;        ///< likewise: nodes of the face, then master nodes
    std::vector<double>   weights;      ///< per slave node: weight of each node, area, full area
    std::vector<double>   vectors;      ///< per slave node: offset, normal, rigid part
    std::array<double, 3> outward = {}; ///< of the face in its middle, unit

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &pair &number &slaves &nodes &weights &vectors &outward;
    }
  };

  /// Slave nodes of a face.
  std::vector<unsigned int> slaves_of(const ContactSurfaces &surfaces, const FaceRows &face);
  /// Whoever owns a node sums over its faces: sends @p mine to all that own a slave node of them. @returns those of
  /// this rank's nodes, in an order that does not depend on the ranks. Collective.
  std::vector<FaceRows> collect(const ContactSurfaces &surfaces, std::vector<FaceRows> mine);

  /// Integrates one slave face of the averaged scheme over its points: what it adds to the rows of its slave nodes.
  class FaceIntegral
  {
  public:
    /// @p measure: positions that areas are of.
    FaceIntegral(const ContactPairParameters &pair,
                 const ContactSurfaces       &surfaces,
                 const ContactGeometry       &geometry,
                 const AveragedJump::Face    &face,
                 const std::vector<Point>    &measure);

    /// To be called once.
    FaceRows integrate();

  private:
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 9, 9>;
    using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 9, 1>;

    /// phi and hats are those of the slave nodes: where some of the face's nodes hang they are conforming.
    template <typename Nodal>
    Column of_slaves(const Nodal &nodal) const
    {
      const auto values = face_.slave_values(nodal);
      return Eigen::Map<const Column>(values.data(), m_);
    }
    double element(const FaceShape &shape) const
    {
      return FaceGeometry(face_, shape, measure_).area_vector().norm();
    }

    /// Nodes of the face, then those of the master.
    void number_nodes();
    /// psi = part (D M^-1)^T phi + (1 - part) hat, with M and D over the covered part.
    void make_dual_functions();
    void add_point(const MortarPoint &point, double weight);
    /// The points on a curved face integrate its shape functions nearly, Gauss points to round-off: nodal areas of
    /// covered faces are those, times the part that they count with (eq. J10).
    void take_exact_areas();

    const ContactPairParameters    &pair_;
    const ContactSurfaces          &surfaces_;
    const SurfaceGeometry          &slave_, &master_;
    const MasterSearch             &search_;
    const RigidSurface *const       rigid_;
    const std::vector<Point>       &measure_;
    const std::vector<MortarPoint> &points_;
    const SurfaceFace              &face_;
    const unsigned int              f_, n_, m_; ///< the face, its nodes and slave nodes
    const double                    part_;      ///< of the dual functions in psi
    const double                    exact_;     ///< part of the exact areas
    const double                    counted_;   ///< part that the points count with, in the mean
    FaceRows                        rows_;
    unsigned int                    n_columns_ = 0;
    std::vector<unsigned int>       nodes_;
    std::vector<double>             weight_; ///< of the points
    Matrix                          dual_;   ///< times part
  };
} // namespace Nodus

#endif
