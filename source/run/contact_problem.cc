#include "base/complete_file.h"
#include "output/results_folder.h"
#include "output/surface_map.h"
#include "parallel/throw_everywhere.h"
#include "rigid/rigid_surface.h"
#include "run/load_path.h"
#include "run/validation.h"
#include "solve/displacement_preconditioner.h"
#include <nodus/base/signals.h>
#include <nodus/run/contact_problem.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <optional>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Less than this part of the energies that is out of balance is not spoken of.
    constexpr double large_imbalance = 0.05;
  } // namespace

  /// What a run owns, in the order of its building.
  struct ContactProblem::Implementation
  {
    Implementation(const Parameters &p, MPI_Comm communicator, std::ostream &log)
        : parameters(Model::with_room(p))
        , journal(parameters, communicator, log)
        , model(parameters, communicator, states)
        , path(parameters.load_stepping)
        , equilibrium(model, journal, states)
        , loops(model, journal, states, equilibrium, [this] { checkpointing.heed_signals(path); })
        , strategy(model, journal, states, equilibrium, loops)
        , results(model, journal, states, equilibrium)
        , adaptation(model, journal, states, equilibrium, results)
        , checkpointing(model, journal, states, equilibrium, results)
    {
      journal.profile.set_ground(Phase::other);
    }

    void        run();
    void        begin(std::optional<ResultsFolder> &folder);
    void        validate(const std::string &surfaces);
    void        report_remedies();
    void        report_verdicts();
    void        report_energies();
    std::string report_profile(bool converged);

    Parameters     parameters;
    Journal        journal;
    States         states;
    Model          model;
    LoadStepping   path;
    Equilibrium    equilibrium;
    IncrementLoops loops;
    Strategy       strategy;
    Results        results;
    MeshAdaptation adaptation;
    Checkpointing  checkpointing;

    bool                                      restart          = false; ///< asked for: continue from a checkpoint
    bool                                      detailed_profile = false; ///< asked for: with memory, and profile.json
    std::function<void(unsigned int, double)> callback;
  };

  /// Everything up to the first increment; the run holds its @p folder from then on.
  void ContactProblem::Implementation::begin(std::optional<ResultsFolder> &folder)
  {
    {
      const auto timer = journal.profile.time(Phase::set_up);
      if (detailed_profile)
        journal.profile.watch_memory();
      for (const std::string &line : model.summary())
        journal.console.line(line);
      if (restart && !checkpointing.exists())
      {
        journal.console.line("There is no checkpoint in " + parameters.output.results_folder +
                             ": the run begins at t = 0");
        restart = false;
      }
      if (!restart)
        adaptation.refine_near_contact();
      equilibrium.begin_on_mesh();
      if (!restart) // what is wrong at once is refused before there is any file
      {
        model.look_ahead(path.planned_times());
        model.set_conditions(path.at_hand().end);
        const auto pairing_timer = journal.profile.time(Phase::pairing);
        for (const std::string &sentence : model.begin_contact(states, 0.))
          journal.console.line("warning: " + sentence);
      }
      results.find_points();
      folder.emplace(parameters.output.results_folder, model.communicator);
      if (!restart)
      {
        checkpointing.set_aside();
        if (const unsigned int n = folder->remove_results(); n > 0)
          journal.console.line("Files of an earlier run are removed: " + std::to_string(n));
      }
      results.begin_on_mesh();
      journal.tables =
          std::make_unique<Tables>(parameters.output.results_folder, model.communicator, model.bodies.names());
      journal.diagnosis.begin_run();
    }
    if (restart)
      checkpointing.read(path);
    else
      results.write_initial_state();
    if (dealii::Utilities::MPI::this_mpi_process(model.communicator) == 0)
      journal.status = std::make_unique<StatusFile>(parameters.output.results_folder,
                                                    parameters.load_stepping.interval_ends.back(),
                                                    path.progress(),
                                                    dealii::Utilities::MPI::n_mpi_processes(model.communicator));
  }

  void ContactProblem::Implementation::run()
  {
    std::optional<ResultsFolder> folder;
    begin(folder);
    const auto end_with = [&](const std::string &state, const std::string &message)
    {
      if (journal.status)
        journal.status->end(state, message);
    };
    const auto report_anyway = [&](const std::string &state, const std::string &message)
    {
      end_with(state, message);
      report_remedies();
      if (const std::string problem = report_profile(false); !problem.empty())
        journal.console.line(problem); // why the run ends is what the caller must hear of
    };
    try
    {
      LoadPath({model, journal, states, equilibrium, strategy, results, adaptation, checkpointing, path})
          .follow(
              [&](const unsigned int increment, const double t)
              {
                if (journal.status)
                  journal.status->add(increment, t, path.progress(), journal.counts);
                if (callback)
                  callback(increment, t);
              });
    }
    catch (const SolverFailure &failure)
    {
      report_anyway("stopped", failure.what());
      throw;
    }
    catch (const Interrupted &interruption)
    {
      report_anyway("interrupted", interruption.what());
      throw;
    }
    catch (const std::exception &error)
    {
      end_with("stopped", error.what());
      throw;
    }
    end_with("finished", "");
    report_remedies();
    report_verdicts();
    report_energies();
    throw_everywhere<InputError>(report_profile(true), model.communicator);
    journal.console.line("Results: " + parameters.output.results_folder);
  }

  /// Prints what was tried where something failed, and how often.
  void ContactProblem::Implementation::report_remedies()
  {
    std::string text;
    auto        name = remedy_names.begin();
    for (const unsigned int n : journal.used)
    {
      if (n > 0)
        text += (text.empty() ? "" : ", ") + std::string(*name) + ' ' + std::to_string(n);
      ++name;
    }
    if (!text.empty())
      journal.console.line("\nTried where something failed, times: " + text);
  }

  /// Prints what came closest to its tolerance where states were measured anew.
  void ContactProblem::Implementation::report_verdicts()
  {
    if (journal.judged > 0)
      journal.console.line("\nJudged anew: " + std::to_string(journal.judged) +
                           (journal.judged == 1 ? " state holds" : " states hold") +
                           "; closest to its tolerance came " + journal.verdicts.text(journal.verdicts.worst()));
  }

  /// Prints how much of the energies finite increments leave out of the balance, where that is much.
  void ContactProblem::Implementation::report_energies()
  {
    const Energies &energies = states.committed.energies;
    const double    part     = std::abs(energies.imbalance()) / energies.throughput();
    if (!(part > large_imbalance) || std::abs(energies.imbalance()) <= energies.unresolved) // nor where there are none
      return;
    std::ostringstream text;
    text.precision(2);
    text
        << "\nEnergies: " << 100. * part
        << " % of them are what finite increments leave out of the balance (energy.csv): contact, slip or yielding set "
           "in within an increment, where work with the mean force is not exact. The states at the ends of increments "
           "do not depend on it; increments of half the size leave a half to a quarter of it";
    journal.console.line(text.str());
  }

  /// Prints the times so far, and more where it was asked for. @returns what went wrong with profile.json, on rank 0.
  std::string ContactProblem::Implementation::report_profile(const bool converged)
  {
    journal.console.line("");
    if (!detailed_profile)
    {
      journal.console.line(journal.profile.timing_table());
      return "";
    }
    const Profile::Report report = journal.profile.report(model.dof_handler.n_dofs(), converged, model.communicator);
    journal.console.line(report.table());
    if (dealii::Utilities::MPI::this_mpi_process(model.communicator) != 0)
      return "";
    CompleteFile file(parameters.output.results_folder, "profile.json");
    report.write_json(file.stream());
    return file.finish();
  }

  void ContactProblem::Implementation::validate(const std::string &surfaces)
  {
    for (const std::string &line : model.summary())
      journal.console.line(line);
    results.find_points();
    model.look_ahead(path.planned_times());
    if (!surfaces.empty()) // first: who is told that bodies overlap wants to see them
    {
      const RigidMasters rigid = [&](const unsigned int pair, const Point &x)
      {
        const RigidPoint closest = model.contact->surfaces().rigid_master(pair)->closest(x);
        return closest.found ? std::optional<Point>(closest.x) : std::nullopt;
      };
      write_surfaces(surfaces, parameters, model.bodies, model.dof_handler, *model.mapping, rigid);
      journal.console.line("  surfaces: " + surfaces);
    }
    Nodus::validate(model, states, path.at_hand(), journal.console);
  }

  ContactProblem::ContactProblem(const Parameters &parameters, MPI_Comm communicator, std::ostream &log)
  {
    require_preconditioner(parameters.linear_solver.preconditioner, communicator); // before meshes are read
    implementation_ = std::make_unique<Implementation>(parameters, communicator, log);
  }

  ContactProblem::~ContactProblem() = default;

  void ContactProblem::run()
  {
    implementation_->run();
  }

  void ContactProblem::profile()
  {
    implementation_->detailed_profile = true;
  }

  void ContactProblem::restart()
  {
    implementation_->restart = true;
  }

  void ContactProblem::validate(const std::string &surfaces)
  {
    implementation_->validate(surfaces);
  }

  const std::vector<ContactFields> &ContactProblem::contact_fields() const
  {
    return implementation_->results.whole_fields();
  }

  const std::vector<ContactResultants> &ContactProblem::contact_resultants() const
  {
    return implementation_->results.resultants();
  }

  const std::vector<std::pair<std::string, Vector3>> &ContactProblem::reactions() const
  {
    return implementation_->results.reactions();
  }

  const std::vector<RigidBodyMotion> &ContactProblem::rigid_bodies() const
  {
    return implementation_->results.rigid_motions();
  }

  const std::vector<PreloadSection> &ContactProblem::preload_sections() const
  {
    return implementation_->results.preloads();
  }

  const IterationCounts &ContactProblem::iterations() const
  {
    return implementation_->journal.counts;
  }

  void ContactProblem::on_increment(const std::function<void(unsigned int, double)> &callback)
  {
    implementation_->callback = callback;
  }

  Vector3 ContactProblem::displacement(const unsigned int body, const Point &X) const
  {
    return implementation_->results.displacement(body, X);
  }
} // namespace Nodus
