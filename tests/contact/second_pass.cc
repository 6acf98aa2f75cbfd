// A block (0.33 x 0.3 faces) is tilted until its edge digs into the plate under it, whose larger faces are the slave:
// between the nodes and points of these nothing holds the corners of the block, which go in by more than the judge
// bears. The pair gets a second pass then (theory section 34): master nodes are held at half of what is tolerated.
// Forces are those of the exchanged pair, whose slave has the corners; a run that goes on after that from a checkpoint
// is the run that never stopped.

#include "../restart/interrupted.h"

#include <csignal>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;

  /// The lower body stands on the ground, the top of the upper one goes down by @p depth.
  Parameters pressed(const BodyParameters &lower, const BodyParameters &upper, const std::string &depth)
  {
    Parameters p;
    p.bodies              = {lower, upper};
    p.boundary_conditions = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                             condition("top",
                                       BoundaryConditionParameters::Type::displacement,
                                       region(2, {z_plus}),
                                       {0, 1, 2},
                                       {"0", "0", "-(" + depth + ")"})};
    p.output.write_vtu    = false;
    return p;
  }

  Parameters tilted_block(const Scheme scheme)
  {
    Parameters p = pressed(box("plate", "5,3,2", {-1.25, -0.75, -0.8}, {1.25, 0.75, 0}, 1000, 0.3),
                           box("block", "3,3,2", {-0.55, -0.45, 0}, {0.45, 0.45, 0.5}, 1000, 0.3),
                           "0.01*t + 0.25*t*(x+0.55)");
    for (BodyParameters &body : p.bodies)
      body.material.law = MaterialParameters::Law::neo_hookean;
    ContactPairParameters on_edge = pair(region(1, {z_plus}), region(2, {z_minus}), 0.3);
    on_edge.scheme                = scheme;
    on_edge.surface               = ContactPairParameters::Surface::faceted; // which depths are told from
    on_edge.normal                = ContactPairParameters::Normal::averaged;
    p.contact_pairs               = {on_edge};
    p.load_stepping.increments    = {4};
    p.output.checkpoint_interval  = 1;
    return p;
  }

  struct Run
  {
    unsigned int second_passes = 0;
    std::size_t  pairs         = 0;
    Vector3      on_block; ///< of all pairs
    double       depth = 0.;
  };

  /// Depth of the corner (0.45, 0.45) of the block below the plate: in the face that it is over, bilinear between its
  /// nodes.
  double corner_depth(const ContactProblem &problem)
  {
    const auto  position = [&](const unsigned int body, const Point &X) { return X + problem.displacement(body, X); };
    const Point corner   = position(2, {0.45, 0.45, 0});
    Point       nodes[4];
    for (unsigned int n = 0; n < 4; ++n)
      nodes[n] = position(1, {0.25 + 0.5 * (n % 2), 0.25 + 0.5 * (n / 2), 0});
    double xi = 0.4, eta = 0.4;
    for (unsigned int i = 0; i < 20; ++i) // the nearest point of the face, by Newton's method without its curvature
    {
      const Vector3 t1  = (1 - eta) * (nodes[1] - nodes[0]) + eta * (nodes[3] - nodes[2]),
                    t2  = (1 - xi) * (nodes[2] - nodes[0]) + xi * (nodes[3] - nodes[1]);
      const Vector3 off = corner - Point((1 - xi) * (1 - eta) * Vector3(nodes[0]) + xi * (1 - eta) * Vector3(nodes[1]) +
                                         (1 - xi) * eta * Vector3(nodes[2]) + xi * eta * Vector3(nodes[3]));
      const double  a = t1 * t1, b = t1 * t2, c = t2 * t2, f = off * t1, g = off * t2, det = a * c - b * b;
      xi += (c * f - b * g) / det;
      eta += (a * g - b * f) / det;
      if (i == 19)
      {
        const Vector3 n = dealii::cross_product_3d(t1, t2);
        return -(off * n) / n.norm();
      }
    }
    return 0.;
  }

  Run run(const Parameters &p, const bool restart = false, const unsigned int last = 0)
  {
    ContactProblem problem(p, world(), log());
    Run            result;
    problem.on_increment(
        [&](const unsigned int increment, const double)
        {
          result.second_passes += problem.iterations().remedies[Remedy::second_pass];
          if (increment == last)
            std::raise(SIGTERM);
        });
    run_until_interrupted(problem, restart);
    result.pairs = problem.contact_resultants().size();
    for (unsigned int q = 0; q < result.pairs; ++q)
    {
      const ContactResultants &r        = problem.contact_resultants()[q];
      const bool               is_slave = q > 0 || p.contact_pairs[0].slave.has_body(2);
      result.on_block += is_slave ? r.slave_force : r.master_force;
    }
    result.depth = p.bodies[0].name == "plate" ? corner_depth(problem) : 0.;
    return result;
  }
} // namespace

int main(int argc, char *argv[])
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Signals::install();
  struct Case
  {
    Scheme      scheme;
    const char *name;
    double      tolerated; ///< part of the mean face of the block, sqrt(0.1), that nodes or points may be deep
    double      error;     ///< of the force: what depth is left is 6, 3 and 12 % of the way that the edge is driven
  };
  for (const Case &c : {Case{Scheme::averaged, "averaged", 0.1, 0.05},
                        Case{Scheme::integration_point, "integration point", 0.05, 0.05},
                        Case{Scheme::nodal, "nodal", 0.2, 0.25}})
  {
    report("scheme", c.name);
    Parameters exchanged = tilted_block(c.scheme);
    std::swap(exchanged.contact_pairs[0].slave, exchanged.contact_pairs[0].master);
    const Run reference = run(in_new_folder(exchanged, "second_pass_exchanged"));
    check_equal("  second passes of the exchanged pair", reference.second_passes, 0);

    const Parameters whole  = in_new_folder(tilted_block(c.scheme), "second_pass_whole");
    const Run        result = run(whole);
    check_equal("  second passes", result.second_passes, 1);
    check("  depth of a corner over the mean face", result.depth / std::sqrt(0.1), 0.5 * c.tolerated, 0.02);
    check_error("  force on the block, that of the exchanged pair",
                (result.on_block - reference.on_block).norm() / reference.on_block.norm(),
                c.error,
                2);

    const Parameters parts = in_new_folder(tilted_block(c.scheme), "second_pass_parts");
    run(parts, false, 3);
    const Run rest = run(parts, true);
    check_equal("  pairs after a restart", rest.pairs, 2);
    check_error("  force after a restart", (rest.on_block - result.on_block).norm() / result.on_block.norm(), 1e-9);
  }

  // A punch between the sites of a slave of one face: held at half of the 0.05 or 0.2 of its faces of 0.1, it is 0.1
  // less that deep, and the bodies are linear.
  Parameters punch               = pressed(box("block", "1,1,1", {0, 0, 0}, {1, 1, 1}, 1000, 0.3),
                             box("punch", "2,2,2", {0.4, 0.4, 1}, {0.6, 0.6, 1.2}, 1000, 0.3),
                             "0.1*t");
  punch.load_stepping.increments = {2};
  punch.contact_pairs            = {pair(region(2, {z_minus}), region(1, {z_plus}))};
  const double force             = run(in_new_folder(punch, "second_pass_exchanged")).on_block[2];
  std::swap(punch.contact_pairs[0].slave, punch.contact_pairs[0].master);
  for (const auto &[scheme, tolerated] :
       {std::make_pair(Scheme::integration_point, 0.05), std::make_pair(Scheme::nodal, 0.2)})
  {
    punch.contact_pairs[0].scheme = scheme;
    check("force of a punch between the sites of its slave, over that of the exchanged pair",
          run(in_new_folder(punch, "second_pass_whole")).on_block[2] / force,
          1. - 0.5 * tolerated * 0.1 / 0.1,
          1e-3);
  }

  Parameters without       = in_new_folder(tilted_block(Scheme::averaged), "second_pass_without");
  without.strategy.without = {"second pass"};
  std::string reason;
  try
  {
    run(without);
  }
  catch (const SolverFailure &failure)
  {
    reason = failure.what();
  }
  const std::string what  = "penetration depth ";
  const std::size_t where = reason.find(what);
  const double      depth = where == std::string::npos ? 0. : std::stod(reason.substr(where + what.size()));
  check("without it the run ends before the block is deeper than 0.1, and says so", std::abs(depth - 0.1) < 0.005);
}
