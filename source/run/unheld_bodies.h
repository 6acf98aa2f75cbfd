#ifndef nodus_run_unheld_bodies_h
#define nodus_run_unheld_bodies_h

#include "contact/free_motions.h"
#include "output/diagnosis/diagnosis.h"
#include "run/load_stepping.h"
#include "run/model.h"

#include <string>
#include <vector>

// Bodies that can move freely: which motions, and what may hold them. All functions are collective.

namespace Nodus
{
  /// Rigid motions that nothing holds at @p state and @p time, or would if all sites with a master point were closed.
  std::vector<FreeMotions::Motion>
  free_motions(const Model &model, const State &state, double time, bool as_closed = false);

  /// What the user can do about a body that is free in @p increment, @p first of all, for a message that ends in this.
  std::string
  ways_to_hold(const Model &model, const State &state, const Increment &increment, const std::string &first);

  /// What the unknown @p flat_index of a singular system in @p increment belongs to, and what to do about it.
  std::string null_pivot_locus(const Model &model, const State &state, const Increment &increment, DoFIndex flat_index);

  /// Soft springs that would hold the bodies with free motions, on the first of their sides that is not in contact.
  std::vector<FailureEvidence::Spring> proposed_springs(const Model &model, const State &state, double time);

  /// A body that nothing but stabilisation holds may cross a surface in one increment, which satisfies the equations.
  /// @throws SolverFailure then.
  void check_stabilised_motion(const Model &model, const States &states);
} // namespace Nodus

#endif
