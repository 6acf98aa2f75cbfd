#ifndef nodus_contact_geometry_tangent_h
#define nodus_contact_geometry_tangent_h

#include "contact/contact_assembler.h"
#include "contact/geometry_couplings.h"
#include "contact/site_variation.h"

#include <array>
#include <utility>
#include <vector>

namespace Nodus
{
  class VariedFaces;

  /// What the contact terms gain in the tangent when pairing, areas and frames follow the surfaces (eq. G11-G17). With
  /// the jump [[x]] = G x + offset of a site, its normal n, its area m, and r, minus the force on the slave, these are
  ///
  /// - contact forces: delta G^T r and G^T delta r, where r turns with the frame and follows the slip;
  /// - gaps: n . (delta G x + delta offset) + delta n . [[x]];
  /// - friction laws: delta G times the displacement of the increment, and how the slip follows the frame.
  ///
  /// What is kept is what the caller keeps from one pairing to the next: nodal contact forces m lambda, the tractions
  /// of sticking sites, the length and direction of Lambda. The rows of a multiplier law are divided by area and
  /// threshold before they vary: these are factors of laws that hold in the end.
  ///
  /// Theory section 18 lists what is left out, with its sizes: how smoothing shifts points along the surfaces
  /// (FaceVariation), areas but for the averaged scheme, friction laws of points with several nodes and of integration
  /// points, sites without force.
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

    /// Adds to the variation of @p system, after ContactAssembler::assemble returned @p residual; thresholds follow the
    /// pressure where that has left the system unsymmetric. Collective.
    void add(const ContactState &state, const ContactResidual &residual, LinearSystem &system) const;

  private:
    using Matrix3 = dealii::Tensor<2, dim>;
    using Matrix  = SiteVariation::Matrix;

    /// How the force of a site and its friction law follow normal, area and slip.
    struct Law
    {
      Matrix3 force_normal, force_slip;
      Vector3 force_area, row_normal[2], row_slip[2];
      double  row_area[2] = {0., 0.};
    };
    std::array<Matrix3, 2> tangent_derivatives(unsigned int site) const;
    Law  law(unsigned int site, const ContactState &state, const ContactResidual &residual, bool follows) const;
    void add_friction(unsigned int site, const ContactState &state, bool follows, Law &law) const;

    /// Derivatives with respect to sources.
    using Motion = std::vector<std::pair<unsigned int, Vector3>>;
    /// How the local coordinates of the projection of a site follow the sources (eq. G2); on a rigid master these are
    /// lengths along its principal directions (eq. G18).
    std::array<Motion, 2>       projection_motion(unsigned int site) const;
    void                        add_slave_motion(unsigned int site, const Vector3 &dual, Motion &motion) const;
    std::vector<NodeDerivative> normal_derivative(unsigned int site) const;
    std::vector<NodeDerivative> mean_normal_derivative(unsigned int site, VariedFaces &faces) const;
    std::vector<NodeDerivative> slave_normal_derivative(unsigned int site) const;
    std::vector<NodeDerivative> rigid_normal_derivative(unsigned int site) const;
    void add_projection(unsigned int site, const std::array<Motion, 2> &motion, SiteVariation &variation) const;
    void add_slide(unsigned int site, const Motion &motion, unsigned int coordinate, SiteVariation &variation) const;
    void
    add_rigid_slide(unsigned int site, const Motion &motion, unsigned int coordinate, SiteVariation &variation) const;

    void   vary(unsigned int           site,
                const ContactState    &state,
                const ContactResidual &residual,
                bool                   follows,
                VariedFaces           &faces,
                SiteVariation         &variation,
                GeometryCouplings     &couplings) const;
    void   couple(unsigned int           site,
                  const ContactState    &state,
                  const ContactResidual &residual,
                  const Law             &law,
                  const SiteVariation   &variation,
                  GeometryCouplings     &couplings) const;
    Matrix lever_variation(unsigned int site, const ContactState &state, const SiteVariation &variation) const;
    /// Adds how gaps follow the parts of the offsets of smoothed faces (eq. G9).
    void add_parts(
        unsigned int site, const FaceVariation &face, unsigned int a, double part, GeometryCouplings &couplings) const;
    /// Variation of the gap without that at fixed geometry (eq. G13). It needs the variation of the row before the
    /// balance of moments, which leaves gaps alone.
    Eigen::RowVectorXd
    gap_variation(unsigned int site, const ContactState &state, const SiteVariation &variation) const;

    bool averages(const unsigned int site) const
    {
      return pairs_[surfaces_.pair(site)].scheme == ContactPairParameters::Scheme::averaged;
    }

    /// Its normal is the mean over its surface.
    bool has_mean_normal(const unsigned int site) const
    {
      return averages(site) && geometry_.rigid[surfaces_.pair(site)] == nullptr && !pairing_[site].master.found();
    }

    const std::vector<ContactPairParameters>                 &pairs_;
    const ContactSurfaces                                    &surfaces_;
    const ContactGeometry                                    &geometry_;
    const AveragedJump                                       &averaged_;
    const Pairing                                            &pairing_;
    const JumpOperator                                       &jump_;
    const SurfaceWeights                                     &weights_;
    const Status                                             &status_;
    VariationSources                                          sources_;
    std::vector<std::vector<std::pair<unsigned int, double>>> gap_rows_; ///< per site: slave, d R_lambda / d d_n
    std::vector<double>                                       weight_;   ///< per site: of its point with one node, or 0
  };
} // namespace Nodus

#endif
