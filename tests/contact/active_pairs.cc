// Contact pairs that act for a time: two unit cubes on top of each other, E = 200, nu = 0, whose outer sides are moved
// towards each other by 0.1. Pressed together they carry E/2 0.1 = 10 and store 0.5; a pair that ceases to act sheds
// that linearly, one that begins to act finds them overlapping by 0.1 or with a gap, as at the start of a run.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <map>

using namespace Cases;

namespace
{
  using Overclosure = ContactPairParameters::InitialOverclosure;
  using Scheme      = ContactPairParameters::Scheme;

  constexpr double E = 200.;

  Parameters cubes(const std::string &motion)
  {
    Parameters p;
    p.bodies = {box("lower", "2,2,2", {0, 0, 0}, {1, 1, 1}, E, 0.), box("upper", "2,2,2", {0, 0, 1}, {1, 1, 2}, E, 0.)};
    p.boundary_conditions     = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                                 hold("sides", region(2, {z_plus}), {0, 1}),
                                 drive("top", region(2, {z_plus}), 2, motion)};
    p.contact_pairs           = {ContactPairParameters()};
    p.contact_pairs[0].slave  = region(2, {z_minus});
    p.contact_pairs[0].master = region(1, {z_plus});
    p.load_stepping           = {{1., 2., 3.}, {2, 4, 1}};
    p.output.write_vtu        = false;
    return p;
  }

  /// At a time: force on the upper cube from below through its top, contact force on it, displacements of both
  /// surfaces.
  struct Expected
  {
    double held, contact, lower, upper;
  };

  Parameters in_folder(Parameters p, const std::string &name)
  {
    p.output.results_folder = "active_pairs_" + name;
    return p;
  }

  /// @p restart: from the checkpoint in the folder.
  void run(const Parameters                 &parameters,
           const std::string                &name,
           const std::map<double, Expected> &expected,
           const bool                        restart = false)
  {
    ContactProblem problem(in_folder(parameters, name), world(), log());
    unsigned int   met = 0;
    if (restart)
      problem.restart();
    problem.on_increment(
        [&](unsigned int, const double t)
        {
          const auto at = expected.find(t);
          if (at == expected.end())
            return;
          ++met;
          const auto        &pair = problem.contact_resultants()[0];
          std::ostringstream what;
          what << name << ", t = " << t;
          check(what.str() + ": reaction of the top", problem.reactions()[2].second[2], at->second.held, 1e-7, 10.);
          check("  contact force", pair.slave_force[2], at->second.contact, 1e-7, 10.);
          check("  closed where it acts", (pair.slip + pair.stick > 0) == parameters.contact_pairs[0].acts(t));
          check("  lower surface", problem.displacement(1, {0, 0, 1})[2], at->second.lower, 1e-8, 0.1);
          check("  upper surface", problem.displacement(2, {0, 0, 1})[2], at->second.upper, 1e-8, 0.1);
        });
    problem.run();
    check_equal("  times that were met", met, expected.size());
  }

  /// To t = 1, with a checkpoint there, and from there.
  void run_in_two(Parameters p, const std::string &name, const std::map<double, Expected> &expected)
  {
    Parameters first                 = in_folder(p, name);
    first.load_stepping              = {{1.}, {2}};
    first.output.checkpoint_interval = 2;
    ContactProblem(first, world(), log()).run();
    MPI_Barrier(world());
    run(p, name, expected, true);
  }

  void refuse(const Parameters &parameters, const std::string &name)
  {
    try
    {
      ContactProblem(in_folder(parameters, name), world(), log()).run();
      report(name, "NO");
    }
    catch (const InputError &error)
    {
      const std::string words = error.what();
      report(name, words.substr(0, words.find(" node"))); // several are as deep
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  for (const auto &[scheme, name] :
       {std::make_pair(Scheme::nodal, "nodal"), {Scheme::integration_point, "points"}, {Scheme::averaged, "averaged"}})
  {
    Parameters p                    = cubes("-0.1*min(t,1)");
    p.contact_pairs[0].scheme       = scheme;
    p.contact_pairs[0].active_until = 1.;
    run(p,
        std::string("ends, ") + name,
        {{0.5, {-5, 5, -0.025, -0.025}},
         {1., {-10, 10, -0.05, -0.05}},
         {1.25, {-7.5, 0, -0.0375, -0.0625}},
         {1.75, {-2.5, 0, -0.0125, -0.0875}},
         {2., {0, 0, 0, -0.1}},
         {3., {0, 0, 0, -0.1}}});
  }

  Parameters p                    = cubes("-0.1*min(t,1)");
  p.contact_pairs[0].active_until = 1.;
  run_in_two(p, "ends, restarted", {{1.25, {-7.5, 0, -0.0375, -0.0625}}, {2., {0, 0, 0, -0.1}}, {3., {0, 0, 0, -0.1}}});

  p                              = cubes("-0.1*min(t,1)");
  p.contact_pairs[0].active_from = 1.;
  run(p,
      "begins",
      {{0.5, {0, 0, 0, -0.05}}, {1., {0, 0, 0, -0.1}}, {1.25, {-10, 10, -0.05, -0.05}}, {3., {-10, 10, -0.05, -0.05}}});

  p.contact_pairs[0].start.overclosure = Overclosure::interference;
  run(p,
      "begins as a press fit",
      {{1., {0, 0, 0, -0.1}},
       {1.25, {-2.5, 2.5, -0.0125, -0.0875}},
       {1.75, {-7.5, 7.5, -0.0375, -0.0625}},
       {2., {-10, 10, -0.05, -0.05}},
       {3., {-10, 10, -0.05, -0.05}}});
  run_in_two(p, "begins, restarted", {{1.25, {-2.5, 2.5, -0.0125, -0.0875}}, {3., {-10, 10, -0.05, -0.05}}});

  p                                    = cubes("-0.1*min(t,1)-0.02*max(0,t-2)");
  p.contact_pairs[0].active_from       = 1.;
  p.contact_pairs[0].start.overclosure = Overclosure::adjust;
  run(p, "begins adjusted", {{1., {0, 0, 0, -0.1}}, {2., {0, 0, 0, -0.1}}, {3., {-2, 2, -0.01, -0.11}}});

  p                               = cubes("0.02*min(t,1)+0.02*max(0,t-1)");
  p.contact_pairs[0].contact_law  = ContactPairParameters::ContactLaw::tied;
  p.contact_pairs[0].active_from  = 1.;
  p.contact_pairs[0].active_until = 2.;
  run(p,
      "tied for a while",
      {{1., {0, 0, 0, 0.02}}, {1.5, {1, -1, 0.005, 0.025}}, {2., {2, -2, 0.01, 0.03}}, {3., {0, 0, 0, 0.06}}});

  p                                          = cubes("-0.1*min(t,1)");
  p.contact_pairs[0].active_from             = 1.;
  p.contact_pairs[0].start.overclosure_limit = 0.05;
  refuse(p, "too deep");
  p = cubes("-0.9*min(t,1)");
  for (auto &body : p.bodies)
    body.material.law = MaterialParameters::Law::neo_hookean;
  p.contact_pairs[0].active_from     = 1.;
  p.contact_pairs[0].search_distance = 0.2;
  refuse(p, "deeper than pairing looks");
}
