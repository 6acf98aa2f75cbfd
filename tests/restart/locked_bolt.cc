// A run that is continued in the step in which a bolt is locked is the run that never stopped. What the bolt is
// tightened to is part of the state: the time until which it is tightened may change as long as it lies ahead.

#include "../bolted_joint.h"
#include "interrupted.h"

#include <csignal>

using namespace BoltedJoint;

namespace
{
  std::vector<PreloadSection> run(const Parameters &p, const bool restart, const unsigned int last = 0)
  {
    ContactProblem              problem(p, world(), log());
    std::vector<PreloadSection> sections;
    problem.on_increment(
        [&](const unsigned int increment, double)
        {
          sections.push_back(problem.preload_sections()[0]);
          if (increment == last)
            std::raise(SIGTERM);
        });
    run_until_interrupted(problem, restart);
    return sections;
  }

  std::string contents(const std::string &file)
  {
    std::ifstream      stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
} // namespace

int main(int argc, char *argv[])
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Signals::install();
  Parameters p = joint("", "15*max(t-1,0)");
  for (unsigned int b = 0; b < 3; ++b)
    p.bodies[b].material.law = MaterialParameters::Law::neo_hookean;

  const auto whole = run(in_new_folder(p, "locked_bolt_whole"), false);
  auto       q     = in_new_folder(p, "locked_bolt_parts");
  run(q, false, 4);
  const auto rest = run(q, true);
  check_equal("increments after the fourth", rest.size(), 2);
  check("force at the end", rest.back().force, whole.back().force, 1e-10);
  check("shortened by", rest.back().shortening, whole.back().shortening, 1e-12);
  check("locked", rest.back().locked);
  MPI_Barrier(world());
  for (const std::string file : {"preload.csv", "energy.csv", "rigid_bodies.csv"})
    check(file + ": the same text",
          !contents("locked_bolt_whole/" + file).empty() &&
              contents("locked_bolt_whole/" + file) == contents("locked_bolt_parts/" + file));

  // at the end of the first step it is said that the bolt is tightened on
  q = in_new_folder(p, "locked_bolt_parts");
  run(q, false, 2);
  q.contact_pairs[0].preload.until = 0.;
  const auto longer                = run(q, true);
  check("tightened on: force", longer.back().force, force, 1e-8);
  check("not locked", !longer.back().locked);
  // but not once it has been locked
  q = in_new_folder(p, "locked_bolt_parts");
  run(q, false, 4);
  q.contact_pairs[0].preload.until = 0.;
  std::string message;
  try
  {
    run(q, true);
  }
  catch (const InputError &error)
  {
    message = error.what();
  }
  check("what lies behind may not change", message.find("Preload until") != std::string::npos);
  return 0;
}
