// Rigid bodies in general contact ("Self contact") are master alone, those that move as prescribed and those that
// forces drive: forces and places as of pairs chosen by hand. Rigid bodies do not touch each other, and the judge asks
// their nodes as well.

#include "../cases.h"
#include "../messages.h"

using namespace Cases;

namespace
{
  BodyParameters rigid(const std::string &name, const std::string &cells, const Point &lower, const Point &upper)
  {
    BodyParameters body = box(name, cells, lower, upper, 0., 0.);
    body.material       = MaterialParameters();
    body.rigid          = true;
    return body;
  }

  /// All outer faces of the first body, which is soft, and of the rigid ones behind it.
  ContactPairParameters general(const unsigned int n_bodies, const double friction)
  {
    ContactPairParameters pair;
    pair.name         = "general";
    pair.slave        = region(1, {}, "1");
    pair.self_contact = true;
    pair.master       = pair.slave;
    for (unsigned int b = 2; b <= n_bodies; ++b)
      pair.master.bodies.push_back(b);
    pair.friction_coefficient = friction;
    return pair;
  }

  ContactPairParameters by_hand(const std::vector<unsigned int> &masters, const double friction)
  {
    ContactPairParameters pair = general(1, friction);
    pair.name                  = "by hand";
    pair.self_contact          = false;
    pair.slave                 = region(1, {z_plus});
    pair.master                = region(masters[0], {z_minus});
    pair.master.bodies         = masters;
    return pair;
  }

  Parameters block_and(const std::vector<BodyParameters> &tools)
  {
    Parameters p;
    p.bodies = {box("block", "4,3,2", {0, 0, 0}, {2, 1, 1}, 100., 0.3)};
    p.bodies.insert(p.bodies.end(), tools.begin(), tools.end());
    p.boundary_conditions    = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    p.load_stepping          = {{1., 2.}, {1, 2}};
    p.newton.force_tolerance = p.newton.contact_tolerance = 1e-11;
    p.output.write_vtu                                    = false;
    p.output.results_folder                               = "rigid_in_general_contact_results";
    return p;
  }

  struct Outcome
  {
    Vector3                      force;
    std::vector<RigidBodyMotion> rigid;
  };

  Outcome run(Parameters p, const ContactPairParameters &pair)
  {
    p.contact_pairs = {pair};
    ContactProblem problem(p, world(), log());
    problem.run();
    return {problem.contact_resultants()[0].slave_force, problem.rigid_bodies()};
  }

  void check_as_by_hand(const std::string               &name,
                        const Parameters                &p,
                        const std::vector<unsigned int> &masters,
                        const double                     friction)
  {
    const Outcome hand = run(p, by_hand(masters, friction)), all = run(p, general(p.bodies.size(), friction));
    report(name, "");
    check("  force, as of a pair by hand", all.force, hand.force, 1e-8);
    for (unsigned int i = 0; i < hand.rigid.size(); ++i)
      check(
          "  translation of body " + std::to_string(i + 2), all.rigid[i].translation, hand.rigid[i].translation, 1e-8);
  }

  /// Why it fails.
  std::string failure(const Parameters &p, const ContactPairParameters &pair)
  {
    try
    {
      run(p, pair);
    }
    catch (const std::exception &error)
    {
      return error.what();
    }
    return "no failure";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  // pressed on the block, then dragged along it
  Parameters p                   = block_and({rigid("plate", "3,2,1", {-0.5, -0.1, 1.01}, {2.5, 1.1, 1.3})});
  p.bodies[1].motion.translation = {"0.1*max(t-1,0)", "0", "-0.05*min(t,1)"};
  check_as_by_hand("plate that moves as prescribed, with friction", p, {2}, 0.2);

  // narrower than the block, whose edges are not covered
  p.bodies[1]                    = rigid("plate", "3,2,1", {0.2, -0.1, 1.01}, {1.7, 1.1, 1.3});
  p.bodies[1].motion.translation = {"0.1*max(t-1,0)", "0", "-0.05*min(t,1)"};
  check_as_by_hand("narrower plate", p, {2}, 0.2);

  // the same by forces
  p                                 = block_and({rigid("plate", "3,2,1", {-0.5, -0.1, 1.}, {2.5, 1.1, 1.3})});
  p.bodies[1].rigid_free            = {2};
  p.bodies[1].rigid_force           = {"0", "0", "-5*min(t,1)"};
  p.bodies[1].motion.translation[0] = "0.1*max(t-1,0)";
  check_as_by_hand("plate that a force drives, with friction", p, {2}, 0.2);

  // two beside each other, between which slave faces and nodes see both: one sinks in deeper
  p = block_and({rigid("left", "2,2,1", {-0.1, -0.1, 1.}, {0.9, 1.1, 1.2}),
                 rigid("right", "2,2,1", {0.9, -0.1, 1.}, {2.1, 1.1, 1.2})});
  for (unsigned int b = 1; b <= 2; ++b)
  {
    p.bodies[b].rigid_free            = {2};
    p.bodies[b].rigid_force           = {"0", "0", b == 1 ? "-5*min(t,1)" : "-2*min(t,1)"};
    p.bodies[b].motion.translation[0] = "0.02*max(t-1,0)";
  }
  check_as_by_hand("two that forces drive, with friction", p, {2, 3}, 0.2);
  const Outcome two = run(p, general(3, 0.2));
  check("  force on the left one", two.rigid[0].force[2], -5., 1e-8);
  check("  force on the right one", two.rigid[1].force[2], -2., 1e-8);
  check("  force on the block", two.force[2], -7., 1e-8);

  // rigid bodies do not see each other: one comes into the other from above
  p                                 = block_and({rigid("plate", "3,2,1", {-0.5, -0.1, 1.}, {2.5, 1.1, 1.3}),
                                                 rigid("lid", "1,1,1", {0.5, 0.2, 1.35}, {1.2, 0.8, 1.6})});
  p.bodies[1].motion.translation[2] = "-0.05*min(t,1)";
  p.bodies[2].motion.translation[2] = "-0.2*t";
  check_as_by_hand("two that come into each other", p, {2}, 0.2);

  // one that the nodes of the block do not see is seen by the judge
  p                                 = block_and({rigid("pin", "1,1,2", {0.7, 0.4, 1.01}, {0.8, 0.6, 2.})});
  p.bodies[1].motion.translation[2] = "-0.3*t";
  ContactPairParameters nodal       = general(2, 0.);
  nodal.scheme                      = ContactPairParameters::Scheme::nodal;
  nodal.slave.where = nodal.master.where = "";
  nodal.slave.ids_of_body                = {{1, {z_plus}}};
  nodal.master.ids_of_body               = {{1, {z_plus}}, {2, {z_minus}}};
  p.load_stepping                        = {{1.}, {2}};
  check_words("pin between nodes: refused", failure(p, nodal), {"master node"});
  return 0;
}
