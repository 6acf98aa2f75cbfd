#ifndef nodus_run_path_remarks_h
#define nodus_run_path_remarks_h

#include "output/console.h"
#include "run/equilibrium.h"

#include <vector>

namespace Nodus
{
  /// What a user should know of states that are in equilibrium: contact that was lost or never found, round-off,
  /// dashpots that hold what they should not.
  class PathRemarks
  {
  public:
    /// @p from_start: of the path, not from a checkpoint.
    PathRemarks(
        const Model &model, const States &states, const Equilibrium &equilibrium, Console &console, bool from_start);

    /// The increment at hand has converged, and is not committed. Collective.
    void of_increment();
    /// What contact it ended with.
    void note(const std::vector<ContactResultants> &resultants);
    void of_path() const;

  private:
    void warn_of_lost_partners() const;
    void warn_of_noise() const;
    void report_stabilisation();

    const Model       &model_;
    const States      &states_;
    const Equilibrium &equilibrium_;
    Console           &console_;
    std::vector<bool>  never_closed_; ///< by pair; all false from a checkpoint
    /// States that dashpots held in part; of all, the largest part of the largest nodal force, and when that was.
    unsigned int n_increments_ = 0, n_dragged_ = 0;
    double       largest_part_ = 0., dragged_at_ = 0.;
  };
} // namespace Nodus

#endif
