#ifndef nodus_base_profile_h
#define nodus_base_profile_h

#include <nodus/base/types.h>

#include <mpi.h>

#include <array>
#include <chrono>
#include <iosfwd>
#include <string>

namespace Nodus
{
  enum class Phase : unsigned int
  {
    start, ///< libraries, MPI, parameter file
    set_up,
    pairing,
    status,
    contact_assembly,
    bulk_assembly,
    solver_set_up,
    solver_iterations,
    judgement, ///< of the states that are found
    output,
    other
  };
  constexpr unsigned int n_phases = static_cast<unsigned int>(Phase::other) + 1;

  /// Where CPU time and memory go, by phase. Every moment of the process counts for exactly one phase, that of the
  /// innermost scope: phases add up to the total.
  class Profile
  {
  public:
    /// Begins in Phase::set_up; what the process did before is Phase::start.
    Profile();

    /// The phase outside of all scopes, from now on.
    void set_ground(Phase phase);
    /// Reads the private memory at the end of each phase, too: costs some microseconds each.
    void watch_memory();

    class Scope
    {
    public:
      /// Does nothing without a profile.
      Scope(Profile *profile, Phase phase);
      ~Scope();
      Scope(const Scope &)            = delete;
      Scope &operator=(const Scope &) = delete;

    private:
      Profile *const profile_;
      const Phase    before_;
    };
    /// Counts as @p phase until the returned object dies.
    [[nodiscard]] Scope time(const Phase phase)
    {
      return Scope(this, phase);
    }

    unsigned int newton_iterations = 0, krylov_iterations = 0;

    /// CPU and wall seconds of this rank.
    std::string timing_table() const;

    struct Entry
    {
      std::string name;
      /// CPU of all ranks together and of the busiest, wall of the slowest; the largest private
      /// memory (heap and stack) of all ranks together as the phase was left, 0 for a phase that was never entered.
      double       cpu_sum = 0., cpu_mean = 0., cpu_maximum = 0., wall = 0., private_bytes = 0.;
      unsigned int calls = 0;
    };
    struct Report
    {
      std::array<Entry, n_phases> phases;
      Entry                       total;
      unsigned int                ranks, newton_iterations, krylov_iterations;
      DoFIndex                    n_dofs; ///< displacements
      bool                        converged;

      std::string table() const;
      void        write_json(std::ostream &stream) const;
    };
    /// Collective.
    Report report(DoFIndex n_dofs, bool converged, MPI_Comm communicator);

  private:
    struct Seconds
    {
      double       cpu = 0., wall = 0., private_bytes = 0.;
      unsigned int calls = 0;
    };
    Seconds &of(Phase phase)
    {
      return seconds_[static_cast<unsigned int>(phase)];
    }
    /// Gives the time since the last call to the phase at hand.
    void charge();
    /// Ends the phase at hand.
    void enter(Phase phase);

    std::array<Seconds, n_phases>         seconds_;
    Phase                                 current_      = Phase::set_up;
    bool                                  watch_memory_ = false;
    double                                last_cpu_;
    std::chrono::steady_clock::time_point last_wall_;
  };
} // namespace Nodus

#endif
