#ifndef nodus_contact_site_variation_h
#define nodus_contact_site_variation_h

#include "contact/face_variation.h"
#include "contact/jump_operator.h"

#include <Eigen/Dense>

#include <array>
#include <vector>

namespace Nodus
{
  /// How the row of G of a contact site, its area, its offset (what is added to G x in the jump of positions) and its
  /// normal follow the sources of a variation: a dense matrix, with rows for the nodes of the row of G and the other
  /// quantities, and columns for the sources that they depend on.
  ///
  /// To be used in this order: clear(), node() and column() for all that will be met, allocate(), then values.
  class SiteVariation
  {
  public:
    using Matrix  = FaceVariation::Matrix;
    using Matrix3 = dealii::Tensor<2, dim>;

    SiteVariation(unsigned int n_surface_nodes, unsigned int n_sources);

    void         clear();
    unsigned int node(unsigned int surface_node);
    unsigned int column(unsigned int source);
    /// Places of a node and of a source that have been met.
    unsigned int place_of_node(const unsigned int surface_node) const
    {
      return place_of_node_[surface_node];
    }
    unsigned int place_of_source(const unsigned int source) const
    {
      return place_of_source_[source];
    }
    void number(const ContactSurfaces &surfaces, const FaceVariation &face);
    void allocate();

    const std::vector<unsigned int> &nodes() const
    {
      return nodes_;
    }
    const std::vector<unsigned int> &columns() const
    {
      return columns_;
    }

    /// Rows: the weights of the nodes, area, then three each of offset, motion of a rigid master, normal.
    Eigen::Index area() const
    {
      return nodes_.size();
    }
    Eigen::Index offset() const
    {
      return nodes_.size() + 1;
    }
    Eigen::Index moved() const
    {
      return nodes_.size() + 4;
    }
    Eigen::Index normal() const
    {
      return nodes_.size() + 7;
    }
    const Matrix &rows() const
    {
      return rows_;
    }
    void add(const Eigen::Index row, const unsigned int column, const Vector3 &value)
    {
      for (unsigned int c = 0; c < dim; ++c)
        rows_(row, 3 * column + c) += value[c];
    }
    void add(const Eigen::Index row, const unsigned int column, const Matrix3 &value)
    {
      for (unsigned int i = 0; i < dim; ++i)
        add(row + i, column, value[i]);
    }

    /// Adds a part of the integrals in the row of slave node @p a of a face, ...
    void add_face(const ContactSurfaces &surfaces, const FaceVariation &face, unsigned int a, double part);
    /// ... which become means: the variation of @p row from the variation of what it was before the division.
    void take_means(const AveragedJump::Row &row);
    /// Replaces the variation of the weights by that after the change that balances moments (eq. G28-G30). @p master:
    /// where shares are of nodes around.
    void balance(const JumpOperator       &jump,
                 const ContactSurfaces    &surfaces,
                 unsigned int              site,
                 const SurfaceGeometry    &master,
                 const SitePairing        &frame,
                 const std::vector<Point> &x);
    /// After balance(): how the turns of the master nodes of a site with a lever vary (eq. G34), three rows each.
    const Matrix &turns() const
    {
      return turns_;
    }

  private:
    using Basis = std::array<Vector3, 2>;
    struct Moments;
    struct Slope;
    /// Fills shares_.
    void vary_shares(const JumpOperator    &jump,
                     const ContactSurfaces &surfaces,
                     unsigned int           site,
                     const SurfaceGeometry &master,
                     const Vector3         &normal);
    void vary_turns(const SitePairing     &site,
                    const Basis           &b,
                    const Eigen::Matrix3d *d_b,
                    const Moments         &moments,
                    const Slope           &slope);
    /// Fills slopes_ with the variations of the moments; @p d_b: of the basis with respect to the normal.
    void vary_moments(const Basis &b, const Eigen::Matrix3d *d_b, const Moments &moments, const std::vector<Point> &x);

    std::vector<unsigned int> nodes_, columns_, place_of_node_, place_of_source_;
    Matrix                    rows_, turns_, slopes_; ///< slopes_: scratch
    Matrix                    shares_;                ///< of the nodes of the row in what balances moments
    std::vector<double>       weight_;                ///< before the change that balances moments
  };
} // namespace Nodus

#endif
