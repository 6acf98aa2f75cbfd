#ifndef nodus_run_energy_audit_h
#define nodus_run_energy_audit_h

#include "run/equilibrium.h"

#include <vector>

namespace Nodus
{
  /// Takes account of the energies of an increment, and warns where they do not balance.
  class EnergyAudit
  {
  public:
    /// All outlive it.
    EnergyAudit(const Model &model, Journal &journal, States &states, const Equilibrium &equilibrium);

    /// The increment has converged and its materials are committed; displacements, forces and jumps that it started
    /// from are those of the committed state. Adds its energies to those of the state at hand. @p inner: what the judge
    /// has found of that. Collective. @throws SolverFailure on every rank where an energy is not finite
    void account(const InnerEnergy &inner);

  private:
    /// What contact does at this rank's sites: work of rigid masters, of normal forces and of friction on elastic slip
    /// (on the bodies: what surfaces that give way store is lost to them), and dissipation.
    struct ContactWork
    {
      double                    masters = 0., surfaces = 0., friction = 0.;
      std::vector<unsigned int> creating; ///< sites where friction created energy
    };
    ContactWork contact_work() const;
    double      negligible_dissipation() const;
    double      work_of_stresses() const;
    double      unresolved(double resolution) const;
    void        warn(const Energies &increment, const std::vector<unsigned int> &creating) const;

    const Model       &model_;
    Journal           &journal_;
    States            &states_;
    const Equilibrium &equilibrium_;
  };
} // namespace Nodus

#endif
