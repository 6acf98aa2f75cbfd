// A block that slides from one body onto the next, which are one master ("Master body = 2, 3"), against closed forms:
// pressed by the weight N and dragged, it is held by mu N wherever it is, and the two carry N together. On rigid bodies
// with meshes of their own it has the same pressures, slips and statuses as on a plane. A plate behind another one does
// not count in the mean gap of what is pressed on the latter (eq. J11).

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;
  using Type   = BoundaryConditionParameters::Type;

  constexpr double E = 1000., mu = 0.3, weight = 2.; // the area of the top is 1

  /// The block from x = 0 to 1 on slabs from x = -1 to 1.2 and on to 3.5; E nu = 0, plane strain.
  Parameters on_slabs(const Scheme scheme, const bool rigid)
  {
    Parameters p;
    p.bodies          = {box("block", "4,1,2", {0, 0, 0}, {1, 1, 0.5}, E, 0.),
                         box("first", "5,1,1", {-1, 0, -0.5}, {1.2, 1, 0}, E, 0.),
                         box("second", "7,1,2", {1.2, 0, -0.5}, {3.5, 1, 0}, E, 0.)};
    p.bodies[1].rigid = p.bodies[2].rigid = rigid;
    if (!rigid)
      p.boundary_conditions = {hold("below the first", region(2, {z_minus}), {0, 1, 2}),
                               hold("below the second", region(3, {z_minus}), {0, 1, 2}),
                               hold("plane strain", region(0, {y_minus, y_plus}), {1})};
    else
      p.boundary_conditions = {hold("plane strain", region(1, {y_minus, y_plus}), {1})};
    p.boundary_conditions.push_back(
        condition("weight", Type::traction, region(1, {z_plus}), {2}, {std::to_string(-weight) + "*min(1,2*t)"}));
    p.boundary_conditions.push_back(drive("drag", region(1, {z_plus}), 0, "max(0,2*t-1)*1.1"));
    ContactPairParameters pair;
    pair.name                 = "pair";
    pair.slave                = region(1, {z_minus});
    pair.master               = region(2, {z_plus});
    pair.master.bodies        = {2, 3};
    pair.friction_coefficient = mu;
    pair.scheme               = scheme;
    p.contact_pairs           = {pair};
    p.load_stepping           = {{0.5, 1.}, {1, 11}};
    p.output.write_vtu        = false;
    p.output.results_folder   = "several_masters_results";
    return p;
  }

  void check_balance(const std::string &name, const Scheme scheme)
  {
    Parameters p                        = on_slabs(scheme, false);
    p.bodies[2].material.youngs_modulus = 2. * E;
    ContactProblem problem(p, world(), log());
    double         N_off = 0., F_off = 0., slabs_off = 0., masters_off = 0., cone_off = 0., second = 0.;
    unsigned int   sticking = 0;
    problem.on_increment(
        [&](unsigned int, const double t)
        {
          if (t < 0.6)
            return;
          const auto   &pair   = problem.contact_resultants()[0];
          const auto   &fields = problem.contact_fields()[0];
          const Vector3 slabs  = problem.reactions()[0].second + problem.reactions()[1].second;
          N_off                = std::max(N_off, std::abs(pair.slave_force[2] / weight - 1.));
          F_off                = std::max(F_off, std::abs(-pair.slave_force[0] / (mu * weight) - 1.));
          for (const unsigned int c : {0, 2})
            slabs_off = std::max(slabs_off, std::abs(slabs[c] - pair.slave_force[c]));
          for (const unsigned int m : {0, 1})
            for (const unsigned int c : {0, 2})
              masters_off =
                  std::max(masters_off, std::abs(problem.reactions()[m].second[c] + pair.masters[m].force[c]));
          for (unsigned int k = 0; k < fields.X.size(); ++k)
            cone_off = std::max(cone_off, std::abs(fields.friction[k].norm() - mu * fields.pressure[k]));
          second = problem.reactions()[1].second[2] / weight;
          sticking += pair.stick;
        });
    problem.run();
    report(name, "");
    check("  force, off by at most", N_off, 0., 1e-8, 1.);
    if (scheme != Scheme::integration_point) // whose cones are at the points
      check("  friction at each node, off by at most", cone_off, 0., 1e-7, mu * weight);
    check_error("  friction in all, surfaces tilt, off by at most", F_off, 0.005);
    check("  what the slabs are held by, off by at most", slabs_off, 0., 1e-8, weight);
    check("  what each of them is held by, off the force on it by at most", masters_off, 0., 1e-8, weight);
    check("  the second carries nearly all in the end", second > 0.85 && second < 1.);
    check_equal("  nodes that stick", sticking, 0);
  }

  ContactFields end_of(const Parameters &p)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    return problem.contact_fields()[0];
  }

  void check_against_plane(const std::string &name, const Scheme scheme)
  {
    Parameters          p     = on_slabs(scheme, true);
    const ContactFields slabs = end_of(p);
    p.bodies.resize(1);
    p.contact_pairs[0].master               = RegionParameters();
    p.contact_pairs[0].master_surface.shape = MasterSurfaceParameters::Shape::plane;
    p.contact_pairs[0].master_surface.axis  = Vector3({0., 0., 1.});
    const ContactFields plane               = end_of(p);
    double              pressure = 0., friction = 0., slip = 0., largest = 0.;
    unsigned int        other = 0;
    for (unsigned int k = 0; k < slabs.X.size(); ++k)
    {
      const unsigned int l = node_at(plane, slabs.X[k]);
      pressure             = std::max(pressure, std::abs(slabs.pressure[k] - plane.pressure[l]));
      friction             = std::max(friction, (slabs.friction[k] - plane.friction[l]).norm());
      slip                 = std::max(slip, std::abs(slabs.slip[0][k] - plane.slip[0][l]));
      largest              = std::max(largest, std::abs(plane.slip[0][l]));
      other += slabs.status[k] != plane.status[l];
    }
    report(name, "");
    check("  pressures against those on a plane", pressure, 0., 1e-7, weight);
    check("  friction", friction, 0., 1e-7, weight);
    check("  accumulated slips", slip, 0., 1e-7, 1.);
    check("  which are most of the way", largest > 1. && largest < 1.1001);
    check_equal("  other statuses", other, 0);
  }

  /// A block goes up by 0.06 under a plate at 0.05; another plate is 0.45 behind that.
  void check_behind()
  {
    Parameters p                       = on_slabs(Scheme::averaged, false);
    p.bodies                           = {box("block", "3,2,1", {0, 0, 0}, {1, 1, 1}, E, 0.),
                                          box("near", "2,3,1", {-0.1, -0.1, 1.05}, {1.1, 1.1, 1.1}, E, 0.),
                                          box("behind", "1,2,1", {-0.2, -0.2, 1.5}, {1.2, 1.2, 2}, E, 0.)};
    p.boundary_conditions              = {hold("near", region(2, {0, 1, 2, 3, 4, 5}), {0, 1, 2}),
                                          hold("behind", region(3, {0, 1, 2, 3, 4, 5}), {0, 1, 2}),
                                          hold("upright", region(1, {z_minus}), {0, 1}),
                                          drive("up", region(1, {z_minus}), 2, "0.06*t")};
    p.contact_pairs[0].slave           = region(1, {z_plus});
    p.contact_pairs[0].master          = region(2, {z_minus});
    p.contact_pairs[0].master.bodies   = {2, 3};
    p.contact_pairs[0].search_distance = 1.;
    p.load_stepping                    = {{1.}, {2}};
    ContactProblem problem(p, world(), log());
    problem.run();
    report("a plate behind another one", "");
    check("  force on the block", problem.contact_resultants()[0].slave_force[2], -0.01 * E, 1e-8);
    check("  on the near one", problem.contact_resultants()[0].masters[0].force[2], 0.01 * E, 1e-8);
    check("  on the one behind", problem.contact_resultants()[0].masters[1].force[2], 0., 1e-12, E);

    // both over less than a half of a face: the same with and without the one behind
    p.bodies[0] = box("block", "1,1,1", {0, 0, 0}, {1, 1, 1}, E, 0.);
    p.bodies[1] = box("near", "2,3,1", {-0.1, -0.1, 1.05}, {0.4, 1.1, 1.1}, E, 0.);
    p.bodies[2] = box("behind", "1,2,1", {-0.2, -0.2, 1.5}, {0.3, 1.2, 2}, E, 0.);
    Vector3 force[2];
    for (const unsigned int behind : {0, 1})
    {
      if (behind == 0)
        p.contact_pairs[0].master.bodies = {2};
      else
        p.contact_pairs[0].master.bodies = {2, 3};
      ContactProblem part(p, world(), log());
      part.run();
      force[behind] = part.contact_resultants()[0].slave_force;
    }
    check("  both over a part of it", force[1][2], force[0][2], 1e-10);
    check("  which carries", force[1][2] < -1.);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_balance("averaged", Scheme::averaged);
  check_balance("nodal", Scheme::nodal);
  check_balance("integration points", Scheme::integration_point);
  check_against_plane("rigid slabs, averaged", Scheme::averaged);
  check_against_plane("rigid slabs, nodal", Scheme::nodal);
  check_behind();
  return 0;
}
