#ifndef nodus_run_load_path_h
#define nodus_run_load_path_h

#include "run/checkpointing.h"
#include "run/energy_audit.h"
#include "run/failure_report.h"
#include "run/judge.h"
#include "run/load_stepping.h"
#include "run/mesh_adaptation.h"
#include "run/path_remarks.h"
#include "run/results.h"
#include "run/strategy.h"

#include <functional>
#include <optional>

namespace Nodus
{
  /// The objects that a load path is followed with.
  struct RunParts
  {
    Model          &model;
    Journal        &journal;
    States         &states;
    Equilibrium    &equilibrium;
    Strategy       &strategy;
    Results        &results;
    MeshAdaptation &adaptation;
    Checkpointing  &checkpointing;
    LoadStepping   &path;
  };

  /// Increment after increment; one that fails is tried again in halves, from exactly the state before.
  class LoadPath
  {
  public:
    explicit LoadPath(const RunParts &parts);

    /// To the end of the path. @p callback: after each converged increment, with its number and time. @throws
    /// SolverFailure, Interrupted
    void follow(const std::function<void(unsigned int, double)> &callback);

  private:
    void        begin_interval();
    bool        solve();
    bool        try_smaller(SolverFailure::Kind failure);
    std::string hold_master(unsigned int pair);
    void        begin_on_surfaces();

    std::optional<unsigned int> pair_to_hold(SolverFailure::Kind failure) const;

    void              check_closing() const;
    void              finish(const std::function<void(unsigned int, double)> &callback);
    bool              may_relax(SolverFailure::Kind failure) const;
    void              judge();
    void              commit();
    void              restore_equilibrium();
    void              say_what_changed(const std::vector<ContactResultants> &before) const;
    [[noreturn]] void give_up(const std::string &reason, const std::string &hint, bool may_shrink);

    RunParts     parts_;
    EnergyAudit  audit_;
    Judge        judge_;
    PathRemarks  remarks_;
    unsigned int first_;                    ///< increment of this run
    unsigned int cut_backs_        = 0;     ///< since the last increment that converged
    bool         relaxing_         = false; ///< the increment at hand ...
    bool         unstable_         = false; ///< ... for iterates of the last attempt at it were not stable
    bool         relaxed_          = false; ///< since the last increment that converged
    unsigned int mesh_repetitions_ = 0;     ///< of the increment at hand on a finer mesh
    unsigned int second_passes_    = 0;     ///< added since the last increment that converged
  };
} // namespace Nodus

#endif
