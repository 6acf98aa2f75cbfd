#ifndef nodus_contact_face_variation_h
#define nodus_contact_face_variation_h

#include "contact/averaged_jump.h"
#include "contact/mean_normals.h"

#include <Eigen/Dense>

#include <array>
#include <optional>
#include <vector>

namespace Nodus
{
  template <int columns>
  struct SegmentFrame;

  /// What a slave face adds to the rows of its slave nodes (AveragedJump, before the division by their areas), and how
  /// that follows the nodes: integration points move with the overlaps, or slide on the master; their areas, the dual
  /// functions and the covered part change (eq. G19-G27). Exact for the discrete integrals, but for
  /// - points that smoothing shifts along the surfaces as these bend, which would couple every force with two rings of
  ///   nodes on both sides (the offsets themselves are in, by parts());
  /// - points of a fixed rule that fade out beyond the rim: where the rim is that of rigid triangles, and the change of
  ///   the normal and the size of the master face there.
  class FaceVariation
  {
  public:
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    /// @p measure: positions that areas are of; @p current: these are those of the geometry; @p normals: kind of those
    /// that are wanted, too.
    FaceVariation(const ContactGeometry                       &geometry,
                  const VariationSources                      &sources,
                  const AveragedJump::Face                    &face,
                  const std::vector<Point>                    &measure,
                  bool                                         current,
                  std::optional<ContactPairParameters::Normal> normals);

    /// Nodes with a weight, and that derivatives are with respect to: of the face, then those of the master or of what
    /// carries it.
    const std::vector<unsigned int> &nodes() const
    {
      return nodes_;
    }
    /// Derivatives of a column of the row of slave node @p a of the face, three components for each node: the weight of
    /// a node, or one of those below.
    const double *row(const unsigned int a, const unsigned int column) const
    {
      return result_.data() + (a * n_columns_ + column) * result_.cols();
    }
    /// These are zero.
    bool is_void(const unsigned int a, const unsigned int column) const
    {
      return plain_ && column < first_ && column != a && column != area();
    }
    unsigned int weight(const unsigned int node) const
    {
      return node < n_ ? node : node + 7;
    }
    unsigned int area() const
    {
      return n_;
    }
    /// Motion of a prescribed rigid master, and the jump of the positions beside that of the nodes (three each).
    unsigned int moved() const
    {
      return n_ + 1;
    }
    unsigned int offset() const
    {
      return n_ + 4;
    }

    /// That were wanted.
    const MeanNormals &normals() const
    {
      return *normals_;
    }

    /// Sources that are no nodes: the offset in the row of slave node @p a follows part @p i with this weight.
    const std::vector<unsigned int> &parts() const
    {
      return parts_;
    }
    double part_weight(const unsigned int a, const unsigned int i) const
    {
      return part_weight_(a, i);
    }

  private:
    static constexpr int max_local     = 3 * 18;
    static constexpr int n_coordinates = 5; ///< log of the weight, xi, eta, both of the master
    using Row                          = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, max_local>;
    using Row2                         = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor, 2, max_local>;
    using Gradient    = Eigen::Matrix<double, n_coordinates, Eigen::Dynamic, Eigen::RowMajor, n_coordinates, max_local>;
    using AnyGradient = MeanNormals::Gradient;
    template <int columns>
    using FixedGradient = Eigen::Matrix<double, n_coordinates, columns, Eigen::RowMajor>;
    using Nodal         = MeanNormals::Nodal;

    /// Nodes that move points with the same master face, slave nodes first: their places in nodes_.
    struct Local
    {
      unsigned int              n_slave, n_master;
      std::vector<unsigned int> place;
      unsigned int              first_part; ///< of the master face, in parts_
      unsigned int              size() const
      {
        return place.size();
      }
    };
    /// A column of the rows at a point, and its derivatives with respect to the local coordinates.
    struct Field
    {
      unsigned int column;
      double       value, d[4];
    };
    /// Products at the points since the last flush: what multiplies the motions of the points, and these.
    struct Batch
    {
      std::vector<Field> fields; ///< of the point at hand
      Matrix             coefficients, gradients, product;
      unsigned int       n_points = 0;
    };
    /// Integrals over the face by slave node and column, their derivatives by slave node times column and node, and
    /// integrals of the functions of the parts.
    struct Integrals
    {
      Matrix value, derivative, parts;
    };
    /// Derivatives of what the points cover.
    struct CoverageRates
    {
      Matrix fraction, counted;
    };
    void number_nodes();
    void number_local(unsigned int master_face);
    void add_all_points();
    template <int columns>
    void add_segments();
    void add_fixed_points();
    void fade_out(const MortarPoint &point, const FaceShape &shape, Gradient &gradient);
    void add_point(const MortarPoint &point, const Eigen::Ref<const AnyGradient> &gradient);
    void make_fields(const MortarPoint &point, const FaceShape &shape);
    void make_meshed_fields(const MortarPoint &point, Vector3 &offset, Vector3 *d_offset);
    void make_rigid_fields(const MortarPoint &point, Vector3 &offset, Vector3 *d_offset);
    void add_vector_field(unsigned int column, const Vector3 &value, const Vector3 *d);
    void add_parts(const MortarPoint &point, const Nodal &test, double weight, Matrix &sum) const;
    void add_products(const Nodal &test, const Nodal *d_test, double weight, Matrix &value, unsigned int row);
    /// Bilinear ones of the slave nodes, and their slopes.
    std::array<Nodal, 3> hats(const MortarPoint &point) const;
    void                 add_normals(const MortarPoint                   &point,
                                     double                               weight,
                                     const Nodal                         &hat,
                                     const Nodal                         *d_hat,
                                     const Eigen::Ref<const AnyGradient> &gradient);
    void                 flush();
    template <int columns>
    FixedGradient<columns> segment_gradient(const SegmentTrace::Polygon &polygon,
                                            const SegmentTrace::Place   &place,
                                            const MortarPoint           &point,
                                            const SegmentFrame<columns> &frame);
    Gradient               fixed_gradient(const MortarPoint &point);
    template <typename Element, typename Motion>
    Element element_gradient(const FaceShape &shape, double xi, double eta, const Motion &motion) const;
    Row     fixed_element_gradient(const FaceShape &shape, double xi, double eta) const;
    void    take_exact_areas();
    void    finish();
    void    finish_partly(const Matrix &C, const Matrix &parts);
    Nodal   of_slaves(const std::array<double, 9> &nodal) const;

    const VariationSources    &all_sources_;
    const AveragedJump::Face  &face_;
    const std::vector<Point>  &measure_;
    const bool                 current_;
    const SurfaceGeometry     &slave_, &master_;
    const MasterSearch        &search_;
    const RigidSurface *const  rigid_;
    const double               part_;
    const bool                 plain_; ///< dual functions alone, no hanging node: the slave part is the node itself
    const unsigned int         n_;     ///< nodes of the face
    std::vector<unsigned int>  nodes_, parts_, master_faces_;
    unsigned int               n_columns_ = 0, first_ = 0; ///< first_ that the points contribute to
    Local                      local_;
    Batch                      batch_;
    Integrals                  mass_, phi_, hat_, exact_; ///< of phi phi^T, of columns times phi and hats, of phi
    CoverageRates              d_coverage_;
    Matrix                     part_weight_, result_;
    std::optional<MeanNormals> normals_;
  };
} // namespace Nodus

#endif
