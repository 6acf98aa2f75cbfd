#include "base/profile.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <limits>
#include <ostream>
#include <vector>

namespace Nodus
{
  namespace
  {
    // in the order of Phase
    const char *const names[n_phases] = {"program start",
                                         "mesh and set-up",
                                         "pairing",
                                         "status",
                                         "contact assembly",
                                         "bulk assembly",
                                         "solver set-up",
                                         "solver iterations",
                                         "judge",
                                         "output",
                                         "other"};

    /// Of all threads of the process.
    double cpu_seconds()
    {
      timespec t;
      clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
      return t.tv_sec + 1e-9 * t.tv_nsec;
    }

    /// Heap and stack of the process, without the pages of files and libraries that it shares; 0 where there is no
    /// Linux to ask.
    double private_bytes()
    {
      std::ifstream status("/proc/self/status");
      for (std::string key; status >> key; status.ignore(std::numeric_limits<std::streamsize>::max(), '\n'))
        if (double kilobytes = 0.; key == "RssAnon:" && status >> kilobytes)
          return 1024. * kilobytes;
      return 0.;
    }

    template <typename... Arguments>
    std::string format(const char *pattern, const Arguments... arguments)
    {
      char buffer[256];
      std::snprintf(buffer, sizeof buffer, pattern, arguments...);
      return buffer;
    }
  } // namespace

  Profile::Profile()
      : last_cpu_(cpu_seconds())
      , last_wall_(std::chrono::steady_clock::now())
  {
    of(Phase::start).cpu   = last_cpu_;
    of(Phase::start).calls = of(current_).calls = 1;
    of(Phase::start).private_bytes              = private_bytes();
  }

  void Profile::set_ground(const Phase phase)
  {
    enter(phase);
    ++of(phase).calls;
  }

  void Profile::watch_memory()
  {
    watch_memory_ = true;
  }

  void Profile::charge()
  {
    const double cpu  = cpu_seconds();
    const auto   wall = std::chrono::steady_clock::now();
    of(current_).cpu += cpu - last_cpu_;
    of(current_).wall += std::chrono::duration<double>(wall - last_wall_).count();
    last_cpu_  = cpu;
    last_wall_ = wall;
  }

  void Profile::enter(const Phase phase)
  {
    if (watch_memory_)
      of(current_).private_bytes = std::max(of(current_).private_bytes, private_bytes());
    charge();
    current_ = phase;
  }

  Profile::Scope::Scope(Profile *const profile, const Phase phase)
      : profile_(profile)
      , before_(profile ? profile->current_ : phase)
  {
    if (!profile_)
      return;
    profile_->enter(phase);
    ++profile_->of(phase).calls;
  }

  Profile::Scope::~Scope()
  {
    if (profile_)
      profile_->enter(before_);
  }

  std::string Profile::timing_table() const
  {
    Seconds     total;
    std::string text = "  section                  calls     CPU s    wall s\n";
    for (unsigned int p = 0; p < n_phases; ++p)
    {
      const Seconds &s = seconds_[p];
      total.cpu += s.cpu;
      total.wall += s.wall;
      if (s.calls > 0)
        text += format("  %-22s %7u %9.2f %9.2f\n", names[p], s.calls, s.cpu, s.wall);
    }
    return text + format("  %-22s         %9.2f %9.2f", "whole run", total.cpu, total.wall);
  }

  Profile::Report Profile::report(const DoFIndex n_dofs, const bool converged, const MPI_Comm communicator)
  {
    enter(current_);
    Report report;
    report.ranks             = dealii::Utilities::MPI::n_mpi_processes(communicator);
    report.newton_iterations = newton_iterations;
    report.krylov_iterations = krylov_iterations;
    report.n_dofs            = n_dofs;
    report.converged         = converged;

    const auto reduce = [&](const std::string &name, const Seconds &mine)
    {
      const auto all = dealii::Utilities::MPI::min_max_avg(std::vector<double>{mine.cpu, mine.wall, mine.private_bytes},
                                                           communicator);
      return Entry{name, all[0].sum, all[0].avg, all[0].max, all[1].max, all[2].sum, mine.calls};
    };
    Seconds total;
    for (unsigned int p = 0; p < n_phases; ++p)
    {
      report.phases[p] = reduce(names[p], seconds_[p]);
      total.cpu += seconds_[p].cpu;
      total.wall += seconds_[p].wall;
    }
    for (const Seconds &phase : seconds_)
      total.private_bytes = std::max(total.private_bytes, phase.private_bytes);
    total.calls  = 1;
    report.total = reduce("total", total);
    return report;
  }

  std::string Profile::Report::table() const
  {
    std::string text;
    text += format("  %-18s %7s %10s %10s %10s %7s %10s\n",
                   "phase",
                   "calls",
                   "CPU s: sum",
                   "mean",
                   "maximum",
                   "share",
                   "private MB");
    const auto row = [&](const Entry &e)
    {
      text += format("  %-18s %7u %10.3f %10.3f %10.3f %6.2f%% ",
                     e.name.c_str(),
                     e.calls,
                     e.cpu_sum,
                     e.cpu_mean,
                     e.cpu_maximum,
                     100. * e.cpu_sum / total.cpu_sum);
      text += e.private_bytes > 0. ? format("%10.1f\n", e.private_bytes / 1e6) : format("%10s\n", "-");
    };
    for (const Entry &phase : phases)
      row(phase);
    row(total);
    const auto share = [&](const Phase phase)
    { return 100. * phases[static_cast<unsigned int>(phase)].cpu_sum / total.cpu_sum; };
    text += format("  status and contact assembly: %.2f %% of the CPU, pairing: %.2f %%\n",
                   share(Phase::status) + share(Phase::contact_assembly),
                   share(Phase::pairing));
    text += format("  %u Newton iterations, %u Krylov iterations\n", newton_iterations, krylov_iterations);
    text += format("  %llu displacement degrees of freedom on %u %s: %.3g CPU s and %.3g bytes each",
                   static_cast<unsigned long long>(n_dofs),
                   ranks,
                   ranks == 1 ? "rank" : "ranks",
                   total.cpu_sum / n_dofs,
                   total.private_bytes / n_dofs);
    return text;
  }

  void Profile::Report::write_json(std::ostream &stream) const
  {
    const auto entry = [&](const Entry &e)
    {
      stream << "{\"name\": \"" << e.name << "\", \"calls\": " << e.calls << ", \"cpu_seconds\": " << e.cpu_sum
             << ", \"cpu_seconds_mean\": " << e.cpu_mean << ", \"cpu_seconds_maximum\": " << e.cpu_maximum
             << ", \"wall_seconds\": " << e.wall << ", \"share\": " << e.cpu_sum / total.cpu_sum
             << ", \"private_bytes\": ";
      if (e.private_bytes > 0.)
        stream << e.private_bytes << '}';
      else
        stream << "null}";
    };
    stream.precision(9);
    stream << "{\n  \"converged\": " << (converged ? "true" : "false") << ",\n  \"ranks\": " << ranks
           << ",\n  \"displacement_degrees_of_freedom\": " << n_dofs
           << ",\n  \"newton_iterations\": " << newton_iterations << ",\n  \"krylov_iterations\": " << krylov_iterations
           << ",\n  \"cpu_seconds_per_degree_of_freedom\": " << total.cpu_sum / n_dofs
           << ",\n  \"bytes_per_degree_of_freedom\": " << total.private_bytes / n_dofs << ",\n  \"phases\": [";
    for (unsigned int p = 0; p < n_phases; ++p)
    {
      stream << (p == 0 ? "\n    " : ",\n    ");
      entry(phases[p]);
    }
    stream << "\n  ],\n  \"total\": ";
    entry(total);
    stream << "\n}\n";
  }
} // namespace Nodus
