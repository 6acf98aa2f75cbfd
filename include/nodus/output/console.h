#ifndef nodus_output_console_h
#define nodus_output_console_h

#include <nodus/output/contact_fields.h>
#include <nodus/solve/newton.h>

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

    void begin_increment(unsigned int increment, unsigned int n_increments, double t);
    /// One row of the iteration table: loop counters side by side, norms, Krylov iterations.
    void newton_iteration(const IterationCounts      &pass,
                          unsigned int                iteration,
                          const NewtonProblem::Norms &norms,
                          unsigned int                krylov);
    /// Statuses that changed in a status pass, or the criterion of a loop pass.
    void remark(const std::string &text);
    void end_increment(const IterationCounts &counts, const std::vector<ContactResultants> &contact);

  private:
    std::ostream                         &stream_;
    bool                                  active_;
    std::chrono::steady_clock::time_point start_, last_progress_;
    unsigned int                          increment_ = 0, n_increments_ = 0;
  };
} // namespace Nodus

#endif
