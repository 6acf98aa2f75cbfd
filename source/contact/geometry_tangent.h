#ifndef nodus_contact_geometry_tangent_h
#define nodus_contact_geometry_tangent_h

#include "contact/contact_assembler.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace Nodus
{
  /// What the contact terms gain in the tangent when pairing and frames follow the surfaces: the jump of a site is
  /// sum_q c_q (x_slave(q) - x_master(xi_q)), and its normal n depends on the master (or slave) nodes and on xi.
  ///
  /// - contact forces: G^T delta r, where r (work conjugate to the jump) turns with n, and delta G^T r, where the
  ///   projections slide, delta xi^alpha = x^alpha . delta(x_slave - x_master): exact where the surfaces touch;
  /// - gaps: delta n . [[x]] - sum_q c_q n . x_,alpha delta xi^alpha (zero where n is the normal of the surface
  ///   itself), and the change of the offsets of smoothed surfaces.
  ///
  /// On a rigid surface in closed form the curvature gives the variation of normals and points; where it moves as
  /// prescribed no force slides.
  ///
  /// Left out: the variation of areas and of the weights c_q (nodal forces do not depend on the areas, see
  /// pair_surfaces), of slips and of normals averaged on the slave side, and the spin of the tangents about n.
  class GeometryTangent
  {
  public:
    GeometryTangent(const std::vector<ContactPairParameters> &pairs,
                    const ContactSurfaces                    &surfaces,
                    const ContactGeometry                    &geometry,
                    const AveragedJump                       &averaged,
                    const Pairing                            &pairing,
                    const JumpOperator                       &jump,
                    const SurfaceWeights                     &weights,
                    const Status                             &status);

    /// Adds to the variation of @p system, after ContactAssembler::assemble returned @p residual. Collective.
    void add(const ContactState &state, const ContactResidual &residual, LinearSystem &system) const;

  private:
    using Matrix3 = dealii::Tensor<2, dim>;
    using Entry   = JumpOperator::Entry;

    /// A projected point: where it moves and how xi follows.
    struct ProjectedPoint
    {
      std::vector<Entry> motion;   ///< of x_slave - x_master at fixed xi
      std::vector<Entry> shape[2]; ///< derivatives of the master shape functions
      Vector3            dual[2];  ///< x^alpha, zero where xi^alpha is held at an edge of the face
      Vector3            tangent[2];
      std::vector<std::pair<unsigned int, double>> sites; ///< and c_q

      void clear()
      {
        for (auto *const entries : {&motion, &shape[0], &shape[1]})
          entries->clear();
        dual[0] = dual[1] = Vector3();
        sites.clear();
      }
    };
    ProjectedPoint slave_point(unsigned int site) const;
    void           project(unsigned int pair, const Projection &master, ProjectedPoint &point) const;
    void           project_on_rigid(const RigidSurface &master, const Point &p, ProjectedPoint &point) const;
    std::vector<NodeDerivative> normal_derivative(unsigned int site) const;

    /// Couplings of a few nodes, dense: blocks (row node, column node) of the force terms, gap rows (slave, column
    /// node).
    struct Blocks
    {
      static constexpr unsigned int none = static_cast<unsigned int>(-1);

      std::vector<unsigned int> nodes, slaves;
      std::vector<unsigned int> place; ///< of a surface node in nodes, or none
      unsigned int              stride = 0;
      std::vector<Matrix3>      force; ///< row * stride + column
      std::vector<Vector3>      gap;   ///< slave * stride + column
      /// What the parts of the offset of a face add to the gap row of a slave: side 0 slave or 1 master.
      struct Offset
      {
        unsigned int           slave, side, face;
        std::array<Vector3, 8> normal;
      };
      std::vector<Offset> offsets;

      void         clear();
      unsigned int node(unsigned int n);
      unsigned int slave(unsigned int k);
    };
    /// The offset at (xi, eta) of a face of a side is part of the jump at @p point.
    void add_offset(
        unsigned int side, unsigned int face, double xi, double eta, const ProjectedPoint &point, Blocks &blocks) const;
    void finish_offsets(unsigned int pair, Blocks &blocks) const;
    void add_point(const ProjectedPoint &point, const ContactResidual &residual, Blocks &blocks) const;
    /// Sliding of the points of a face (averaged scheme, @p point is scratch) and of a site with its own projection.
    void add_face(const AveragedJump::Face &face,
                  const ContactResidual    &residual,
                  ProjectedPoint           &point,
                  Blocks                   &blocks) const;
    void add_site(unsigned int site, const ContactResidual &residual, Blocks &blocks) const;
    /// Turning of the normal of a site.
    void add_turn(unsigned int site, const ContactState &state, const ContactResidual &residual, Blocks &blocks) const;
    /// Only sites that carry force have a variation.
    static bool is_active(const ContactResidual &residual, const unsigned int site)
    {
      return residual.jump[site].norm_square() > 0.;
    }
    /// The same of all nodes: force blocks by row node * number of nodes + column node, gap rows by slave likewise.
    struct Sum
    {
      std::unordered_map<std::uint64_t, Matrix3> force;
      std::unordered_map<std::uint64_t, Vector3> gap;
    };
    void add_to(Sum &sum, const Blocks &blocks) const;
    class Writer;
    void write(const Sum &sum, const ContactState &state, LinearSystem &system) const;

    const std::vector<ContactPairParameters>                 &pairs_;
    const ContactSurfaces                                    &surfaces_;
    const ContactGeometry                                    &geometry_;
    const AveragedJump                                       &averaged_;
    const Pairing                                            &pairing_;
    const JumpOperator                                       &jump_;
    const SurfaceWeights                                     &weights_;
    const Status                                             &status_;
    std::vector<std::vector<std::pair<unsigned int, double>>> gap_rows_; ///< per site: slave, d R_lambda / d d_n
  };
} // namespace Nodus

#endif
