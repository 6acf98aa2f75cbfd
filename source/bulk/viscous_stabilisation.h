#ifndef nodus_bulk_viscous_stabilisation_h
#define nodus_bulk_viscous_stabilisation_h

#include "bulk/material.h"
#include "mesh/bodies.h"
#include "solve/block_csr_matrix.h"
#include <nodus/base/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <memory>
#include <vector>

namespace Nodus
{
  /// Dashpots to ground at every node, for bodies that nothing holds before contact closes. A node with the volume V of
  /// a body of stiffness E and size L resists its displacement since the start of the increment with (eq. B5)
  ///
  ///     f = -viscosity E V/L^2 s T/dt du,   T: duration of the interval, dt: of the increment,
  ///
  /// where s falls from 1 to 0 in the course of the interval: at its end nothing is left. The same dashpots hold the
  /// bodies while they are relaxed (run/relaxation.h).
  class ViscousStabilisation
  {
  public:
    /// Collective.
    ViscousStabilisation(const Bodies                                 &bodies,
                         const std::vector<std::unique_ptr<Material>> &materials,
                         const dealii::DoFHandler<dim>                &dof_handler,
                         const dealii::Mapping<dim>                   &mapping);

    /// The increment from @p begin to @p end of an interval. @p viscosity relative, >= 0.
    void set_increment(double viscosity, double begin, double end, double interval_begin, double interval_end);
    bool acts() const
    {
      return rate_ > 0.;
    }
    /// Adds dashpots of @p rate to those of the increment, 0: none.
    void relax(const double rate)
    {
      relaxation_ = rate;
    }

    /// Rates: viscosity s T/dt and what relaxes the bodies [-].
    double rate() const
    {
      return rate_ + relaxation_;
    }
    double relaxation() const
    {
      return relaxation_;
    }
    /// At rate 1, E V/L^2 of the owned degree of freedom number @p i [force/length].
    double unit_resistance(const unsigned int i) const
    {
      return resistance_[i];
    }
    /// Of the owned degree of freedom number @p i against what it moves [force/length].
    double resistance(const unsigned int i) const
    {
      return rate() > 0. ? rate() * resistance_[i] : 0.;
    }

    /// Adds the resistance against @p moved (owned displacements from where the dashpots are at rest) to @p force, zero
    /// at constrained ones, and its tangent to @p matrix.
    void add(const Vector                            &moved,
             const dealii::AffineConstraints<double> &constraints,
             BlockCsrMatrix                          &matrix,
             Vector                                  &force) const;

  private:
    std::vector<double> resistance_; ///< E V/L^2 of the owned degrees of freedom [force/length]
    double              rate_ = 0., relaxation_ = 0.;
  };
} // namespace Nodus

#endif
