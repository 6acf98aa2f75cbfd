#ifndef nodus_run_checkpointing_h
#define nodus_run_checkpointing_h

#include "run/checkpoint.h"
#include "run/equilibrium.h"
#include "run/results.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace Nodus
{
  /// Writes the committed state of a run to checkpoints, and continues from one on any number of ranks.
  class Checkpointing
  {
  public:
    /// All outlive it.
    Checkpointing(Model &model, Journal &journal, States &states, Equilibrium &equilibrium, Results &results);

    /// Keeps the checkpoints of an earlier run, as checkpoints.before, out of the way of a run that begins anew.
    /// Collective. @throws InputError
    void set_aside();
    /// There is one to continue from. Collective. @throws InputError when all are damaged or of another format.
    bool exists();
    /// @p path: where the run is. Collective. @throws InputError when the disk does not take it.
    void write(const LoadStepping &path);
    /// Takes back the state and where on its path the run was. Collective. @throws InputError when the checkpoint is of
    /// another model.
    void read(LoadStepping &path);

    /// Once per Newton iteration: writes a checkpoint of what converged last where a signal asks for it. @throws
    /// Interrupted where it asks for the end.
    void heed_signals(const LoadStepping &path);

  private:
    /// Of the model that checkpoints belong to, collected once: all files of the model are read for it.
    const std::map<std::string, std::string> &keys();
    void                                      match_mesh(const std::vector<std::filesystem::path> &pieces);
    void                                      read_pieces(const std::vector<std::filesystem::path> &pieces);

    Model       &model_;
    Journal     &journal_;
    States      &states_;
    Equilibrium &equilibrium_;
    Results     &results_;

    std::map<std::string, std::string> keys_; ///< see keys()
    Checkpoints                        checkpoints_;
  };
} // namespace Nodus

#endif
