// --profile: profile.json is JSON, its phases add up to the total, and it counts the iterations that contact.csv
// counts; runs that fail leave one, too. No times are compared with anything but each other.

#include "../cases.h"

// the JSON parser of this boost still uses the placeholders that boost::bind deprecates
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <deal.II/base/mpi.h>

#include <filesystem>

using namespace Cases;
using boost::property_tree::ptree;

namespace
{
  const std::string folder = "profile_results";

  /// Newton iterations of all increments, as contact.csv counts them, and the number of failures.
  std::pair<unsigned int, unsigned int> run(const Parameters &p)
  {
    if (root())
      std::filesystem::remove(std::filesystem::path(folder) / "profile.json");
    ContactProblem problem(p, world(), log());
    unsigned int   newton = 0;
    problem.on_increment([&](unsigned int, double) { newton += problem.iterations().newton; });
    problem.profile();
    try
    {
      problem.run();
      return {newton, 0};
    }
    catch (const SolverFailure &)
    {
      return {newton, 1};
    }
  }

  ptree read()
  {
    ptree tree;
    boost::property_tree::read_json(folder + "/profile.json", tree);
    return tree;
  }

  ptree phase(const ptree &profile, const std::string &name)
  {
    for (const auto &[key, entry] : profile.get_child("phases"))
      if (entry.get<std::string>("name") == name)
        return entry;
    throw std::runtime_error("no phase '" + name + "'");
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       ranks = dealii::Utilities::MPI::n_mpi_processes(world());

  Parameters p;
  p.bodies              = {box("lower", "3,3,1", {0, 0, 0}, {1, 1, 1}, 100, 0.3),
                           box("upper", "2,2,1", {0.1, 0.1, 1}, {0.9, 0.9, 2}, 100, 0.3)};
  p.boundary_conditions = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                           condition("top",
                                     BoundaryConditionParameters::Type::displacement,
                                     region(2, {z_plus}),
                                     {0, 1, 2},
                                     {"0", "0", "-0.1*t"})};
  for (auto &body : p.bodies)
    body.material.law = MaterialParameters::Law::neo_hookean;
  p.contact_pairs         = {pair(region(2, {z_minus}), region(1, {z_plus}), 0.3)};
  p.load_stepping         = {{1.}, {3}};
  p.output.results_folder = folder;

  for (const auto type : {LinearSolverParameters::Type::direct, LinearSolverParameters::Type::condensed})
  {
    p.linear_solver.type          = type;
    const bool direct             = type == LinearSolverParameters::Type::direct;
    const auto [newton, failures] = run(p);
    if (root())
    {
      const ptree profile = read();
      std::cout << (direct ? "direct" : "condensed") << std::endl;
      check("converged", failures == 0 && profile.get<bool>("converged"));
      check_equal("ranks", profile.get<unsigned int>("ranks"), ranks);
      check_equal("degrees of freedom", profile.get<unsigned int>("displacement_degrees_of_freedom"), 3 * (32 + 18));
      check("Newton iterations", newton > 3 && profile.get<unsigned int>("newton_iterations") == newton);
      check("Krylov iterations", (profile.get<unsigned int>("krylov_iterations") > 0) == !direct);
      check("one solve in each iteration", phase(profile, "solver iterations").get<unsigned int>("calls") == newton);
      // the direct solver may keep the factors of the iteration before, which is close to the end: at most one of three
      const unsigned int set_ups = phase(profile, "solver set-up").get<unsigned int>("calls");
      check("set-ups for the iterations", direct ? set_ups <= newton && 3 * set_ups >= 2 * newton : set_ups >= newton);
      check("assembled before and after each solve",
            phase(profile, "bulk assembly").get<unsigned int>("calls") >= newton + 3 &&
                phase(profile, "contact assembly").get<unsigned int>("calls") >= newton + 3);
      check_equal(
          "output of the start and of three increments", phase(profile, "output").get<unsigned int>("calls"), 4);

      double cpu = 0., share = 0., memory = 0.;
      bool   all = true, growing = true;
      for (const auto &[key, entry] : profile.get_child("phases"))
      {
        const double sum = entry.get<double>("cpu_seconds"), maximum = entry.get<double>("cpu_seconds_maximum");
        cpu += sum;
        share += entry.get<double>("share");
        all = all && entry.get<unsigned int>("calls") > 0 && sum >= 0. && maximum <= sum + 1e-9 &&
              sum <= ranks * maximum + 1e-9 && std::abs(sum - ranks * entry.get<double>("cpu_seconds_mean")) < 1e-6;
        memory  = std::max(memory, entry.get<double>("private_bytes"));
        growing = growing && entry.get<double>("private_bytes") > 1e6;
      }
      check("sum, mean and maximum of each phase", all);
      const double total = profile.get<double>("total.cpu_seconds");
      check("the phases add up to the total", std::abs(cpu - total) < 1e-6 * total);
      check("so do the shares", std::abs(share - 1.) < 1e-6);
      check("memory", growing && memory <= profile.get<double>("total.private_bytes"));
    }
  }

  p.newton.maximum_iterations   = 1;
  const auto [newton, failures] = run(p);
  if (root())
  {
    const ptree profile = read();
    std::cout << "a run that fails" << std::endl;
    check("not converged", failures == 1 && !profile.get<bool>("converged"));
    check("iterations until then", profile.get<unsigned int>("newton_iterations") > newton);
    check("nothing incomplete is left", !std::filesystem::exists(folder + "/profile.json.incomplete"));
  }
}
