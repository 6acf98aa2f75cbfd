#ifndef nodus_bulk_boundary_conditions_h
#define nodus_bulk_boundary_conditions_h

#include "mesh/hanging_nodes.h"
#include "mesh/point_location.h"
#include "mesh/region.h"
#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <deal.II/base/function.h>
#include <deal.II/base/index_set.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Nodus
{
  /// Prescribed displacements of all displacement conditions, and the list of load conditions.
  class BoundaryConditions
  {
  public:
    /// A load condition ready for quadrature: value at (X, t) has an entry for each direction.
    struct Load
    {
      const BoundaryConditionParameters *parameters;
      std::string                        label; ///< for messages
      Region                             region;
      dealii::Function<dim>             *value;      ///< time-dependent: set_time(t), then value(X, component)
      std::optional<PointInCell>         place;      ///< of a condition at a point, which has no faces
      std::vector<Vector3>               directions; ///< that the entries of value act along; none of a pressure
      /// The reference position of that.
      Point point() const
      {
        return {parameters->point[0], parameters->point[1], parameters->point[2]};
      }
    };

    /// @throws InputError, on every rank: bad expression, a point outside of the bodies, a region without any node
    /// (displacement), face (traction, pressure, spring) or cell (body force), two conditions that prescribe different
    /// values for the same degree of freedom at the start, the middle or the end of the time in which both act. The
    /// predicate of a region is evaluated at nodes, at the centres of faces and at the centres of cells, respectively;
    /// body forces ignore boundary ids. @p interval_ends: the times at which conditions may begin or cease to act, and
    /// the last of all. All nodes of the rigid ones among @p body_parameters (of all bodies, or empty) are prescribed,
    /// too, for those with free components and for coupled faces as they are (RigidBodies moves them); nothing else may
    /// hold these, nor springs and pressures act on those bodies. Bodies, degrees of freedom and mapping outlive the
    /// conditions.
    BoundaryConditions(const std::vector<BoundaryConditionParameters> &parameters,
                       const Bodies                                   &bodies,
                       const dealii::DoFHandler<dim>                  &dof_handler,
                       const dealii::Mapping<dim>                     &mapping,
                       const std::vector<double>                      &interval_ends,
                       const std::vector<BodyParameters>              &body_parameters = {});

    /// Evaluates the prescribed displacements that act at time @p t. @returns whether other ones do than before: then
    /// constraints and reaction regions are new. Collective.
    bool set_time(double t);

    /// Homogeneous constraints at the prescribed degrees of freedom (and hanging nodes), locally relevant lines,
    /// closed.
    const dealii::AffineConstraints<double> &homogeneous_constraints() const
    {
      return homogeneous_;
    }

    /// The same lines with inhomogeneity prescribed(t) - u, so that the next Newton correction meets the
    /// prescribed value. @p u has ghost entries. The reference stays valid until the next call.
    const dealii::AffineConstraints<double> &increment_constraints(const Vector &u);

    /// Those of the last increment_constraints() without the lines of coupled faces, whose rows and columns of the
    /// tangent make the border of the system.
    const dealii::AffineConstraints<double> &assembly_constraints() const
    {
      return couples_ ? assembly_ : increment_;
    }

    std::vector<Load> &loads()
    {
      return loads_;
    }

    /// Displacement conditions whose reactions are reported, without degrees of freedom while they do not act. A degree
    /// of freedom belongs to the first condition that prescribes it; the sum of the residual over owned dofs and ranks
    /// is the reaction.
    struct ReactionRegion
    {
      std::string           name;
      std::vector<DoFIndex> dofs[dim]; ///< owned dofs of component c that this condition prescribes
    };
    const std::vector<ReactionRegion> &reaction_regions() const
    {
      return reaction_regions_;
    }

  private:
    /// A prescribed degree of freedom that is not a hanging node.
    struct Prescribed
    {
      DoFIndex     dof;
      Point        X;
      unsigned int condition; ///< index into functions_
      unsigned int entry;     ///< which of the condition's expressions
      double       value;     ///< at the current time
    };
    struct Held; ///< the condition and the place of an owned prescribed degree of freedom
    /// A time in which the same displacement conditions act.
    struct Stage
    {
      double            begin, end;
      std::vector<bool> acts; ///< by condition; false for loads
    };

    void                     add_loads();
    void                     find_stages(const std::vector<double> &interval_ends);
    void                     enter(unsigned int stage);
    std::map<DoFIndex, Held> find_held(const Stage &stage);
    void                     collect_prescribed(const std::map<DoFIndex, Held> &held);
    void                     make_constraints();
    std::string              label(unsigned int condition) const;
    bool                     is_driven(unsigned int condition) const;

    const Bodies                                       &bodies_;
    const dealii::DoFHandler<dim>                      &dof_handler_;
    const dealii::Mapping<dim>                         &mapping_;
    std::vector<Stage>                                  stages_;
    unsigned int                                        stage_ = 0; ///< the one at hand
    unsigned int                                        n_given_;   ///< conditions; those of rigid bodies follow
    std::vector<bool>                                   driven_;    ///< by body: rigid, with free components
    std::vector<BoundaryConditionParameters>            parameters_;
    std::vector<std::unique_ptr<dealii::Function<dim>>> functions_;
    std::vector<Prescribed>                             prescribed_; ///< locally relevant
    HangingNodes                                        hanging_;
    dealii::AffineConstraints<double>                   lines_;          ///< not closed: hanging nodes unresolved
    dealii::AffineConstraints<double>                   assembly_lines_; ///< likewise, without coupled faces
    bool                                                couples_;        ///< some condition is a coupled face
    dealii::AffineConstraints<double>                   homogeneous_, increment_, assembly_;
    std::vector<Load>                                   loads_;
    std::vector<ReactionRegion>                         reaction_regions_;
  };
} // namespace Nodus

#endif
