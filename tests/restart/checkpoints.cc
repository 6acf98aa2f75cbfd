// Which checkpoint a restart takes: the last complete one, of the same model and format, and how many are kept.

#include "../messages.h"
#include "sliding_block.h"

#include <nodus/base/signals.h>

#include <deal.II/base/mpi.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sys/resource.h>

using namespace SlidingBlock;
namespace fs = std::filesystem;

namespace
{
  const fs::path folder = "checkpoints_results", checkpoints = folder / "checkpoints";

  /// Message of the error, or the time of the first increment.
  std::string restart(const Parameters &p)
  {
    ContactProblem problem(p, world(), log());
    std::string    first = "none";
    problem.on_increment(
        [&](const unsigned int increment, double)
        {
          if (first == "none")
            first = "increment " + std::to_string(increment);
        });
    problem.restart();
    try
    {
      problem.run();
    }
    catch (const InputError &error)
    {
      return error.what();
    }
    return first;
  }

  std::vector<std::string> present()
  {
    std::vector<std::string> names;
    for (const auto &entry : fs::directory_iterator(checkpoints))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  void put(const fs::path &from, const fs::path &to)
  {
    fs::remove_all(to);
    fs::copy(from, to, fs::copy_options::recursive);
  }

  void set_first_line(const fs::path &file, const std::string &line)
  {
    std::ifstream     in(file);
    std::string       old;
    std::stringstream rest;
    std::getline(in, old);
    rest << in.rdbuf();
    std::ofstream(file) << line << '\n' << rest.str();
  }

  void repeat_second_line(const fs::path &file)
  {
    std::ifstream in(file);
    std::string   first, second;
    std::getline(in, first);
    std::getline(in, second);
    in.close();
    set_first_line(file, first + '\n' + second);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Signals::install();
  fs::remove_all(folder);

  Parameters p                 = SlidingBlock::parameters(folder);
  p.output.write_vtu           = false;
  p.output.checkpoint_interval = 3;
  check_words("without a checkpoint it begins at the start", restart(p), {"increment 1"});
  check("every third increment, two are kept", present() == std::vector<std::string>({"000003", "000006"}));

  ContactProblem interrupted(p, world(), log());
  interrupted.on_increment([](const unsigned int increment, double) { increment == 4 ? std::raise(SIGUSR1) : 0; });
  interrupted.run();
  check("one more on SIGUSR1, and the run goes on", present() == std::vector<std::string>({"000004", "000006"}));

  const fs::path kept = folder / "kept";
  put(checkpoints, kept);
  check_words("the last one is taken", restart(p), {"increment 7"});

  {
    // No file may become larger than half a piece: as on a full disk.
    rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit small{fs::file_size(kept / "000006" / "piece.0000") / 2, limit.rlim_max};
    put(kept, checkpoints);
    fs::remove_all(checkpoints / "000006");
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string message = restart(p);
    setrlimit(RLIMIT_FSIZE, &limit);
    check_words("a full disk is told", message, {"cannot write", "is the disk full?"});
    check("  and the checkpoint before is still there, alone", present() == std::vector<std::string>({"000004"}));
  }

  {
    // The same from the first file on, and from that of the first increment on, which is larger than the initial state.
    auto fields                  = p;
    fields.output.write_vtu      = true;
    fields.output.results_folder = folder / "full";
    const auto size              = [&](const std::string &name) { return fs::file_size(folder / "full" / name); };
    const auto run_full          = [&](const std::uintmax_t largest)
    {
      fs::remove_all(folder / "full");
      rlimit limit;
      getrlimit(RLIMIT_FSIZE, &limit);
      const rlimit small{largest, limit.rlim_max};
      setrlimit(RLIMIT_FSIZE, &small);
      const std::string message = restart(fields);
      setrlimit(RLIMIT_FSIZE, &limit);
      return message;
    };
    const auto left = [&]
    {
      std::vector<std::string> names;
      for (const auto &entry : fs::directory_iterator(folder / "full"))
        names.push_back(entry.path().filename());
      std::sort(names.begin(), names.end());
      return names;
    };
    restart(fields);
    const auto between = (size("bodies_0000.vtu") + size("bodies_0001.vtu")) / 2;
    check_words("a disk that is full before", run_full(2000), {"cannot write", "bodies_0000.vtu", "is the disk full?"});
    check("  leaves no incomplete file", left().empty());
    check_words("one that fills later", run_full(between), {"cannot write", "bodies_0001.vtu", "is the disk full?"});
    check("  leaves complete files",
          left() == std::vector<std::string>({"bodies.pvd",
                                              "bodies_0000.vtu",
                                              "contact.csv",
                                              "contact.pvd",
                                              "contact_0000.vtu",
                                              "convergence.csv",
                                              "energy.csv",
                                              "reactions.csv",
                                              "status.json"}));
  }

  put(kept, checkpoints);
  const fs::path piece = checkpoints / "000006" / "piece.0000";
  fs::resize_file(piece, fs::file_size(piece) - 10);
  check_words("a truncated one is passed over", restart(p), {"increment 5"});

  put(kept, checkpoints);
  {
    std::fstream file(checkpoints / "000006" / "common", std::ios::in | std::ios::out);
    const int    byte = file.seekg(20).get();
    file.seekp(20).put(static_cast<char>(~byte));
  }
  check_words("a changed one is passed over", restart(p), {"increment 5"});

  put(kept, checkpoints);
  fs::remove(piece);
  fs::create_directory(piece);
  check_words("one with a folder for a file is passed over", restart(p), {"increment 5"});

  put(kept, checkpoints);
  std::ofstream(checkpoints / "000006" / "index", std::ios::app) << '\n';
  std::ofstream(checkpoints / "000006" / "piece.0001") << "garbage\n";
  check_words("what its index does not name does not count", restart(p), {"increment 7"});

  put(kept, checkpoints);
  set_first_line(checkpoints / "000006" / "index", "nodus checkpoint 21\n");
  check_words("an index with an empty line is passed over", restart(p), {"increment 5"});

  put(kept, checkpoints);
  repeat_second_line(checkpoints / "000006" / "index");
  check_words("an index with a file twice is passed over", restart(p), {"increment 5"});

  put(kept, checkpoints);
  fs::rename(checkpoints / "000006", checkpoints / "000006.incomplete");
  check_words("an unfinished one does not count", restart(p), {"increment 5"});

  put(kept, checkpoints);
  for (const std::string name : {"000004", "000006"})
    fs::resize_file(checkpoints / name / "index", 30);
  check_words("nothing but damaged ones: refused", restart(p), {"no checkpoint can be used", "000004", "000006"});

  put(kept, checkpoints);
  set_first_line(checkpoints / "000006" / "index", "nodus checkpoint 999");
  check_words("another format: refused", restart(p), {"another version of nodus", "999"});

  put(kept, checkpoints);
  auto friction                                  = p;
  friction.contact_pairs[0].friction_coefficient = 0.35;
  check_words("another friction coefficient: refused",
              restart(friction),
              {"another model", "'Contact pair 1/Friction coefficient' was '0.3", "is '0.35"});
  auto mesh                          = p;
  mesh.bodies[0].generator_arguments = "4,3,1 : 0,0,0 : 2,1,0.5 : true";
  check_words("another mesh: refused", restart(mesh), {"'Body 1/Generator arguments' was"});
  auto load                            = p;
  load.boundary_conditions[1].value[1] = "0.03*t";
  check_words("another load: refused", restart(load), {"'Boundary condition 2/Value' was"});
  auto pairs = p;
  pairs.contact_pairs.clear();
  check_words("no pair any more: refused", restart(pairs), {"Contact pair 1", "does not exist any more"});

  auto allowed                        = p;
  allowed.load_stepping.interval_ends = {0.5, 1., 1.2};
  allowed.load_stepping.increments    = {3, 10, 2};
  allowed.newton.maximum_iterations   = 20;
  allowed.output.checkpoint_interval  = 0;
  check_words("other increments, a longer path, other limits: accepted", restart(allowed), {"increment 7"});
}
