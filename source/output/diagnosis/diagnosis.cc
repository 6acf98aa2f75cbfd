#include "output/diagnosis/diagnosis.h"
#include "base/complete_file.h"
#include "base/text.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

// The page is Markdown. It stays one: every list ends after a few rows.

namespace Nodus
{
  namespace
  {
    constexpr unsigned int n_status_tests = 8; ///< whose statuses are kept
    constexpr unsigned int n_iterations = 10, n_passes = 6, n_attempts = 6, n_changes = 4;

    std::string row(const std::vector<std::string> &cells)
    {
      std::string line = "|";
      for (std::string cell : cells)
      {
        for (std::size_t bar = cell.find('|'); bar != std::string::npos; bar = cell.find('|', bar + 2))
          cell.insert(bar, "\\");
        line += ' ' + cell + " |";
      }
      return line + '\n';
    }

    std::string header(const std::vector<std::string> &cells)
    {
      return row(cells) + row(std::vector<std::string>(cells.size(), "---"));
    }

    std::string position(const Point &p)
    {
      return text('(', p, ')');
    }

    std::string name_of(const ContactStatus status)
    {
      return status == ContactStatus::open ? "open" : status == ContactStatus::slip ? "slip" : "stick";
    }

    std::string name_of(const Contradiction contradiction)
    {
      switch (contradiction)
      {
        case Contradiction::tension:
          return "tension while closed";
        case Contradiction::penetration:
          return "penetration while open";
        case Contradiction::over_cone:
          return "friction beyond the threshold while stick";
        case Contradiction::against_slip:
          return "slip against the friction";
        case Contradiction::none:
          break;
      }
      return "-";
    }

    /// The iteration from which on the largest one of the residuals has not fallen any more.
    const Tables::Iteration &best(const std::vector<Tables::Iteration> &iterations)
    {
      const auto residual = [](const Tables::Iteration &i) {
        return std::max({i.norms.force, i.norms.contact, i.norms.prescribed});
      };
      return *std::min_element(iterations.begin(),
                               iterations.end(),
                               [&](const auto &a, const auto &b) { return residual(a) < residual(b); });
    }

    std::string text_of(const std::vector<char> &statuses)
    {
      std::string list;
      for (const char s : statuses)
        list += (list.empty() ? "" : " ") + name_of(static_cast<ContactStatus>(s));
      return list;
    }

    std::string place(const Tables::Iteration &i)
    {
      return text("geometry pass ",
                  i.pass.geometry,
                  ", threshold pass ",
                  i.pass.threshold,
                  ", status pass ",
                  i.pass.status,
                  ", iteration ",
                  i.iteration);
    }

    /// The same to be pasted: options of the command line, and what is to be appended to the case.
    void write_changes(std::ostream &out, const std::vector<SuspectedCause::Change> &changes)
    {
      std::string options, blocks;
      for (const auto &change : changes)
      {
        const auto slash = change.key.rfind('/');
        blocks += change.block;
        if (!change.block.empty() || slash == std::string::npos)
          continue;
        options += "--set \"" + change.key + '=' + change.proposed + '"';
        for (const auto &[key, value] : change.together)
          options += " --set \"" + change.key.substr(0, slash + 1) + key + '=' + value + '"';
        options += '\n';
      }
      if (!blocks.empty())
        out << "\nTo append to the case:\n\n```\n" << blocks << "```\n";
      if (!options.empty())
        out << "\nOptions for the command line, one line at a time; what is before `/` is the subsection and what is "
               "behind it the `set` line of the case:\n\n```\n"
            << options << "```\n";
      out << '\n';
    }

    void write_causes(std::ostream &out, const std::vector<SuspectedCause> &causes)
    {
      out << "## Suspected cause\n\n";
      for (unsigned int n = 0; n < causes.size(); ++n)
      {
        out << n + 1 << ". **" << causes[n].name << "**\n";
        for (const std::string &evidence : causes[n].evidence)
          out << "   - " << evidence << '\n';
      }
      std::vector<SuspectedCause::Change> told;
      for (const SuspectedCause &cause : causes)
      {
        unsigned int n = 0;
        for (const auto &change : cause.changes)
          if (n < n_changes &&
              std::none_of(told.begin(), told.end(), [&](const auto &other) { return other.key == change.key; }))
          {
            told.push_back(change);
            ++n;
          }
      }
      out << "\n## What to change\n\nThe most promising first, one at a time.\n\n"
          << header({"key", "now", "try", "why"});
      for (const auto &change : told)
        out << row({'`' + change.key + '`', change.now, change.proposed, change.reason});
      write_changes(out, told);
    }

    void write_loops(std::ostream &out, const Diagnosis::History &history)
    {
      out << "## Which loop, since when\n\n";
      if (history.attempts.size() > 1)
      {
        const std::size_t n = history.attempts.size();
        out << "Attempts at increment " << history.increment << ", all from t = " << history.begin << ":\n\n"
            << header({"to t", "loops merged into Newton", "ended by"});
        const std::size_t first = n > n_attempts ? n - n_attempts : 0;
        for (std::size_t i = first; i < n; ++i)
          out << row({text(history.attempts[i].end),
                      history.attempts[i].merged.empty() ? "none" : history.attempts[i].merged,
                      i > first && history.attempts[i].reason == history.attempts[i - 1].reason
                          ? "the same"
                          : history.attempts[i].reason});
        out << '\n';
      }
      if (!history.iterations.empty())
      {
        const auto &all = history.iterations;
        out << "The last attempt came to " << place(all.back()) << "; its residuals were smallest at "
            << place(best(all)) << ". The last iterations:\n\n"
            << header({"geometry", "threshold", "status", "iteration", "force", "contact", "prescribed", "changed"});
        for (std::size_t i = all.size() > n_iterations ? all.size() - n_iterations : 0; i < all.size(); ++i)
          out << row({text(all[i].pass.geometry),
                      text(all[i].pass.threshold),
                      text(all[i].pass.status),
                      text(all[i].iteration),
                      text(all[i].norms.force),
                      text(all[i].norms.contact),
                      text(all[i].norms.prescribed),
                      text(all[i].norms.changes)});
        out << '\n';
      }
      for (const std::string loop : {"status", "threshold", "geometry"})
      {
        std::vector<Diagnosis::Pass> passes;
        for (const auto &pass : history.passes)
          if (pass.loop == loop)
            passes.push_back(pass);
        // a loop that ended after its first pass each time has nothing to tell
        if (std::all_of(passes.begin(), passes.end(), [](const auto &pass) { return pass.value <= pass.tolerance; }))
          continue;
        out << "The last passes of the " << loop << " loop (it ends at " << passes.back().tolerance << "):\n\n"
            << header({"pass", loop == "status" ? "statuses changed" : "criterion", "worst"});
        for (std::size_t i = passes.size() > n_passes ? passes.size() - n_passes : 0; i < passes.size(); ++i)
          out << row({text(passes[i].number), text(passes[i].value), passes[i].worst});
        out << '\n';
      }
    }

    void write_nodes(std::ostream &out, const Parameters &parameters, const FailureEvidence &evidence)
    {
      // those of a loop that failed between two solutions are in balance
      if (!evidence.worst_nodes.empty() &&
          evidence.worst_nodes.front().force.norm() > parameters.newton.force_tolerance * evidence.force_scale)
      {
        out << "## Nodes that are most out of balance\n\nOf the last iterate whose forces exist, relative to the "
               "largest nodal force, "
            << evidence.force_scale << "; statuses of slave nodes after the last tests, the oldest first.\n\n"
            << header(
                   {"body", "contact pair", "reference position", "current position", "force", "relative", "statuses"});
        for (const auto &node : evidence.worst_nodes)
        {
          const std::string &name = parameters.bodies[node.body].name;
          out << row({text(node.body + 1, name.empty() ? "" : " (" + name + ')'),
                      node.pair < parameters.contact_pairs.size()
                          ? text(node.pair + 1, " (", parameters.contact_pairs[node.pair].name, ')')
                          : "-",
                      position(node.X),
                      position(node.x),
                      text('(', node.force, ')'),
                      text(evidence.force_scale > 0. ? node.force.norm() / evidence.force_scale : 0.),
                      text_of(node.statuses)});
        }
        out << '\n';
      }
      if (evidence.changing_sites.empty())
        return;
      out << "## Statuses that changed most\n\n"
          << evidence.n_changed_sites << " sites changed in the last attempt. Statuses after the last "
          << evidence.changing_sites.front().statuses.size() << " tests, the oldest first:\n\n"
          << header({"contact pair",
                     "reference position",
                     "current position",
                     "statuses",
                     "changes",
                     "cycle",
                     "last contradiction"});
      for (const auto &site : evidence.changing_sites)
      {
        out << row(
            {text(site.pair + 1, " (", parameters.contact_pairs[site.pair].name, site.is_point ? "), point" : ")"),
             position(site.X),
             position(site.x),
             text_of(site.statuses),
             text(site.ledger.changes),
             site.ledger.period > 0 ? text("period ", site.ledger.period) : "-",
             name_of(site.ledger.last)});
      }
      out << '\n';
    }
  } // namespace

  Diagnosis::Diagnosis(const Parameters &parameters, MPI_Comm communicator)
      : parameters_(parameters)
      , communicator_(communicator)
  {
  }

  void Diagnosis::begin_run() const
  {
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) != 0)
      return;
    std::error_code ignored;
    for (const auto &entry : std::filesystem::directory_iterator(parameters_.output.results_folder, ignored))
      if (const std::string name = entry.path().filename().string();
          name == "diagnosis.md" || name.compare(0, 12, "failed_state") == 0)
        std::filesystem::remove(entry.path(), ignored);
  }

  void Diagnosis::begin_increment(const unsigned int increment, const double begin, const double end)
  {
    if (increment != history_.increment)
      history_.attempts.clear();
    history_.increment = increment;
    history_.begin     = begin;
    history_.end       = end;
  }

  void Diagnosis::begin_attempt(const std::string &merged)
  {
    // an attempt with the coupled threshold after one whose threshold loop failed
    const bool coupled = merged.find("threshold") != std::string::npos && !history_.passes.empty() &&
                         history_.passes.back().loop == "threshold" && history_.attempts.back().end == history_.end;
    history_.threshold_passes = coupled ? history_.passes : std::vector<Pass>();
    history_.attempts.push_back({history_.begin, history_.end, merged, ""});
    history_.iterations.clear();
    history_.passes.clear();
    statuses_.clear();
  }

  void Diagnosis::end_attempt(const std::string &reason)
  {
    history_.attempts.back().reason = reason;
  }

  void Diagnosis::add(const Tables::Iteration &iteration)
  {
    history_.iterations.push_back(iteration);
  }

  void Diagnosis::add(const Pass &pass)
  {
    history_.passes.push_back(pass);
  }

  void Diagnosis::add_statuses(const std::vector<char> &statuses)
  {
    if (statuses_.size() == n_status_tests)
      statuses_.pop_front();
    statuses_.push_back(statuses);
  }

  std::vector<char> Diagnosis::statuses(const unsigned int site) const
  {
    std::vector<char> of_site;
    for (const auto &statuses : statuses_)
      of_site.push_back(statuses[site]);
    return of_site;
  }

  std::string Diagnosis::summary(const FailureEvidence &evidence) const
  {
    const std::vector<SuspectedCause> causes = suspected_causes(parameters_, history_, evidence);
    std::string                       text   = causes.front().name;
    for (const SuspectedCause &cause : causes)
      if (!cause.changes.empty())
      {
        const SuspectedCause::Change &change = cause.changes.front();
        return text + "; try '" + change.key + " = " + change.proposed + "': " + change.reason;
      }
    return text;
  }

  std::string Diagnosis::write(const FailureEvidence &evidence) const
  {
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) != 0)
      return "";
    CompleteFile  file(parameters_.output.results_folder, "diagnosis.md");
    std::ostream &out = file.stream();
    out.precision(6);
    out << "# Why the run stopped\n\n"
        << (parameters_.title.empty() ? "" : parameters_.title + ". ") << "Increment " << history_.increment
        << ", from t = " << history_.begin << " to t = " << history_.end
        << (!evidence.may_shrink                 ? ", not cut back, since smaller increments do not change that: "
            : parameters_.load_stepping.cut_back ? ", cut back as far as it may be: "
                                                 : ", not to be cut back: ")
        << evidence.message << ".\n\nThe last converged state is t = " << evidence.converged << '.'
        << (evidence.state.empty()
                ? ""
                : " `" + evidence.state + "` holds the state that is described here, which is not in equilibrium.")
        << "\n\n";
    write_causes(out, suspected_causes(parameters_, history_, evidence));
    write_loops(out, history_);
    write_nodes(out, parameters_, evidence);
    return file.finish();
  }
} // namespace Nodus
