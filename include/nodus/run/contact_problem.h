#ifndef nodus_run_contact_problem_h
#define nodus_run_contact_problem_h

#include <nodus/base/types.h>
#include <nodus/contact/contact_fields.h>
#include <nodus/parameters/parameters.h>

#include <mpi.h>

#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Bodies in frictional contact, from parameters to results.
  class ContactProblem
  {
  public:
    /// Builds bodies, degrees of freedom, boundary conditions and contact surfaces; writes nothing.
    /// @throws InputError. The log goes to @p log on rank 0.
    ContactProblem(const Parameters &parameters, MPI_Comm communicator, std::ostream &log = std::cout);
    ~ContactProblem();

    /// Follows the load path; results of every converged increment are on disk when it returns or throws.
    /// @throws SolverFailure with the increment, the loop, the reason and the worst node; Interrupted (signals.h) after
    /// SIGTERM and SIGINT, with a checkpoint on disk.
    void run();

    /// run() ends, also when it throws SolverFailure, with CPU time and memory by phase: printed, and as profile.json
    /// in the results folder.
    void profile();

    /// run() continues from the last complete checkpoint in the results folder, on any number of ranks; without any it
    /// begins at t = 0. It throws InputError when the checkpoint is of another model.
    void restart();

    /// Pairs the surfaces in the reference configuration and prints what a run would start from. @p surfaces: a VTU
    /// file for the outer faces and what the case makes of them, or empty. @throws InputError
    void validate(const std::string &surfaces = "");

    /// State of the last converged increment, the same on every rank. Collective: the surfaces are brought together for
    /// whoever asks.
    const std::vector<ContactFields>     &contact_fields() const;
    const std::vector<ContactResultants> &contact_resultants() const;
    const std::vector<std::pair<std::string, Vector3>> &
    reactions() const; ///< by displacement condition: ground on bodies
    /// Of those with free components, at the last converged increment.
    const std::vector<RigidBodyMotion> &rigid_bodies() const;
    /// Of the contact pairs with a Preload, at the last converged increment.
    const std::vector<PreloadSection> &preload_sections() const;
    const IterationCounts             &iterations() const;
    /// Displacement of the node of body @p body (number, from 1) at reference position @p X. Collective; throws
    /// InputError without one.
    Vector3 displacement(unsigned int body, const Point &X) const;

    /// Called after each converged increment with its number and time.
    void on_increment(const std::function<void(unsigned int, double)> &callback);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace Nodus

#endif
