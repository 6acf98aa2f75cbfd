#ifndef nodus_contact_face_variation_h
#define nodus_contact_face_variation_h

#include "contact/averaged_jump.h"
#include "contact/variation_sources.h"

#include <Eigen/Dense>

#include <array>
#include <vector>

namespace Nodus
{
  /// What a slave face adds to the rows of its slave nodes (AveragedJump, before the division by their areas), and how
  /// that follows the surfaces: integration points move with the overlaps, or slide on the master; their areas, the
  /// dual functions and the covered part change. Exact for the discrete integrals, but for
  /// - the covered part of faces that stick out of the master and are integrated by a fixed rule, which jumps with its
  ///   points;
  /// - normals that are averaged over the face (AveragedJump::Row::normal).
  class FaceVariation
  {
  public:
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    /// @p measure: positions that areas are of; @p current: these are those of the geometry.
    FaceVariation(const ContactPairParameters &pair,
                  const ContactGeometry       &geometry,
                  const VariationSources      &sources,
                  const AveragedJump::Face    &face,
                  const std::vector<Point>    &measure,
                  bool                         current);

    /// Nodes with a weight: of the face, then those of the master or of what carries it.
    const std::vector<unsigned int> &nodes() const
    {
      return nodes_;
    }
    const std::vector<unsigned int> &sources() const
    {
      return sources_;
    }
    /// Derivative with respect to the sources, three components each, of a column of the row of slave node @p a of the
    /// face: the weight of a node, or one of those below.
    const double *row(const unsigned int a, const unsigned int column) const
    {
      return result_.data() + (a * n_columns_ + column) * result_.cols();
    }
    unsigned int area() const
    {
      return nodes_.size();
    }
    /// Jump of the positions beside that of the nodes, and motion of a prescribed rigid master (three each).
    unsigned int offset() const
    {
      return nodes_.size() + 1;
    }
    unsigned int moved() const
    {
      return nodes_.size() + 4;
    }

  private:
    static constexpr int max_local     = 3 * 34;
    static constexpr int n_coordinates = 5; ///< log of the weight, xi, eta, both of the master
    using Row                          = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, max_local>;
    using Row2                         = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor, 2, max_local>;
    using Gradient = Eigen::Matrix<double, n_coordinates, Eigen::Dynamic, Eigen::RowMajor, n_coordinates, max_local>;
    using Nodal    = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 9, 1>;
    using Square   = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 9, 9>;

    /// Sources of points with the same master face, in the order slave nodes, master nodes, slave parts, master parts:
    /// their places in sources_.
    struct Local
    {
      unsigned int              n_slave, n_master, n_slave_parts, n_master_parts;
      std::vector<unsigned int> place;
      unsigned int              size() const
      {
        return place.size();
      }
      unsigned int first_part() const
      {
        return n_slave + n_master;
      }
    };
    /// A column of the rows at a point, and its derivatives with respect to the local coordinates.
    struct Field
    {
      unsigned int column;
      double       value, d[4];
    };
    struct SegmentFrame;

    void number_sources();
    void number_local(unsigned int master_face);
    void add_segments();
    void add_fixed_points();
    void add_point(const MortarPoint &point, const Gradient &gradient);
    void make_fields(const MortarPoint &point, const FaceShape &shape);
    void make_master_fields(const MortarPoint &point);
    void add_vector_field(unsigned int column, const Vector3 &value, const Vector3 *d_slave, const Vector3 *d_master);
    void add_parts(const MortarPoint &point, const Nodal &test, double weight, Matrix &derivative) const;
    void add_products(const Nodal &test, const Nodal *d_test, double weight, Matrix &value, unsigned int row);
    void flush();
    Gradient segment_gradient(const SegmentTrace::Polygon &polygon,
                              const SegmentTrace::Place   &place,
                              const MortarPoint           &point,
                              const SegmentFrame          &frame);
    Gradient fixed_gradient(const MortarPoint &point) const;
    Row      element_gradient(const FaceShape &shape, double xi, double eta, const Gradient &gradient) const;
    void     finish_coverage(double face_area);
    void     take_exact_areas();
    void     finish();
    Nodal    of_slaves(const std::array<double, 9> &nodal) const;

    const ContactPairParameters &pair_;
    const ContactGeometry       &geometry_;
    const VariationSources      &all_sources_;
    const AveragedJump::Face    &face_;
    const std::vector<Point>    &measure_;
    const bool                   current_;
    const SurfaceGeometry       &slave_, &master_;
    const RigidSurface *const    rigid_;
    const double                 part_;
    const bool                   plain_; ///< dual functions alone, no hanging node: the slave part is the node itself
    std::vector<unsigned int>    nodes_, sources_, master_faces_;
    unsigned int                 n_columns_ = 0;
    Local                        local_;
    std::vector<Field>           fields_;
    Matrix                       coefficients_, gradients_; ///< of the products at the points since the last flush
    unsigned int                 n_points_ = 0;
    Matrix                       mass_, phi_, hat_; ///< integrals of phi phi^T, and of columns times phi and hats
    Matrix                       d_mass_, d_phi_, d_hat_, d_coverage_, d_exact_;
    Nodal                        exact_;
    Matrix                       result_;
  };
} // namespace Nodus

#endif
