#ifndef nodus_run_mesh_adaptation_h
#define nodus_run_mesh_adaptation_h

#include "mesh/refinement.h"
#include "run/equilibrium.h"
#include "run/results.h"

namespace Nodus
{
  /// Changes the mesh, and takes the committed state along.
  class MeshAdaptation
  {
  public:
    /// All outlive it.
    MeshAdaptation(Model &model, Journal &journal, States &states, Equilibrium &equilibrium, Results &results);

    /// Before the run begins: all that is expected to come into contact.
    void refine_near_contact();
    /// Refines and coarsens for the solution at hand. @returns whether the mesh has changed; the state is the committed
    /// one then.
    bool adapt();

  private:
    RefinementIndicator estimate_error() const;
    bool                is_own() const; ///< the indicator
    bool                mark(const RefinementIndicator &indicator);
    void                take_state_along();

    Model       &model_;
    Journal     &journal_;
    States      &states_;
    Equilibrium &equilibrium_;
    Results     &results_;
  };
} // namespace Nodus

#endif
