#include "run/path_remarks.h"
#include "mesh/sides.h"

#include <deal.II/base/mpi.h>

#include <iomanip>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Forces of viscous stabilisation beyond this part of the largest nodal force are warned of.
    constexpr double large_drag = 0.01;
    /// Forces whose noise is so many times what Newton's method asks for are warned of.
    constexpr double large_noise = 10.;
  } // namespace

  PathRemarks::PathRemarks(
      const Model &model, const States &states, const Equilibrium &equilibrium, Console &console, const bool from_start)
      : model_(model)
      , states_(states)
      , equilibrium_(equilibrium)
      , console_(console)
      , never_closed_(model.contact->surfaces().n_pairs(), from_start)
  {
  }

  void PathRemarks::of_increment()
  {
    ++n_increments_;
    warn_of_lost_partners();
    warn_of_noise();
    report_stabilisation();
  }

  void PathRemarks::note(const std::vector<ContactResultants> &resultants)
  {
    for (unsigned int p = 0; p < never_closed_.size(); ++p)
      never_closed_[p] = never_closed_[p] && resultants[p].slip + resultants[p].stick == 0;
  }

  /// Closed sites without a master point, which slid off the master or went through it, satisfy the equations, too.
  void PathRemarks::warn_of_lost_partners() const
  {
    const ContactInterface   &contact  = *model_.contact;
    const ContactSurfaces    &surfaces = contact.surfaces();
    const auto               &closed   = states_.committed.contact.statuses.contact;
    unsigned int              n_closed = 0;
    std::vector<unsigned int> lost;
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      if (surfaces.is_owned(s) && surfaces.has_status(s) && closed[s])
      {
        ++n_closed;
        if (!contact.pairing()[s].found && !contact.is_shared_out(s))
          lost.push_back(s);
      }
    const MPI_Comm     communicator = model_.communicator;
    const unsigned int n_lost       = dealii::Utilities::MPI::sum(static_cast<unsigned int>(lost.size()), communicator);
    n_closed                        = dealii::Utilities::MPI::sum(n_closed, communicator);
    if (n_lost > 0)
      console_.remark("warning: " + std::to_string(n_lost) + " of " + std::to_string(n_closed) +
                      " closed sites have no master point any more, first " + contact.loci(lost, 1).front() +
                      ": they slid off the master surface, or went through it in too large an increment");
  }

  /// Says what round-off leaves of forces that are small against stiffness times displacement.
  void PathRemarks::warn_of_noise() const
  {
    const NodalForces &forces = equilibrium_.forces();
    const double       lost   = forces.noise * model_.parameters.newton.force_tolerance;
    if (forces.noise <= large_noise ||
        std::max(forces.external.linfty_norm(), forces.contact.linfty_norm()) <= lost * forces.largest)
      return; // the latter: nothing acts
    std::ostringstream text;
    text << std::setprecision(2) << "warning: round-off leaves " << lost
         << " of the largest force unknown: forces are small against the stiffness of the bodies times the size of a "
            "cell, or times the displacements; bodies that start near each other lose fewer digits";
    console_.remark(text.str());
  }

  void PathRemarks::of_path() const
  {
    for (unsigned int p = 0; p < never_closed_.size(); ++p)
      if (never_closed_[p])
        console_.remark("warning: contact pair " + std::to_string(p + 1) +
                        in_brackets(model_.parameters.contact_pairs[p].name) +
                        " was open at the end of every increment: are its surfaces the right ones, and do the loads "
                        "press them together? --validate tells its gaps");
    if (n_dragged_ > 0)
    {
      std::ostringstream text;
      text << std::setprecision(2) << "warning: viscous stabilisation held " << n_dragged_ << " of " << n_increments_
           << " states in part, with up to " << 100. * largest_part_
           << " % of the largest nodal force (t = " << std::setprecision(4) << dragged_at_
           << "); only where intervals end nothing is left of it. 'Viscous stabilisation' takes one value for each "
              "interval: 0 for those that begin with closed contact";
      console_.remark(text.str());
    }
  }

  /// Says how much of the balance of the increment is due to viscous stabilisation.
  void PathRemarks::report_stabilisation()
  {
    if (!model_.stabilisation->acts())
      return;
    const NodalForces &forces = equilibrium_.forces();
    const double       drag   = forces.drag.linfty_norm();
    const double       part   = drag / forces.scale;
    std::ostringstream text;
    text << std::setprecision(2) << "viscous stabilisation carries " << 100. * part << " % of the largest nodal force ("
         << drag << " of " << forces.scale << ')';
    if (part > largest_part_)
    {
      largest_part_ = part;
      dragged_at_   = equilibrium_.increment().end;
    }
    if (part > large_drag)
    {
      ++n_dragged_;
      text << ": dashpots hold this state in part; they are gone at t = " << equilibrium_.increment().interval_end
           << ", and if states before that matter, give more increments or a smaller 'Viscous stabilisation'";
    }
    console_.remark(text.str());
  }

} // namespace Nodus
