#include "output/console.h"

#include <cstdio>
#include <ostream>

namespace Nodus
{
  namespace
  {
    /// Progress is reported this often, in seconds, on runs that last.
    constexpr double progress_interval = 30.;

    double seconds_since(const std::chrono::steady_clock::time_point &start)
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    template <typename... Arguments>
    std::string format(const char *pattern, const Arguments... arguments)
    {
      char buffer[256];
      std::snprintf(buffer, sizeof buffer, pattern, arguments...);
      return buffer;
    }
  } // namespace

  Console::Console(std::ostream &stream, const bool active)
      : stream_(stream)
      , active_(active)
      , start_(std::chrono::steady_clock::now())
      , last_progress_(start_)
  {
  }

  void Console::line(const std::string &text)
  {
    if (active_)
      stream_ << text << std::endl;
  }

  void Console::begin_increment(const unsigned int increment, const double begin, const double end, const double arc)
  {
    line("");
    line(arc > 0. ? format("Increment %u, from t = %g, arc length %g", increment, begin, arc)
                  : format("Increment %u, t = %g to %g", increment, begin, end));
    line("  geometry threshold status Newton |      force    contact | Krylov");
  }

  void Console::newton_iteration(const IterationCounts      &pass,
                                 const unsigned int          iteration,
                                 const NewtonProblem::Norms &norms,
                                 const unsigned int          krylov)
  {
    line(format("  %8u %9u %6u %6u | %10.3e %10.3e | %6u",
                pass.geometry,
                pass.threshold,
                pass.status,
                iteration,
                norms.force,
                norms.contact,
                krylov));
  }

  void Console::remark(const std::string &text)
  {
    line("    " + text);
  }

  void Console::end_increment(const IterationCounts                &counts,
                              const std::vector<ContactResultants> &contact,
                              const double                          progress)
  {
    line(format("  converged: %u geometry, %u threshold, %u status passes, %u Newton iterations",
                counts.geometry,
                counts.threshold,
                counts.status,
                counts.newton) +
         (counts.krylov > 0 ? format(", %u Krylov iterations", counts.krylov) : "") +
         (counts.fallbacks > 0 ? format(", %u fallbacks", counts.fallbacks) : ""));
    for (const auto &c : contact)
      line(format("  %s: force on slave (%.5g, %.5g, %.5g), max CPRESS %.5g, area %.5g, %u open, %u slip, %u stick",
                  c.name.c_str(),
                  c.slave_force[0],
                  c.slave_force[1],
                  c.slave_force[2],
                  c.maximum_pressure,
                  c.contact_area,
                  c.open,
                  c.slip,
                  c.stick) +
           (c.unpaired > 0 ? format(" (%u without master)", c.unpaired) : ""));
    if (seconds_since(last_progress_) > progress_interval && progress > progress_at_start_ && progress < 1.)
    {
      last_progress_       = std::chrono::steady_clock::now();
      const double elapsed = seconds_since(start_);
      line(format("  progress: %.0f %%, %.0f s elapsed, about %.0f s to go",
                  100 * progress,
                  elapsed,
                  elapsed * (1. - progress) / (progress - progress_at_start_)));
    }
  }
} // namespace Nodus
