// What the keys of `Adaptivity` promise. Refinement near expected contact, on masters with a mesh and in closed form:
// faces in contact are split once per cycle up to the maximum level. Marking by target error: the estimate ends below
// the target, repeating the increment until it does. Maximum unknowns: not exceeded by more than a tenth. Slaves at
// least as fine: a J2 cube on a finer rigid plate is split while it yields; force and states follow the closed form of
// uniaxial stress, tau = E(e - a) = Y + H a, e the logarithmic strain, nominal stress tau/lambda. Meshes stay while
// reactions are released.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <sstream>

using namespace Cases;

namespace
{
  struct Run
  {
    unsigned int        slave_nodes = 0; ///< at the end
    double              force       = 0.;
    std::vector<double> estimates; ///< per cent
    std::vector<double> unknowns;  ///< of new meshes, and their cells
  };

  Run follow(const Parameters &p)
  {
    std::ostringstream log;
    ContactProblem     problem(p, world(), log);
    problem.run();
    Run         result;
    const auto &r          = problem.contact_resultants()[0];
    result.slave_nodes     = r.open + r.slip + r.stick;
    result.force           = r.slave_force[2];
    const std::string text = log.str();
    const auto        find = [&](const std::string &words, std::vector<double> &numbers)
    {
      for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
        numbers.push_back(std::stod(text.substr(at + words.size())));
    };
    find("estimated error ", result.estimates);
    find("-> ", result.unknowns);
    if (!root()) // the log is there alone, and so are the checks
      result.estimates = result.unknowns = {0.};
    if (std::getenv("NODUS_TEST_LOG") != nullptr && root())
      std::cout << text << std::endl;
    return result;
  }

  /// A cube of 2 x 2 x 2 cells on a larger block of 4 x 4 x 2.
  Parameters cube_on_block()
  {
    Parameters p;
    p.bodies                        = {box("block", "4,4,2", {-0.5, -0.5, -1}, {1.5, 1.5, 0}, 1000., 0.3),
                                       box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000., 0.3)};
    p.boundary_conditions           = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                       drive("press", region(2, {z_plus}), 2, "-0.02*t"),
                                       hold("guide", region(2, {z_plus}), {0, 1})};
    p.contact_pairs                 = {pair(region(2, {z_minus}), region(1, {z_plus}))};
    p.contact_pairs[0].scheme       = ContactPairParameters::Scheme::averaged;
    p.contact_pairs[0].normal       = ContactPairParameters::Normal::averaged;
    p.contact_pairs[0].start.status = ContactPairParameters::InitialStatus::closed;
    p.load_stepping.increments      = {2};
    p.output.results_folder         = "criteria_results";
    p.output.write_vtu              = false;
    p.output.checkpoint_interval    = 0;
    return p;
  }

  void check_initial_cycles()
  {
    Parameters p                  = cube_on_block();
    p.load_stepping.increments    = {1};
    p.adaptivity.contact_distance = 0.1;
    for (const bool rigid : {false, true})
    {
      if (rigid)
      {
        p.bodies.erase(p.bodies.begin());
        p.boundary_conditions.erase(p.boundary_conditions.begin());
        for (auto &condition : p.boundary_conditions)
          condition.region.bodies = {1};
        p.contact_pairs[0].slave                = region(1, {z_minus});
        p.contact_pairs[0].master               = RegionParameters();
        p.contact_pairs[0].master_surface.shape = MasterSurfaceParameters::Shape::plane;
        p.contact_pairs[0].master_surface.axis  = Vector3({0., 0., 1.});
      }
      for (const auto &[cycles, level, nodes_per_edge] : {std::tuple(0, 2, 3), {1, 2, 5}, {3, 2, 9}, {3, 1, 5}})
      {
        p.adaptivity.initial_cycles = cycles;
        p.adaptivity.maximum_level  = level;
        const Run run               = follow(p);
        check_equal((rigid ? "rigid plane, " : "block, ") + std::to_string(cycles) + " initial cycles, at most level " +
                        std::to_string(level) + ": slave nodes",
                    run.slave_nodes,
                    nodes_per_edge * nodes_per_edge);
      }
    }
  }

  void check_target_error()
  {
    Parameters p              = cube_on_block();
    p.adaptivity.interval     = 1;
    p.adaptivity.repetitions  = 3;
    p.adaptivity.marking      = AdaptivityParameters::Marking::target_error;
    p.adaptivity.target_error = 0.2;
    const Run run             = follow(p);
    report("target error: missed at first with, per cent",
           Numbers::number(run.estimates.front(), 3) + (run.estimates.front() > 20. ? "" : ": NO"));
    report("target error: met in the end with",
           Numbers::number(run.estimates.back(), 3) + (run.estimates.back() <= 20. ? "" : ": NO"));
    const auto met = std::find_if(run.estimates.begin(), run.estimates.end(), [](const double e) { return e <= 20.; });
    check_count("target error: repetitions until then", met - run.estimates.begin(), 3);

    p.adaptivity.maximum_unknowns = 1500.;
    p.adaptivity.target_error     = 0.01;
    const Run limited             = follow(p);
    check_count("maximum unknowns", // but for neighbours that are split so that levels differ by one at most
                *std::max_element(limited.unknowns.begin(), limited.unknowns.end()),
                1.1 * p.adaptivity.maximum_unknowns);
    report("maximum unknowns: the mesh grew nevertheless, to",
           Numbers::plain(limited.unknowns.back()) + (limited.unknowns.back() > 600. ? "" : ": NO"));
  }

  void check_slave_at_least_as_fine()
  {
    const double                 E = 1000., Y = 10., H = 100., lambda = 0.94;
    Parameters                   p          = cube_on_block();
    std::vector<BodyParameters> &bodies     = p.bodies;
    bodies                                  = {box("plate", "4,4,1", {0, 0, -0.5}, {1, 1, 0}, 1., 0.),
                                               box("cube", "1,1,1", {0, 0, 0}, {1, 1, 1}, E, 0.3)};
    bodies[0].rigid                         = true;
    bodies[1].material.law                  = MaterialParameters::Law::j2_plasticity;
    bodies[1].material.yield_stress         = Y;
    bodies[1].material.hardening_modulus    = H;
    p.boundary_conditions                   = {hold("x", region(2, {x_minus}), {0}),
                                               hold("y", region(2, {y_minus}), {1}),
                                               drive("press", region(2, {z_plus}), 2, "-0.06*t")};
    p.contact_pairs                         = {pair(region(2, {z_minus}), region(1, {z_plus}))};
    p.contact_pairs[0].scheme               = ContactPairParameters::Scheme::averaged;
    p.contact_pairs[0].start.status         = ContactPairParameters::InitialStatus::closed;
    p.contact_pairs[0].projection_tolerance = 0.5; // the cube grows over the edge of the plate
    p.newton.force_tolerance                = 1e-10;
    p.load_stepping.increments              = {6};
    p.adaptivity.interval                   = 2;
    const Run    run                        = follow(p);
    const double strain = -std::log(lambda), plastic = (E * strain - Y) / (E + H), tau = Y + H * plastic;
    check_equal("slave at least as fine: slave nodes", run.slave_nodes, 25);
    check("slave at least as fine: force of the J2 cube", run.force, tau / lambda, 1e-8);
  }

  /// An increment that is repeated may be cut back, and then it needs the reactions that are released until its end.
  void check_released_reactions()
  {
    Parameters p = cube_on_block();
    p.boundary_conditions.push_back(drive("stretch", region(2, {x_plus}, "z<0.9"), 0, "0.001*t"));
    p.boundary_conditions.back().active_until = 1.;
    p.load_stepping.interval_ends             = {1., 2.};
    p.load_stepping.increments                = {1, 1};
    p.adaptivity.repetitions                  = 1;
    p.adaptivity.maximum_level                = 2;
    const Run run                             = follow(p);
    // cells and unknowns of one new mesh
    check("the mesh changes in the first interval, not in the one that releases", run.unknowns.size() == 2);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_initial_cycles();
  check_target_error();
  check_slave_at_least_as_fine();
  check_released_reactions();
}
