#ifndef nodus_output_console_h
#define nodus_output_console_h

#include <nodus/output/contact_fields.h>
#include <nodus/solve/newton.h>

#include <chrono>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace Nodus
{
  /// The log on the terminal: silent on all ranks but the first.
  class Console
  {
  public:
    /// @p stream is only written to when @p active.
    Console(std::ostream &stream, bool active);

    void line(const std::string &text);

    void begin_increment(unsigned int increment, unsigned int n_increments, double t);
    /// One row of the iteration table: loop counters side by side, norms, Krylov iterations.
    void newton_iteration(const IterationCounts      &pass,
                          unsigned int                iteration,
                          const NewtonProblem::Norms &norms,
                          unsigned int                krylov);
    /// Statuses that changed in a status pass, or the criterion of a loop pass.
    void remark(const std::string &text);
    void end_increment(const IterationCounts &counts, const std::vector<ContactResultants> &contact);

    /// Adds the time until the returned object dies to @p section of the timing table.
    class Timer
    {
    public:
      Timer(Console &console, const std::string &section);
      ~Timer();

    private:
      Console                              &console_;
      std::string                           section_;
      double                                cpu_;
      std::chrono::steady_clock::time_point wall_;
    };
    Timer time(const std::string &section)
    {
      return Timer(*this, section);
    }
    /// CPU (of rank 0) and wall seconds by section.
    void timing_table();

  private:
    struct Seconds
    {
      double       cpu = 0., wall = 0.;
      unsigned int calls = 0;
    };
    std::ostream                         &stream_;
    bool                                  active_;
    std::map<std::string, Seconds>        seconds_;
    std::chrono::steady_clock::time_point start_, last_progress_;
    unsigned int                          increment_ = 0, n_increments_ = 0;
  };
} // namespace Nodus

#endif
