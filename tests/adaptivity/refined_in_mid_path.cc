// A block pressed on a larger one and dragged while the mesh is refined and coarsened after each increment. The contact
// balances, the friction is mu times the pressing force where all slips (V = 25 from a pressure of 25 on the unit
// square), a change of the mesh leaves the forces of these coarse meshes as they are to 0.5 %, and the same meshes and
// forces arise on any number of ranks and after a restart on another number. What sticks has the tractions of the same
// mesh from the start.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

using namespace Cases;

namespace
{
  Parameters dragged_block(const ContactPairParameters::Scheme scheme, const std::string &folder)
  {
    Parameters p;
    p.bodies                  = {box("lower", "6,4,2", {-0.5, -0.25, -1}, {1.75, 1.25, 0}, 4000, 0.3),
                                 box("upper", "3,3,3", {0, 0, 0}, {1, 1, 1}, 2000, 0.3)};
    p.boundary_conditions     = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                 press("weight", region(2, {z_plus}), "25*min(1, 4*t)"),
                                 drive("drag", region(2, {z_plus}), 0, "0.16*max(0, t-0.25)"),
                                 hold("guide", region(2, {z_plus}), {1})};
    p.contact_pairs           = {pair(region(2, {z_minus}), region(1, {z_plus}), 0.3)};
    p.contact_pairs[0].scheme = scheme;
    if (scheme == ContactPairParameters::Scheme::integration_point)
      p.contact_pairs[0].friction_coefficient = 0.;
    p.contact_pairs[0].start.status = ContactPairParameters::InitialStatus::closed;
    p.contact_pairs[0].normal       = ContactPairParameters::Normal::averaged;
    p.load_stepping.increments      = {8};
    p.newton.force_tolerance        = 1e-11;
    p.adaptivity.interval           = 1;
    p.adaptivity.maximum_level      = 1;
    p.adaptivity.refine_fraction    = 0.5;
    p.adaptivity.coarsen_fraction   = 0.1;
    p.output.results_folder         = folder;
    p.output.write_vtu              = false;
    p.output.checkpoint_interval    = 5;
    return p;
  }

  /// Pressed by a displacement that is held through a second interval, in which the mesh goes on changing.
  Parameters held_block()
  {
    Parameters p                  = dragged_block(ContactPairParameters::Scheme::averaged, "mid_path_results");
    p.boundary_conditions         = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                     drive("press", region(2, {z_plus}), 2, "-0.01*min(1, t)"),
                                     hold("guide", region(2, {z_plus}), {0, 1})};
    p.load_stepping.interval_ends = {1, 2};
    p.load_stepping.increments    = {2, 20};
    p.adaptivity.refine_fraction  = 0.3;
    p.adaptivity.coarsen_fraction = 0.2;
    p.output.checkpoint_interval  = 0;
    // several sets of sticking sites balance, with forces 4e-4 apart: which one is found depends on the path
    p.newton.largest_forcing_term = 1e-4;
    p.linear_solver.type          = LinearSolverParameters::Type::direct;
    return p;
  }

  /// A plate that is pressed on a plane and pushed along it until it slips where it is pushed, as in
  /// prm/plate_on_rigid_plane.prm; then all its cells are split while the loads stay.
  Parameters pushed_plate(const double friction)
  {
    Parameters p;
    p.bodies              = {box("plate", "16,5,1", {0, 0, 0}, {40, 40, 1}, 1.3e5, 0.2)};
    p.boundary_conditions = {
        hold("held edge", region(1, {x_plus}), {0}),
        hold("plane strain", region(1, {z_minus, z_plus}), {2}),
        condition("pressing", BoundaryConditionParameters::Type::traction, region(1, {y_plus}), {1}, {"-50*min(t,1)"}),
        condition("pushing", BoundaryConditionParameters::Type::traction, region(1, {x_minus}), {0}, {"150*min(t,1)"})};
    p.contact_pairs               = {pair(region(1, {y_minus}), RegionParameters(), friction)};
    auto &contact                 = p.contact_pairs[0];
    contact.scheme                = ContactPairParameters::Scheme::averaged;
    contact.start.status          = ContactPairParameters::InitialStatus::closed;
    contact.normal                = ContactPairParameters::Normal::averaged;
    contact.master_surface.shape  = MasterSurfaceParameters::Shape::plane;
    contact.master_surface.axis   = Vector3({0., 1., 0.});
    p.load_stepping.interval_ends = {1, 2};
    p.load_stepping.increments    = {1, 2};
    p.adaptivity.interval         = 1;
    p.adaptivity.maximum_level    = 1;
    p.adaptivity.marking          = AdaptivityParameters::Marking::target_error;
    p.adaptivity.target_error     = 1e-9;
    p.output.results_folder       = "mid_path_results";
    p.output.write_vtu            = false;
    p.output.checkpoint_interval  = 0;
    return p;
  }

  /// Friction tractions of two blocks that stick on each other, pressed and sheared at once; all cells are split before
  /// the load, or after it.
  std::vector<Vector3> sticking_blocks(const ContactPairParameters::Scheme scheme, const bool from_the_start)
  {
    Parameters p;
    p.bodies                      = {box("lower", "5,4,2", {-0.25, -0.25, -0.5}, {1.25, 1.25, 0}, 1000., 0.3),
                                     box("upper", "3,3,2", {0, 0, 0}, {1, 1, 0.5}, 1000., 0.3)};
    p.boundary_conditions         = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                     drive("press", region(2, {z_plus}), 2, "-0.02*min(t,1)"),
                                     drive("shear", region(2, {z_plus}), 0, "0.01*min(t,1)"),
                                     hold("guide", region(2, {z_plus}), {1})};
    p.contact_pairs               = {pair(region(2, {z_minus}), region(1, {z_plus}), 100.)};
    auto &contact                 = p.contact_pairs[0];
    contact.scheme                = scheme;
    contact.normal                = ContactPairParameters::Normal::averaged;
    contact.start.status          = ContactPairParameters::InitialStatus::closed;
    p.load_stepping.interval_ends = {1, 2};
    p.load_stepping.increments    = {1, 1};
    p.newton.force_tolerance      = 1e-11;
    p.output.results_folder       = "mid_path_results";
    p.output.write_vtu            = false;
    p.output.checkpoint_interval  = 0;
    if (from_the_start)
      for (auto &body : p.bodies)
        body.global_refinement = 1;
    else
    {
      p.adaptivity.interval      = 1;
      p.adaptivity.maximum_level = 1;
      p.adaptivity.marking       = AdaptivityParameters::Marking::target_error;
      p.adaptivity.target_error  = 1e-9;
    }
    ContactProblem problem(p, world(), log());
    problem.run();
    const auto               &fields = problem.contact_fields()[0];
    std::vector<Vector3>      friction;
    std::vector<unsigned int> order(fields.X.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](const unsigned int i)
    { return std::make_pair(std::round(1e6 * fields.X[i][0]), std::round(1e6 * fields.X[i][1])); };
    std::sort(order.begin(), order.end(), [&](const unsigned int a, const unsigned int b) { return key(a) < key(b); });
    for (const unsigned int i : order)
      friction.push_back(fields.friction[i]);
    return friction;
  }

  struct Run
  {
    std::vector<Vector3>      force;
    std::vector<unsigned int> slave_nodes;
    double                    largest_change = 0.; ///< of the contact force with the mesh, per cent
    double                    unbalanced     = 0.;
  };

  /// On the ranks of @p communicator; MPI_COMM_NULL on the others.
  Run follow(const Parameters &p, const MPI_Comm communicator, const bool restart = false)
  {
    Run result;
    if (communicator == MPI_COMM_NULL)
      return result;
    std::ostringstream log;
    ContactProblem     problem(p, communicator, log);
    if (restart)
      problem.restart();
    problem.on_increment(
        [&](const unsigned int, const double)
        {
          const auto &r = problem.contact_resultants()[0];
          result.force.push_back(r.slave_force);
          result.slave_nodes.push_back(r.open + r.slip + r.stick);
          result.unbalanced = std::max(result.unbalanced, (r.slave_force + r.master_force).norm() / 25.);
        });
    problem.run();
    const std::string text = log.str(), words = "changes by ";
    for (std::size_t at = text.find("the contact force of"); at != std::string::npos;
         at             = text.find("the contact force of", at + 1))
      result.largest_change =
          std::max(result.largest_change, std::stod(text.substr(text.find(words, at) + words.size())));
    if (std::getenv("NODUS_TEST_LOG") != nullptr && root())
      std::cout << text << std::endl;
    return result;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  MPI_Comm                                 first_rank;
  MPI_Comm_split(world(), root() ? 0 : MPI_UNDEFINED, 0, &first_rank);
  using Scheme                                    = ContactPairParameters::Scheme;
  const std::pair<Scheme, const char *> schemes[] = {
      {Scheme::averaged, "averaged"}, {Scheme::nodal, "nodal"}, {Scheme::integration_point, "integration points"}};
  for (const auto &[scheme, name] : schemes)
  {
    const Run run = follow(dragged_block(scheme, "mid_path_results"), world());
    if (root())
    {
      std::cout << name << ":" << std::endl << std::setprecision(9);
      for (unsigned int i = 0; i < run.force.size(); ++i)
        std::cout << "  " << run.slave_nodes[i] << " sites, force " << run.force[i][0] << " " << run.force[i][2]
                  << std::endl;
    }
    check("  pressing force", run.force.back()[2], 25., 1e-6);
    if (scheme != Scheme::integration_point)                      // frictionless
      check("  friction", run.force.back()[0], -0.3 * 25., 5e-3); // it slips aside a little, too
    check("  force out of balance", run.unbalanced, 0., 1e-10, 1.);
    check("  largest change of the force with the mesh, per cent", run.largest_change, 0., 0.5, 1.);
    check("  the mesh changes", run.slave_nodes.front() != run.slave_nodes.back());
    if (scheme != Scheme::averaged)
      continue;
    // written by all ranks and read by one, then the other way round
    const auto check_restart =
        [&, scheme = scheme](const MPI_Comm writes, const MPI_Comm reads, const unsigned int interval)
    {
      Parameters p                 = dragged_block(scheme, "mid_path_results");
      p.output.checkpoint_interval = interval;
      if (writes != world())
        follow(p, writes);
      MPI_Barrier(world());
      const Run again = follow(p, reads, true);
      MPI_Barrier(world());
      const std::string name = "  restart after increment " + std::to_string(interval);
      if (!root())
        return;
      check(name + ": friction at the end", again.force.back()[0], run.force.back()[0], 1e-8);
      check_equal(name + ": sites of the mesh", again.slave_nodes.back(), run.slave_nodes.back());
      check_equal(name + ": increments", again.force.size(), run.force.size() - interval);
    };
    check_restart(world(), first_rank, 5);
    check_restart(first_rank, world(), 6);
  }

  const Run run = follow(held_block(), world());
  if (std::getenv("NODUS_TEST_LOG") != nullptr && root())
    for (unsigned int i = 0; i < run.force.size(); ++i)
      std::cout << run.slave_nodes[i] << " sites, force " << run.force[i] << std::endl;
  // it comes back to the same two meshes again and again, with other sticking sites
  check_equal("held while cells are split and joined: sites of the mesh", run.slave_nodes[20], run.slave_nodes[12]);
  check("held while cells are split and joined: pressing force", run.force[20][2], run.force[12][2], 1e-4);

  // slip that is due to the mesh alone leaves friction as it is
  const Run plate = follow(pushed_plate(0.2), world());
  if (root())
  {
    check("plate: the mesh is finer", plate.slave_nodes.back() > plate.slave_nodes.front());
    report("plate: sites before and after",
           std::to_string(plate.slave_nodes.front()) + " " + std::to_string(plate.slave_nodes.back()));
    check("plate: friction on the finer mesh", plate.force.back()[0], plate.force.front()[0], 5e-3);
  }

  // nodes that hung have the state of those that they followed
  Parameters p                 = pushed_plate(0.2);
  p.bodies[0].local_refinement = 1;
  p.bodies[0].refine_where     = "x<20";
  p.adaptivity.maximum_level   = 2;
  p.load_stepping.increments   = {1, 1};
  const Run graded             = follow(p, world());
  if (root())
    check("graded plate: friction on the finer mesh", graded.force.back()[0], graded.force.front()[0], 1.5e-3);

  // what sticks sticks where the surfaces did, not where the interpolated displacement is
  using Scheme = ContactPairParameters::Scheme;
  for (const Scheme scheme : {Scheme::averaged, Scheme::nodal, Scheme::integration_point})
  {
    const std::vector<Vector3> mid_path = sticking_blocks(scheme, false), start = sticking_blocks(scheme, true);
    double                     difference = 0., size = 0.;
    for (unsigned int i = 0; i < std::min(start.size(), mid_path.size()); ++i)
    {
      difference += (mid_path[i] - start[i]).norm_square();
      size += start[i].norm_square();
    }
    check_equal("sticking blocks: nodes", mid_path.size(), start.size());
    check("sticking blocks: friction tractions as on the same mesh from the start",
          std::sqrt(difference / size),
          0.,
          scheme == Scheme::integration_point ? 1e-3 : 1e-6, // points take over means of nodes
          1.);
  }
}
