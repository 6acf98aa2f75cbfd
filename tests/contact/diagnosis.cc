// Runs that cannot succeed leave a page about why: the cause that was built in is suspected first, with its evidence,
// and the keys that are to be changed exist.

#include "../cases.h"

#include "output/diagnosis/diagnosis.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

using namespace Cases;

namespace
{
  const std::string folder = "diagnosis_results";

  std::string contents(const std::string &name)
  {
    std::ifstream file(std::filesystem::path(folder) / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// The page that a run leaves; empty when it succeeds.
  std::string page(Parameters p)
  {
    p.output.results_folder = folder;
    std::string message;
    try
    {
      ContactProblem(p, world(), log()).run();
    }
    catch (const SolverFailure &failure)
    {
      message = failure.what();
    }
    MPI_Barrier(world());
    const std::string text = contents("diagnosis.md");
    if (!message.empty() && message.find("diagnosis.md") == std::string::npos)
      return "the message does not name the page: " + message;
    const std::string first = "1. **";
    const auto        begin = text.find(first);
    if (begin != std::string::npos)
      if (const std::string cause =
              text.substr(begin + first.size(), text.find("**", begin + 5) - begin - first.size());
          message.find(cause) == std::string::npos)
        return "the message does not repeat the first cause, " + cause + ": " + message;
    return message.empty() && text.empty() ? "" : text;
  }

  /// First words of the first cause and what else must be there.
  void expect(const std::string              &what,
              const std::string              &text,
              const std::string              &cause,
              const std::vector<std::string> &words)
  {
    std::string missing;
    if (text.find("1. **" + cause) == std::string::npos)
      missing = cause;
    for (const std::string &word : words)
      if (text.find(word) == std::string::npos)
        missing += (missing.empty() ? "" : "; ") + word;
    check(what, missing.empty());
    if (!missing.empty() && root())
      std::cout << "  without: " << missing << '\n' << text << std::endl;

    const std::regex key("\\| `([A-Za-z ]+?)( [0-9]+)?/([^`]+)` \\|");
    unsigned int     n_keys = 0;
    for (std::sregex_iterator k(text.begin(), text.end(), key), end; k != end; ++k)
    {
      ++n_keys;
      const std::string path = (*k)[1].str() + ((*k)[2].matched ? " 1" : "") + '/' + (*k)[3].str();
      try
      {
        Parameters::explain(path);
      }
      catch (const InputError &)
      {
        check("  the key " + path + " exists", false);
      }
    }
    check("  with keys to change, on one page", n_keys > 0 && std::count(text.begin(), text.end(), '\n') < 100);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Type = BoundaryConditionParameters::Type;

  Parameters p;
  p.bodies              = {box("lower", "3,3,1", {0, 0, 0}, {1, 1, 1}, 100, 0.3),
                           box("upper", "2,2,1", {0.1, 0.1, 1}, {0.9, 0.9, 2}, 100, 0.3)};
  p.boundary_conditions = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                           drive("top", region(2, {z_plus}), 2, "-0.1*t")};
  p.contact_pairs       = {pair(region(2, {z_minus}), region(1, {z_plus}))};
  p.output.write_vtu    = false;

  auto free             = p;
  free.output.write_vtu = true;
  const std::string state =
      dealii::Utilities::MPI::n_mpi_processes(world()) == 1 ? "failed_state.vtu" : "failed_state.pvtu";
  expect("held vertically alone, the upper block has three motions left",
         page(free),
         "a body can move freely",
         {"body 2 (upper) moves along (1 0 0)",
          "body 2 (upper) moves along (0 1 0)",
          "body 2 (upper) turns about (0 0 1)",
          "9 of 9 sites are closed, 9 of these slip",
          "not cut back, since smaller increments do not change that",
          "subsection Boundary condition 3\n",
          "  set Components   = x, y\n",
          "--set \"Load stepping/Viscous stabilisation=0.01\" --set \"Load stepping/Increments=4\"\n",
          "`Contact pair 1/Friction coefficient` | 0 | 0.1",
          state});
  auto then          = free; // dashpots are proposed for the interval alone where nothing holds the block
  then.load_stepping = {{1., 2.}, {1, 1}};
  expect("likewise in the first of two intervals",
         page(then),
         "a body can move freely",
         {"--set \"Load stepping/Viscous stabilisation=0.01, 0\" --set \"Load stepping/Increments=4, 1\"\n"});
  const std::string fields = contents(state);
  check("  and its state has the fields",
        fields.find("residual_force") != std::string::npos && fields.find("det_F") != std::string::npos &&
            fields.find("status_changes") != std::string::npos && fields.find("CPRESS") != std::string::npos);

  p.boundary_conditions[1] = condition("top", Type::displacement, region(2, {z_plus}), {0, 1, 2}, {"0", "0", "-0.1*t"});
  const std::string none   = page(p);
  check("the next run succeeds and leaves no page", none.empty() && contents(state).empty());

  auto pressed                             = p; // out of reach, and nothing but contact to hold it
  pressed.bodies[1]                        = box("upper", "2,2,1", {0.1, 0.1, 1.5}, {0.9, 0.9, 2.5}, 100, 0.3);
  pressed.contact_pairs[0].search_distance = 0.1;
  pressed.boundary_conditions[1]           = press("top", region(2, {z_plus}), "t");
  expect("a block beyond the search distance",
         page(pressed),
         "a body can move freely",
         {"body 2 (upper) turns about (1 0 0)",
          "the master is out of the search distance",
          "9 of 9 sites have no master point within 0.1",
          "`Contact pair 1/Search distance` | 0.1 | 0.4"});

  Parameters corner       = Parameters::read(SOURCE_DIR "/../../prm/snap_fit.prm",
                                       {"Contact pair 1/Slave body=hook",
                                              "Contact pair 1/Slave boundary ids=tooth",
                                              "Contact pair 1/Master body=catch",
                                              "Contact pair 1/Master boundary ids=catch",
                                              "Load stepping/Interval ends=0.3",
                                              "Load stepping/Increments=30"});
  corner.output.write_vtu = false;
  corner.strategy.without = {"second pass"}; // which would hold it
  expect("a corner of the master that presses into faces of the slave",
         page(corner),
         "an edge or a corner of one surface goes in between the nodes of the other one",
         {"`Contact pair 1/Slave body` | 1 | 2",
          "--set \"Contact pair 1/Slave body=2\" --set \"Contact pair 1/Slave boundary ids=22\" --set \"Contact pair "
          "1/Slave "
          "where=\" --set \"Contact pair 1/Master body=1\" --set \"Contact pair 1/Master boundary ids=12\""});

  auto newton = p;
  for (auto &body : newton.bodies)
    body.material.law = MaterialParameters::Law::neo_hookean;
  newton.newton.maximum_iterations = 2;
  newton.load_stepping             = {{1.}, {1}};
  newton.load_stepping.cut_back    = false;
  expect("Newton without iterations left",
         page(newton),
         "Newton's method",
         {"Newton did not converge in 2 iterations",
          "`Newton/Maximum iterations` | 2 |",
          "`Load stepping/Cut back` | false | true",
          "`Load stepping/Increments` | 1 | 4"});

  auto stiff                                  = newton; // the upper block is the slave
  stiff.bodies[1].material.youngs_modulus     = 2000;
  stiff.contact_pairs[0].friction_coefficient = 0.3;
  expect("likewise with a slave that is 20 times as stiff as its master",
         page(stiff),
         "the slave is much stiffer than its master",
         {"Young's modulus of the slave is 20 times that of the master",
          "--set \"Contact pair 1/Slave body=1\" --set \"Contact pair 1/Slave boundary ids=5\"",
          "--set \"Contact pair 1/Master body=2\" --set \"Contact pair 1/Master boundary ids=4\"",
          "Newton did not converge in 2 iterations"});

  auto crushed                         = newton;
  crushed.newton.maximum_iterations    = 25;
  crushed.boundary_conditions[1].value = {"0", "0", "-4*t"};
  expect("a crushed block",
         page(crushed),
         "cells are turned inside out",
         {"with det F <= 0", "`Newton/Line search` | false | true"});

  auto loop = p;
  use_loops(loop);
  loop.geometry_loop.maximum_passes = 2;
  loop.geometry_loop.tolerance      = 1e-14;
  loop.load_stepping.cut_back       = false;
  expect("a geometry loop without passes left",
         page(loop),
         "the geometry loop does not converge",
         {"The last passes of the geometry loop",
          "`Contact pair 1/Normal` | master facet | averaged",
          "`Geometry loop/Mode`"});

  auto friction           = loop; // the coupled threshold, which comes next, fails in the geometry loop
  friction.threshold_loop = {2, 1e-14, LoopParameters::Mode::fixed_point};
  friction.contact_pairs[0].friction_coefficient = 0.5;
  friction.boundary_conditions[1].value          = {"0.05*t", "0", "-0.1*t"};
  expect("a threshold loop without passes left",
         page(friction),
         "the geometry loop does not converge",
         {"threshold loop",
          "changes of the threshold in the last passes",
          "largest friction coefficient 0.5",
          "`Threshold loop/Mode` | fixed point | newton"});

  // Failures that small models do not have, from evidence made up.
  const auto first_change = [](const Parameters &q, const SolverFailure::Kind kind)
  {
    Diagnosis::History history;
    history.increment = 1;
    history.end       = 1.;
    history.passes    = {{"geometry", 3, 0.4, 0.01, "(1 0 0)"}};
    FailureEvidence evidence;
    evidence.kind          = kind;
    evidence.linear_solver = q.linear_solver.type;
    evidence.pairs.resize(1);
    if (kind == SolverFailure::Kind::inverted_cell) // slave nodes go beyond rims with what is crushed
      evidence.inverted_cells = evidence.pairs[0].lost = 1;
    const SuspectedCause cause = suspected_causes(q, history, evidence).front();
    return cause.name + ": " + cause.changes.front().key + " = " + cause.changes.front().proposed;
  };
  auto slow               = p;
  slow.linear_solver.type = LinearSolverParameters::Type::block;
  check("a Krylov solver without iterations left",
        first_change(slow, SolverFailure::Kind::linear_solver) ==
            "the linear solver did not succeed: Linear solver/Type = direct");
  check("a geometry loop with period 2",
        first_change(p, SolverFailure::Kind::geometry_cycle) ==
            "normals jump between the facets of the master: the geometry loop comes back to the pass before the last "
            "one: "
            "Contact pair 1/Normal = averaged");

  check("a crushed block whose nodes lost the master",
        first_change(p, SolverFailure::Kind::inverted_cell) ==
            "cells are turned inside out: Load stepping/Minimum increment = 0.0625");

  auto mixed                     = p;
  mixed.contact_pairs[0].scheme  = ContactPairParameters::Scheme::nodal;
  mixed.contact_pairs[0].weights = ContactPairParameters::Weights::consistent;
  check("statuses that contradict each other with consistent weights",
        first_change(mixed, SolverFailure::Kind::status_cycle) ==
            "statuses change back and forth: Contact pair 1/Weights = nodal quadrature");
  mixed.contact_pairs[0].scheme = ContactPairParameters::Scheme::integration_point;
  check("statuses of integration points that contradict each other",
        first_change(mixed, SolverFailure::Kind::status_cycle) ==
            "statuses change back and forth: Contact pair 1/Scheme = averaged");

  const auto judged = [&](const unsigned int n_changed)
  {
    FailureEvidence evidence;
    evidence.kind            = SolverFailure::Kind::judged;
    evidence.n_changed_sites = n_changed;
    return suspected_causes(p, Diagnosis::History(), evidence).front().name;
  };
  check("a state that does not hold, and statuses that change", judged(2) == "statuses change back and forth");
  check("  without them", judged(0).compare(0, 15, "Newton's method") == 0);

  auto twice          = p; // each side is slave of the other one: the same constraints come twice
  twice.bodies[0]     = box("lower", "2,2,1", {0, 0, 0}, {1, 1, 1}, 100, 0.3);
  twice.bodies[1]     = box("upper", "2,2,1", {0, 0, 1}, {1, 1, 2}, 100, 0.3);
  twice.contact_pairs = {pair(region(2, {z_minus}), region(1, {z_plus})),
                         pair(region(1, {z_plus}), region(2, {z_minus}))};
  expect("contact that is asked for twice",
         page(twice),
         "a contact constraint repeats another constraint",
         {"null pivot of the contact multiplier",
          "components of its displacement that are prescribed: none",
          "has the same bodies with slave and master exchanged",
          "/Slave where`",
          "/Slave body=1\" --set \"Contact pair 1/Slave boundary ids=5\""});

  auto strip                   = p; // it buckles between two walls, and may not be relaxed
  strip.bodies                 = {box("strip", "20,2,1", {0, -0.25, 0}, {20, 0.25, 0.5}, 1000, 0.3)};
  strip.bodies[0].material.law = MaterialParameters::Law::neo_hookean;
  strip.boundary_conditions    = {hold("clamp", region(1, {x_minus}), {0, 1, 2}),
                                  condition("push", Type::displacement, region(1, {x_plus}), {0, 1}, {"-1.6*t", "0"}),
                                  hold("plane strain", region(1, {z_minus, z_plus}), {2}),
                                  condition("imperfection", Type::traction, region(1, {y_plus}), {1}, {"-0.05"})};
  strip.contact_pairs.assign(2, p.contact_pairs[0]);
  for (const bool upper : {false, true})
  {
    auto &wall                = strip.contact_pairs[upper];
    wall.name                 = upper ? "upper wall" : "lower wall";
    wall.slave                = region(1, {upper ? y_plus : y_minus});
    wall.master               = {};
    wall.master_surface.shape = MasterSurfaceParameters::Shape::plane;
    wall.master_surface.point = Point(0., upper ? 1.25 : -1.25, 0.);
    wall.master_surface.axis  = Vector3({0., upper ? -1. : 1., 0.});
  }
  strip.strategy.without         = {"relaxation"};
  strip.load_stepping.increments = {16};
  expect("a strip that buckles",
         page(strip),
         "the bodies are not stable: they buckle, snap through or soften",
         {"negative eigenvalues", "`Strategy/Without` | with relaxation |"});

  auto driven                          = p; // both surfaces of the contact are moved, along each other
  driven.boundary_conditions[0].region = region(1, {z_plus});
  driven.boundary_conditions[1] = condition("slide", Type::displacement, region(2, {z_minus}), {0, 1}, {"0.1*t", "0"});
  driven.boundary_conditions.push_back(condition("down", Type::displacement, region(2, {z_plus}), {2}, {"-0.02*t"}));
  driven.contact_pairs[0].friction_coefficient = 0.3;
  expect("a contact whose sides are both driven",
         page(driven),
         "displacements of both sides of the contact are prescribed",
         {"`Boundary condition 1/Boundary ids` | 5 |",
          "it holds the master side of contact pair 1",
          "`Boundary condition 2/Boundary ids` | 4 |",
          "it holds the slave side of contact pair 1"});

  // between the four nodes of a stiff block a soft one comes through
  auto coarse                     = p;
  coarse.bodies                   = {box("lower", "8,8,2", {0, 0, 0}, {1, 1, 1}, 100, 0.3),
                                     box("upper", "1,1,1", {0.1, 0.1, 1}, {0.9, 0.9, 2}, 10000, 0.3)};
  coarse.contact_pairs[0].weights = ContactPairParameters::Weights::dual;
  coarse.load_stepping            = {{1.}, {1}};
  coarse.load_stepping.cut_back   = false;
  coarse.strategy.without         = {"second pass"}; // which would hold it
  expect("a slave that is coarser than its master",
         page(coarse),
         "the master has finer faces than the slave",
         {"--set \"Contact pair 1/Scheme=averaged\" --set \"Contact pair 1/Weights=nodal quadrature\"\n"});
  coarse.contact_pairs[0].scheme  = ContactPairParameters::Scheme::averaged;
  coarse.contact_pairs[0].weights = ContactPairParameters::Weights::nodal_quadrature;
  const std::string cured         = page(coarse);
  check("  with what it proposes the run succeeds", cured.empty());
}
