#include "parallel/throw_everywhere.h"
#include <nodus/base/signals.h>
#include <nodus/base/version.h>
#include <nodus/parameters/parameters.h>
#include <nodus/run/check_laws.h>
#include <nodus/run/contact_problem.h>

#include <deal.II/base/config.h>
#include <deal.II/base/mpi.h>

#include <dmumps_c.h>
#if __has_include(<muParserDef.h>)
#  include <muParserDef.h>
#endif

#include <iostream>
#include <sstream>
#include <string>
#include <vector>

// Command line and exit codes; the case itself is Parameters::read() and ContactProblem.

namespace
{
  const char *const usage = R"(nodus: contact of 3D bodies at large deformation, with friction

  nodus case.prm [--set "Section/Key=value"]... [--validate [--surfaces FILE] | --check-law | [--restart] [--profile]]

  case.prm                   the parameter file; one that ends in .json is read as JSON
  --set "Section/Key=value"  replaces a value of the file, e.g. --set "Contact pair 1/Friction coefficient=0.3"
  --validate                 reads the case, pairs the surfaces, prints what a run would start from and stops
  --surfaces FILE.vtu        and writes the outer faces and what the case makes of them: contact sides, boundary conditions
                             (contrib/plot/surfaces draws them)
  --restart                  continues from the last complete checkpoint in the results folder, on any number of processes
  --check-law                compares the laws of the case with what follows from them, stresses with energies and
                             tangents with differences, prints the largest errors and stops; exit code 1 above 1e-6
  --profile                  prints CPU time, calls and memory by phase, and writes them to profile.json in the results folder
  --explain WORDS            prints what the keys mean that have WORDS in their path, their choices or else their meaning,
                             e.g. --explain "friction" or --explain traction
  --document                 prints the reference of all parameters (Markdown)
  --document-json            prints it for programs (JSON)
                             with case.prm beside it, all three know the plug-ins that it loads (Additional shared libraries)
  --version                  prints the versions of nodus and of its libraries
  --help                     prints this text

  SIGUSR1 makes a run write a checkpoint and go on; SIGTERM and SIGINT make it write one and end (exit code 128 + signal).
)";

  struct CommandLine
  {
    std::string              file;
    std::vector<std::string> overrides;
    bool                     validate = false, check_law = false, restart = false, profile = false;
    std::string              print;   ///< --document, --document-json, --explain, --version or --help
    std::string              explain; ///< the key
    std::string              surfaces;
  };

  CommandLine parse(const std::vector<std::string> &arguments)
  {
    CommandLine command;
    for (std::size_t i = 0; i < arguments.size(); ++i)
    {
      const std::string &argument = arguments[i];
      if (argument == "--document" || argument == "--document-json" || argument == "--version" || argument == "--help")
        command.print = argument;
      else if (argument == "--explain")
      {
        if (++i == arguments.size())
          throw Nodus::InputError("--explain needs a key or a part of one after it");
        command.print   = argument;
        command.explain = arguments[i];
      }
      else if (argument == "--validate")
        command.validate = true;
      else if (argument == "--surfaces")
      {
        if (++i == arguments.size())
          throw Nodus::InputError("--surfaces needs the name of a .vtu file after it");
        command.surfaces = arguments[i];
      }
      else if (argument == "--check-law")
        command.check_law = true;
      else if (argument == "--restart")
        command.restart = true;
      else if (argument == "--profile")
        command.profile = true;
      else if (argument == "--set")
      {
        if (++i == arguments.size())
          throw Nodus::InputError("--set needs \"Section/Key=value\" after it");
        command.overrides.push_back(arguments[i]);
      }
      else if (argument.empty() || argument[0] == '-')
        throw Nodus::InputError("unknown option '" + argument + "'; see nodus --help");
      else if (!command.file.empty())
        throw Nodus::InputError("two parameter files, '" + command.file + "' and '" + argument +
                                "'; give one (values with blanks need quotes)");
      else
        command.file = argument;
    }
    if (command.file.empty() && command.print.empty())
      throw Nodus::InputError("no parameter file; see nodus --help");
    if (!command.surfaces.empty() && !command.validate)
      throw Nodus::InputError("--surfaces writes what --validate looks at; add --validate");
    if ((command.validate || command.check_law) && (command.profile || command.restart))
      throw Nodus::InputError(std::string(command.profile ? "--profile" : "--restart") + " needs a run; leave out " +
                              (command.validate ? "--validate" : "--check-law"));
    return command;
  }

  std::string versions()
  {
    std::string text = "nodus " NODUS_VERSION "\n";
    text += "deal.II " DEAL_II_PACKAGE_VERSION "\n";
    text += "MUMPS " MUMPS_VERSION "\n";
    text += "p4est " + std::to_string(DEAL_II_P4EST_VERSION_MAJOR) + '.' + std::to_string(DEAL_II_P4EST_VERSION_MINOR) +
            '.' + std::to_string(DEAL_II_P4EST_VERSION_SUBMINOR) + '\n';
    char library[MPI_MAX_LIBRARY_VERSION_STRING];
    int  length = 0;
    MPI_Get_library_version(library, &length);
    const std::string mpi(library, length);
    text += "MPI library " + mpi.substr(0, mpi.find_first_of(",\n")) + '\n'; // the first of many particulars
#if __has_include(<muParserDef.h>)
    text += "muParser " + mu::ParserVersion + '\n';
#endif
    text += "compiler " NODUS_COMPILER ", build type " NODUS_BUILD_TYPE "\n";
    return text;
  }

  std::string answer(const CommandLine &command)
  {
    if (!command.file.empty() && command.print != "--version" && command.print != "--help")
      Nodus::Parameters::load_libraries(command.file, command.overrides);
    if (command.print == "--document")
      return Nodus::Parameters::documentation();
    if (command.print == "--document-json")
      return Nodus::Parameters::documentation_json();
    if (command.print == "--explain")
      return Nodus::Parameters::explain(command.explain);
    return command.print == "--version" ? versions() : usage;
  }

  /// Messages of libraries bring their own line breaks; ours are one line each.
  std::string one_line(const std::string &text)
  {
    std::istringstream words(text);
    std::string        line;
    for (std::string word; words >> word;)
      line += (line.empty() ? "" : " ") + word;
    return line;
  }

  /// A file or a library that one rank cannot read is read by none.
  Nodus::Parameters read(const CommandLine &command)
  {
    Nodus::Parameters parameters;
    std::string       problem;
    try
    {
      parameters = Nodus::Parameters::read(command.file, command.overrides);
    }
    catch (const Nodus::InputError &error)
    {
      problem = error.what();
    }
    Nodus::throw_everywhere<Nodus::InputError>(problem, MPI_COMM_WORLD);
    return parameters;
  }

  /// Errors after the file was read do not know its name.
  void solve(const Nodus::Parameters &parameters, const CommandLine &command)
  {
    try
    {
      Nodus::ContactProblem problem(parameters, MPI_COMM_WORLD);
      if (command.profile)
        problem.profile();
      if (command.restart)
        problem.restart();
      if (command.validate)
        problem.validate(command.surfaces);
      else
        problem.run();
    }
    catch (const Nodus::InputError &error)
    {
      throw Nodus::InputError(parameters.file + ": " + error.what());
    }
  }
} // namespace

int main(int argc, char **argv)
{
  // One thread per rank: parallelism is MPI's, and sums do not depend on scheduling.
  int                                      no_options = 1; // PETSc, where deal.II starts it, complains of ours
  dealii::Utilities::MPI::MPI_InitFinalize mpi(no_options, argv, 1);
  const bool                               first_rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  try
  {
    const CommandLine command = parse(std::vector<std::string>(argv + 1, argv + argc));
    if (!command.print.empty())
    {
      const std::string text = answer(command);
      if (first_rank)
        std::cout << text << std::flush;
    }
    else if (command.check_law)
    {
      std::ostringstream log;
      const bool         hold = Nodus::check_laws(read(command), log);
      if (first_rank)
        std::cout << log.str() << std::flush;
      return hold ? 0 : 1;
    }
    else
    {
      Nodus::Signals::install();
      solve(read(command), command);
    }
    return 0;
  }
  // These are thrown on all ranks alike, so that every rank comes to its orderly end.
  catch (const Nodus::InputError &error)
  {
    if (first_rank)
      std::cerr << "nodus: input error: " << one_line(error.what()) << std::endl;
    return 1;
  }
  catch (const Nodus::SolverFailure &error)
  {
    if (first_rank)
      std::cerr << "nodus: no solution: " << error.what() << std::endl;
    return 1;
  }
  catch (const Nodus::Interrupted &interruption)
  {
    if (first_rank)
      std::cerr << "nodus: " << interruption.what() << std::endl;
    return 128 + interruption.signal;
  }
  // Anything else may have hit this rank only while the others wait for it.
  catch (const std::exception &error)
  {
    std::cerr << "nodus: error: " << error.what() << std::endl;
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  catch (...)
  {
    std::cerr << "nodus: error of an unknown kind" << std::endl;
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  return 1;
}
