#include "run/stability.h"
#include "parallel/owned_values.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace Nodus
{
  namespace
  {
    /// Inverse iterations of an increment, with factors at hand: the motion is that of the increment before.
    constexpr unsigned int iterations_per_increment = 2;
    /// Displacements up to which eigenvalues are counted.
    constexpr DoFIndex largest_counted = 150000;
  } // namespace

  Stability::Stability(const Model &model, Equilibrium &equilibrium)
      : model_(model)
      , equilibrium_(equilibrium)
  {
  }

  void Stability::begin_on_mesh()
  {
    solver_.reset();
    mode_ = Vector();
  }

  /// A motion that has all others in it, the same on any number of ranks.
  void Stability::start()
  {
    mode_.reinit(model_.contact->surfaces().layout().owned[0], model_.communicator);
    const OwnedValues value(mode_);
    for (const DoFIndex i : model_.contact->surfaces().layout().owned[0])
      value(i) = std::sin(1. + 12.9898 * static_cast<double>(i));
  }

  bool Stability::follow()
  {
    const BlockLayout &layout = model_.contact->surfaces().layout();
    if (mode_.size() != layout.n_u)
      start();
    const auto &constraints = model_.boundary_conditions->homogeneous_constraints();
    double      stiffness   = 0.;
    BlockVector force, motion;
    layout.reinit(force);
    for (unsigned int k = 0; k < iterations_per_increment; ++k)
    {
      double work = 0.;
      {
        const OwnedValues f(force.block(0)), z(mode_);
        unsigned int      n = 0;
        for (const DoFIndex i : layout.owned[0])
        {
          f(i) = constraints.is_constrained(i) ? 0. : model_.stabilisation->unit_resistance(n) * z(i);
          ++n;
        }
      }
      if (!equilibrium_.solve_again(force, motion))
        return false;
      work                 = force.block(0) * motion.block(0);
      const double largest = motion.block(0).linfty_norm();
      if (!std::isfinite(work) || !(largest > 0.))
      {
        mode_ = Vector();
        return false;
      }
      stiffness = work;
      mode_     = motion.block(0);
      mode_ /= largest;
      if (equilibrium_.solver_type() != LinearSolverParameters::Type::direct)
        break; // one costs as much as a Newton iteration
    }
    return stiffness < 0.;
  }

  bool Stability::can_count() const
  {
    return model_.dof_handler.n_dofs() <= largest_counted;
  }

  unsigned int Stability::n_unstable(const double rate)
  {
    const BlockLayout &layout = model_.contact->surfaces().layout();
    if (!solver_)
      solver_ = std::make_unique<DirectSolver>(layout);
    BlockVector                solution;
    const LinearSolver::Report report  = solver_->solve(equilibrium_.symmetric_system(rate), solution);
    const long                 surplus = report.negative_pivots - 3 * static_cast<long>(layout.n_slave_nodes);
    return surplus > 0 ? static_cast<unsigned int>(surplus) : 0;
  }
} // namespace Nodus
