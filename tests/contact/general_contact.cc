// General contact: all outer faces of all bodies in one pair ("Self contact"). What is slave and master of another pair
// is left to that one, of two such pairs to the later one, excluded bodies do not meet, and the finer body is slave,
// the softer one where both are alike, the much softer one in any case.

#include "../cases.h"

using namespace Cases;

namespace
{
  constexpr double E = 100.;

  ContactPairParameters general(const std::vector<unsigned int> &bodies, const double friction)
  {
    ContactPairParameters pair;
    pair.name                 = "general";
    pair.slave.bodies         = bodies;
    pair.slave.where          = "1";
    pair.master               = pair.slave;
    pair.self_contact         = true;
    pair.friction_coefficient = friction;
    return pair;
  }

  /// Blocks on a slab, pressed by 0.01, the second one as deep as it is said, and then dragged by 0.1, so that they
  /// slide.
  Parameters blocks_on_slab(const unsigned int n_blocks, const std::string &depth = "0.01")
  {
    Parameters p;
    p.bodies              = {box("slab", "6,2,1", {0, 0, 0}, {6, 2, 1}, E, 0.2)};
    p.boundary_conditions = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    for (unsigned int b = 0; b < n_blocks; ++b)
    {
      const double x = 3.6 - 3. * b;
      p.bodies.push_back(box("block", "2,2,2", {x, 0.5, 1.}, {x + 1., 1.5, 2.}, E, 0.2));
      p.boundary_conditions.push_back(
          condition("top",
                    BoundaryConditionParameters::Type::displacement,
                    region(b + 2, {z_plus}),
                    {0, 1, 2},
                    {"0.1*max(t-1,0)", "0", "-" + (b == 0 ? "0.01" : depth) + "*min(t,1)"}));
    }
    p.load_stepping         = {{1., 2.}, {1, 2}};
    p.output.write_vtu      = false;
    p.output.results_folder = "general_contact_results";
    return p;
  }

  std::vector<ContactResultants> run(const Parameters &p)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    return problem.contact_resultants();
  }

  void check_friction(const std::string &what, const ContactResultants &r, const double coefficient)
  {
    const Vector3 pressure = r.slave_force - r.friction;
    check(what + ", friction over pressure", r.friction.norm() / pressure.norm(), coefficient, 1e-3);
  }

  void check_slave(const std::string &name,
                   const double       lower,
                   const double       upper,
                   const std::string &cells_of_upper,
                   const double       slave_at)
  {
    Parameters p;
    p.bodies                = {box("lower", "3,3,2", {0, 0, 0}, {1, 1, 1}, lower, 0.),
                               box("upper", cells_of_upper, {0, 0, 1.01}, {1, 1, 2.01}, upper, 0.)};
    p.boundary_conditions   = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                               hold("sides", region(2, {z_plus}), {0, 1}),
                               drive("top", region(2, {z_plus}), 2, "-0.02*t")};
    p.contact_pairs         = {general({1, 2}, 0.)};
    p.load_stepping         = {{1.}, {1}};
    p.output.write_vtu      = false;
    p.output.results_folder = "general_contact_results";
    ContactProblem problem(p, world(), log());
    problem.run();
    const ContactFields &fields = problem.contact_fields()[0];
    std::vector<double>  z;
    for (unsigned int k = 0; k < fields.X.size(); ++k)
      if (fields.status[k] != ContactStatus::open)
        z.push_back(fields.X[k][2]);
    report(name, "");
    check("  closed nodes are at z =", farthest(z, slave_at), slave_at, 1e-12);
    check("  pressure", problem.contact_resultants()[0].maximum_pressure, 0.01 / (1. / lower + 1. / upper), 1e-8);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Parameters                               p = blocks_on_slab(1);
  p.contact_pairs                            = {pair(region(2, {z_minus}), region(1, {z_plus}), 0.1)};
  p.contact_pairs[0].scheme                  = ContactPairParameters::Scheme::averaged;
  const ContactPairParameters by_hand        = p.contact_pairs[0];
  const double                force          = run(p)[0].slave_force.norm();

  p.contact_pairs            = {general({1, 2}, 0.1)};
  p.contact_pairs[0].surface = by_hand.surface;
  p.contact_pairs[0].normal  = by_hand.normal;
  check("one block, general contact: force, as of a pair by hand", run(p)[0].slave_force.norm(), force, 1e-8);

  p               = blocks_on_slab(2);
  p.contact_pairs = {general({1, 2, 3}, 0.5), by_hand};
  auto r          = run(p);
  check_friction("another pair comes first: general contact", r[0], 0.5);
  check_friction("another pair comes first: that pair", r[1], 0.1);
  p.contact_pairs = {general({1, 2, 3}, 0.5), general({1, 2}, 0.1)};
  r               = run(p);
  check_friction("the later one of two comes first: general contact", r[0], 0.5);
  check_friction("the later one of two comes first: that pair", r[1], 0.1);
  p.contact_pairs = {general({1, 2}, 0.1), general({1, 2, 3}, 0.5)};
  r               = run(p);
  check("behind general contact: force of the other pair", r[0].slave_force.norm(), 0., 1e-12, 1.);
  check_friction("behind general contact: general contact", r[1], 0.5);

  p                                  = blocks_on_slab(2, "0.4"); // deeper than the judge lets what may touch
  p.contact_pairs                    = {general({1, 2, 3}, 0.1)};
  p.contact_pairs[0].surface         = by_hand.surface;
  p.contact_pairs[0].normal          = by_hand.normal;
  p.contact_pairs[0].excluded_bodies = {{3, 1}};
  check("excluded block: force, as without it", run(p)[0].slave_force.norm(), force, 1e-8);

  check_slave("softer body above", 500., 100., "3,3,2", 1.01);
  check_slave("softer body below", 100., 500., "3,3,2", 1.);
  check_slave("softer body below, finer one above", 100., 500., "6,6,2", 1.01);
  check_slave("much softer body below, finer one above", 100., 5000., "6,6,2", 1.);
  return 0;
}
