#include "contact/contact_interface.h"
#include "contact/initial_overlap.h"
#include "contact/initial_ties.h"

#include <deal.II/base/mpi.h>

#include <utility>

// The pairs of a ContactInterface that act: how they begin to, and how they cease.

namespace Nodus
{
  void ContactInterface::begin_increment(const double               begin,
                                         const double               end,
                                         const std::vector<double> &resolved_interference)
  {
    surfaces_.move_rigid_masters(begin, end);
    let_act(&ActiveTime::acts, end);
    status_.set_time(end, resolved_interference);
  }

  void ContactInterface::let_act(bool (ActiveTime::*acts)(double) const, const double t)
  {
    std::vector<char> acting;
    for (const ContactPairParameters &pair : pairs_)
      acting.push_back((pair.*acts)(t));
    surfaces_.let_act(std::move(acting));
  }

  std::vector<std::string> ContactInterface::begin(BlockVector &unknowns, const double t, Vector &ended)
  {
    // the first statuses are those before anything has moved, rigid masters included
    surfaces_.move_rigid_masters(t, t);
    add_ended_forces(t, unknowns, ended);
    let_act(&ActiveTime::acts_after, t);
    pair(unknowns, unknowns.block(0));
    std::vector<double> distances;
    for (unsigned int s = 0; s < pairing_.size(); ++s)
      distances.push_back(distance(s) + status_.adjustment(s)); // a run that goes on here has adjusted it before
    refuse_overlap(pairs_, surfaces_, pairing_, distances, t);
    status_.initialize(pairing_, distances, t);
    return describe_untied(pairs_, surfaces_, pairing_, status_, distances, t);
  }

  /// Of the state that the pairs leave behind, which they act in.
  void ContactInterface::add_ended_forces(const double t, BlockVector &unknowns, Vector &ended)
  {
    ContactResidual of_ended;
    of_ended.jump.resize(surfaces_.n_sites());
    bool any = false;
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      if (const ContactPairParameters &pair = pairs_[surfaces_.pair(s)]; pair.acts(t) && !pair.acts_after(t))
      {
        any              = true;
        of_ended.jump[s] = -now_.force[s];
        now_.force[s]    = Vector3();
      }
    if (!dealii::Utilities::MPI::logical_or(any, surfaces_.layout().communicator))
      return;
    let_act(&ActiveTime::acts, t);
    pair(unknowns, unknowns.block(0));
    assembler_.add_forces(of_ended, ended);
  }
} // namespace Nodus
