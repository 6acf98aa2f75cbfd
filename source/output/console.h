#ifndef nodus_output_console_h
#define nodus_output_console_h

#include "solve/newton.h"
#include <nodus/contact/contact_fields.h>

#include <chrono>
#include <iosfwd>
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

    /// Of the increment from time @p begin to time @p end, or by the length @p arc where that is not 0.
    void begin_increment(unsigned int increment, double begin, double end, double arc = 0.);
    /// One row of the iteration table: loop counters side by side, norms, Krylov iterations.
    void newton_iteration(const IterationCounts      &pass,
                          unsigned int                iteration,
                          const NewtonProblem::Norms &norms,
                          unsigned int                krylov);
    /// Statuses that changed in a status pass, or the criterion of a loop pass.
    void remark(const std::string &text);
    /// @p progress: part of the load path that is done now, 0 to 1.
    void end_increment(const IterationCounts &counts, const std::vector<ContactResultants> &contact, double progress);

    /// Where a run that is continued begins, for the time to go.
    void begin_at(const double progress)
    {
      progress_at_start_ = progress;
    }

  private:
    std::ostream                         &stream_;
    bool                                  active_;
    std::chrono::steady_clock::time_point start_, last_progress_;
    double                                progress_at_start_ = 0.;
  };
} // namespace Nodus

#endif
